"""log.csv of a run."""
from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .files import write_whole
from .observables import index_of, observables


class Log(Mapping[str, NDArray[Any]]):
    """The columns of log.csv: log["torque_upper_nN_nm"] is an array (rows,) in the unit log.units["torque_upper_nN_nm"].

    A last row that is not whole, as of a run at work, is left out. Integers are int64, all others float64.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Reads the file.

        Arguments:
            path: of a log.csv
        """
        self._table = _core.read_log(os.fspath(path))
        self._columns: dict[str, NDArray[Any]] = {}
        for k, o in enumerate(observables()):
            values = self._table[:, k]
            whole = o.whole and bool(np.isfinite(values).all())
            self._columns[o.name] = values.astype(np.int64) if whole else values

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A column, (rows,), in the unit that its name ends in."""
        if name not in self._columns:
            index_of(name)
        return self._columns[name]

    def __contains__(self, name: object) -> bool:
        """Whether there is such a column (no unit)."""
        return name in self._columns

    def __iter__(self) -> Iterator[str]:
        """Names of the columns (no unit)."""
        return iter(self._columns)

    def __len__(self) -> int:
        """Number of columns (no unit)."""
        return len(self._columns)

    def __repr__(self) -> str:
        """Size and time span, ps."""
        time = self["time_ps"]
        span = f", {time[0]:g} to {time[-1]:g} ps" if len(time) else ""
        return f"<Log: {len(self)} columns, {self.rows} rows{span}>"

    @property
    def rows(self) -> int:
        """Number of rows (no unit)."""
        return len(self._table)

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column; "" for a pure number."""
        return {o.name: o.unit for o in observables()}

    @property
    def meanings(self) -> dict[str, str]:
        """What each column is, a clause; its unit is in `units`."""
        return {o.name: o.meaning for o in observables()}

    def to_npz(self, path: str | os.PathLike[str]) -> None:
        """Writes the columns as a file of numpy, each by its name and in its unit, with "names", "units" and "meanings".

        Arguments:
            path: file to write, as numpy.load reads it; written whole or not at all
        """
        listed = {"names": np.array(list(self)), "units": np.array([self.units[n] for n in self])}
        listed["meanings"] = np.array([self.meanings[n] for n in self])
        buffer = io.BytesIO()
        np.savez_compressed(buffer, **self._columns, **listed)
        write_whole(path, buffer.getvalue())
