"""Forces of one's own: functions of Python that act in a simulation."""
from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from .numbers import finite, finite_array
from .state import Elements, Floats, Instant

OwnForce = Callable[[Instant], Any]
_Found = tuple[Floats, Floats, Optional[float]]


def _vectors(values: Optional[ArrayLike], elements: int, what: str) -> Floats:
    if values is None:
        return np.zeros((elements, 3))
    array = finite_array(values, f"{what} of a force of one's own")
    if array.shape[-1:] != (3,) or array.size != 3 * elements:
        raise ValueError(f"a force of one's own has {what} of shape {array.shape}; ({elements}, 3) is needed")
    return array.reshape(elements, 3)


def name_of(force: OwnForce) -> str:
    """The name of a function, or that of the class of what is called like one (no unit)."""
    function = getattr(force, "func", force)  # of functools.partial
    return re.sub(r"[^\w<>.]+", "_", str(getattr(function, "__name__", type(function).__name__)))


def checked(force: OwnForce, tube_begin: Sequence[int], element_length_nm: float) -> Callable[..., _Found]:
    """The function as the core calls it: arrays in, checked arrays and the energy out.

    Arguments:
        force: of the user
        tube_begin, element_length_nm: as of State (nm)
    """

    def call(step: int, time: float, *arrays: Floats) -> _Found:
        found = force(Instant(Elements(*arrays), tube_begin, element_length_nm, step, time))
        parts = found if isinstance(found, tuple) else (found,)
        if len(parts) > 3:
            raise ValueError("a force of one's own returns forces, torques and energy at most")
        forces, torques, energy = (*parts, None, None, None)[:3]
        n = len(arrays[0])
        found_energy = None if energy is None else finite(energy, "the energy of a force of one's own")
        return _vectors(forces, n, "the forces"), _vectors(torques, n, "the torques"), found_energy

    call.__name__ = name_of(force)
    return call
