"""Parameter sets."""
from __future__ import annotations

import math
import os
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from . import _core
from .errors import InputError
from .files import write_whole
from .toml import toml_of


@dataclass(frozen=True)
class Quantity:
    """A number of a parameter set.

    Attributes:
        value: in `unit`
        unit: "nN", "nN nm^2", ...; "1" for a pure number
        standard_error: in `unit`; nan: not published
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
                stated = value.get("standard_error", 0.0)
                error = float(stated) if isinstance(stated, (int, float)) else math.nan
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

    def changed(
        self, changes: Mapping[str, float] = {}, out: str | os.PathLike[str] = "", **more: float
    ) -> ParameterSet:
        """Another set with other numbers, as a file. They count as chosen and exact; all else stays as it is. The
        forces of `[bond.pull]` follow the force that the other terms of the bond have where the pull begins.

        Arguments:
            changes: values by name, each in the unit that this set has it in: {"bond.EA": 650}
            out: the file to write, never one that exists; its name becomes that of the set (no unit)
            more: the same, in the same units, by the last part of a name that no other number has: EA=650
        """
        if not out:
            raise InputError("changed: out: is missing; name the file to write", key="out")
        target = os.path.abspath(out)
        if os.path.exists(target):
            raise InputError(f"{os.fspath(out)}: exists; choose another name", os.fspath(out), key="out")
        tables = tomllib.loads(_core.set_to_change(self._path))
        for name, value in {**changes, **{self._by_last(k): v for k, v in more.items()}}.items():
            if name not in self._quantities:
                raise InputError(f'{self.name}: there is no number "{name}"; see list() of the set', self._path, key=name)
            at = tables
            for key in name.split("."):
                at = at[key]
            at.update(value=float(value), standard_error=0.0, origin="chosen")
        tables["meta"]["name"] = os.path.splitext(os.path.basename(target))[0]
        write_whole(target, toml_of(tables).encode())
        try:
            return ParameterSet(target)
        except InputError:
            os.unlink(target)
            raise

    def _by_last(self, key: str) -> str:
        names = [name for name in self._quantities if name.split(".")[-1] == key]
        if len(names) != 1:
            which = f"is one of {', '.join(names)}" if names else "is no number of it"
            raise InputError(f"{self.name}: {key} {which}; give the whole name", self._path, key=key)
        return names[0]

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
