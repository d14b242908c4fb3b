"""What validations and campaigns came to."""
from __future__ import annotations

import contextlib
import csv
import io
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .runs import Run


@dataclass(frozen=True)
class Check:
    """A number of a validation case, held against a reference.

    Attributes:
        name: what it is
        value: in `unit`
        reference: in `unit`
        unit: "eV", "nN", ...; "" for a pure number
        tolerance: relative (no unit) or in `unit`, as `relative` says
        relative: whether the tolerance is relative
        holds: whether the value is within the tolerance
        informative: whether the verdict is without it
    """

    name: str
    value: float
    reference: float
    unit: str
    tolerance: float
    relative: bool
    holds: bool
    informative: bool


@dataclass(frozen=True)
class ValidationCase:
    """A validation case.

    Attributes:
        name: of the case
        verdict: "holds" or what else came out
        checks: its numbers, each with its unit
        report: file of the page with all cases
    """

    name: str
    verdict: str
    checks: tuple[Check, ...]
    report: str

    @property
    def holds(self) -> bool:
        """Whether all that counts is within its tolerance (no unit)."""
        return self.verdict == "holds"


def table_of(text: str) -> dict[str, NDArray[Any]]:
    """The columns of a CSV text by their names, (rows,), as numbers where all cells are numbers or empty (nan).

    Arguments:
        text: with a header, whose names end in the units
    """
    rows = list(csv.reader(io.StringIO(text)))
    out: dict[str, NDArray[Any]] = {}
    for name, cells in zip(rows[0], zip(*rows[1:]) if len(rows) > 1 else [()] * len(rows[0])):
        out[name] = np.array(cells, dtype=str)
        if any(cells):
            with contextlib.suppress(ValueError):
                out[name] = np.array([float(c) if c else np.nan for c in cells])
    return out


class Campaign:
    """The directory of a sweep: one run for each point, and a table of all."""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        """Opens the directory of a sweep.

        Arguments:
            directory: that `ropewalk sweep` made (no unit)
        """
        self._path = os.fspath(directory)

    def __repr__(self) -> str:
        """Directory and number of points (no unit)."""
        return f"<Campaign {self.path}: {len(self.runs)} points>"

    @property
    def path(self) -> str:
        """The directory (no unit)."""
        return self._path

    @property
    def runs(self) -> dict[str, Run]:
        """The runs by the names of their points, in the order of the sweep (units as of Run)."""
        folder = os.path.join(self._path, "points")
        return {str(name): Run(os.path.join(folder, str(name))) for name in self.table["point"]
                if os.path.exists(os.path.join(folder, str(name), "scene.toml"))}

    @property
    def table(self) -> dict[str, NDArray[Any]]:
        """One row for each point: values of the keys that vary, and observables at its end, (points,), units in the names.

        It is what table.csv had after the last sweep.
        """
        with open(os.path.join(self._path, "table.csv"), encoding="utf-8", newline="") as file:
            return table_of(file.read())
