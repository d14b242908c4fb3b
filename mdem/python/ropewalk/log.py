"""log.csv of a run."""
from __future__ import annotations

import io
import os
from importlib import import_module
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from . import _core
from .files import write_whole
from .observables import index_of, observables


class Mean(NamedTuple):
    """A mean over time.

    Keys:
        value: the mean, in the unit of its column
        error: its standard error, likewise; nan: the time is too short for one
        correlation_ps: correlation time, ps; nan: the value does not change
        needed_ps: time that an error needs, ps, where there is none; else 0
    """

    value: float
    error: float
    correlation_ps: float
    needed_ps: float


class Log(dict[str, NDArray[Any]]):
    """The columns of log.csv: log["torque_upper_nN_nm"] is an array (rows,) in the unit log.units["torque_upper_nN_nm"].

    It is a dict of them, as pandas.DataFrame() takes it.

    A last row that is not whole, as of a run at work, is left out. Integers are int64, all others float64.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Reads the file.

        Arguments:
            path: of a log.csv
        """
        table = _core.read_log(os.fspath(path))
        columns = {}
        for k, o in enumerate(observables()):
            whole = o.whole and bool(np.isfinite(table[:, k]).all())
            columns[o.name] = table[:, k].astype(np.int64) if whole else table[:, k].copy()
        super().__init__(columns)

    def __missing__(self, name: str) -> NDArray[Any]:
        """Says which column (rows,) may be meant by `name`; units stand in the names."""
        index_of(name)
        raise KeyError(name)

    def __eq__(self, other: object) -> bool:
        """Whether all columns of `other` hold the same numbers (no unit)."""
        return isinstance(other, Log) and all(np.array_equal(other[n], self[n], equal_nan=True) for n in self)

    def __ne__(self, other: object) -> bool:
        """Whether a column of `other` differs (no unit)."""
        return not self == other

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its columns (rows,), in the units of their names."""
        return _log_of, (dict(self),)

    def __repr__(self) -> str:
        """Size and time span, ps."""
        time = self["time_ps"]
        span = f", {time[0]:g} to {time[-1]:g} ps" if len(time) else ""
        return f"<Log: {len(self)} columns, {self.rows} rows{span}>"

    def mean(self, name: str, last_ps: Optional[float] = None) -> Mean:
        """The mean of a column (in its unit) over time, with its standard error.

        Arguments:
            name: of the column
            last_ps: over the last rows of so much time, ps; None: over all
        """
        time, values = self["time_ps"], self[name].astype(np.float64)
        chosen = np.ones(len(time), dtype=bool) if last_ps is None or not len(time) else time >= time[-1] - last_ps - 1e-9
        return Mean(*_core.mean_over_time(time[chosen].tolist(), values[chosen].tolist()))

    @property
    def rows(self) -> int:
        """Number of rows (no unit)."""
        return len(self["step"])

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column; "" for a pure number."""
        return {o.name: o.unit for o in observables()}

    @property
    def meanings(self) -> dict[str, str]:
        """What each column is, a clause; its unit is in `units`."""
        return {o.name: o.meaning for o in observables()}

    def to_dataframe(self) -> Any:
        """The columns (rows,) as a pandas.DataFrame, whose `attrs` have "units" and "meanings"."""
        frame = import_module("pandas").DataFrame(dict(self))
        frame.attrs.update(units=self.units, meanings=self.meanings)
        return frame

    def to_npz(self, path: str | os.PathLike[str]) -> None:
        """Writes the columns as a file of numpy, each by its name and in its unit, with "names", "units" and "meanings".

        Arguments:
            path: file to write, as numpy.load reads it; written whole or not at all
        """
        listed = {"names": np.array(list(self)), "units": np.array([self.units[n] for n in self])}
        listed["meanings"] = np.array([self.meanings[n] for n in self])
        buffer = io.BytesIO()
        np.savez_compressed(buffer, **self, **listed)
        write_whole(path, buffer.getvalue())


def _log_of(columns: dict[str, NDArray[Any]]) -> Log:
    log = Log.__new__(Log)
    log.update(columns)
    return log
