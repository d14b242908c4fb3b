"""Parameter sets."""
from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from . import _core


@dataclass(frozen=True)
class Quantity:
    """A number of a parameter set.

    Attributes:
        value: in `unit`
        unit: "nN", "nN nm^2", ...; "1" for a pure number
        standard_error: in `unit`
        origin: "calibrated", "derived", "chosen" or "published"
    """

    value: float
    unit: str
    standard_error: float
    origin: str

    def __str__(self) -> str:
        """Value, standard error and unit."""
        return f"{self.value:g} +- {self.standard_error:g} {self.unit}"


class ParameterSet(Mapping[str, Quantity]):
    """A parameter set: set["bond.EA"] is a Quantity with value, unit and standard error."""

    def __init__(self, name: str | os.PathLike[str]) -> None:
        """Reads a set.

        Arguments:
            name: a file, or the name of a shipped set (no unit)
        """
        self._path, self._name, self._grade = _core.parameter_set(os.fspath(name))
        self._quantities: dict[str, Quantity] = {}
        with open(self._path, "rb") as file:
            self._collect(tomllib.load(file), "")

    def _collect(self, table: Mapping[str, Any], before: str) -> None:
        for key, value in table.items():
            if not isinstance(value, Mapping):
                continue
            if isinstance(value.get("value"), (int, float)):
                error = float(value.get("standard_error", 0.0))
                self._quantities[before + key] = Quantity(
                    float(value["value"]), value.get("unit", "1"), error, value.get("origin", "")
                )
            else:
                self._collect(value, before + key + ".")

    def __getitem__(self, name: str) -> Quantity:
        """A number with its unit, by its table and key."""
        return self._quantities[name]

    def __iter__(self) -> Iterator[str]:
        """Names of all numbers (no unit)."""
        return iter(self._quantities)

    def __len__(self) -> int:
        """How many numbers there are (no unit)."""
        return len(self._quantities)

    def __repr__(self) -> str:
        """Name and grade (no unit)."""
        return f"<ParameterSet {self.name}: {self.grade}>"

    @property
    def name(self) -> str:
        """Its name (no unit)."""
        return self._name

    @property
    def path(self) -> str:
        """Its file (no unit)."""
        return self._path

    @property
    def grade(self) -> str:
        """How far it holds: "good", or "limited" or "unfit" with the reasons (no unit)."""
        return self._grade


def parameter_sets() -> list[str]:
    """Names of the shipped parameter sets (no unit)."""
    folder = os.path.join(_core.data_directory(), "parameters")
    return sorted(name[: -len(".toml")] for name in os.listdir(folder) if name.endswith(".toml"))
