"""The observables: columns of log.csv, which a simulation measures as well."""
from __future__ import annotations

import difflib
from typing import NamedTuple

from . import _core
from .errors import InputError


class Observable(NamedTuple):
    """One observable. Its name ends in its unit.

    Attributes:
        name: as in the header of log.csv
        unit: "nN nm", "deg", ...; "" for a pure number
        meaning: a clause
        group: title of the group that it is shown in
        in_frames: whether stored frames have it; loads and energies are known to the run alone
        whole: whether it is an integer
    """

    name: str
    unit: str
    meaning: str
    group: str
    in_frames: bool
    whole: bool


def observables() -> tuple[Observable, ...]:
    """All observables in the order of the columns of log.csv, each with its unit."""
    return tuple(Observable(*row) for row in _core.observables())


def index_of(name: str) -> int:
    """Number of an observable in observables() (no unit).

    Arguments:
        name: of the observable; InputError names the nearest one where there is none
    """
    names = [o.name for o in observables()]
    if name in names:
        return names.index(name)
    near = difflib.get_close_matches(name, names, 1)
    remedy = f'did you mean "{near[0]}"?' if near else "see ropewalk.observables()"
    raise InputError(f'there is no observable "{name}"; {remedy}', key=name)
