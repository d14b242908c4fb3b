"""Forces of one's own: functions of Python that act in a simulation."""
from __future__ import annotations

import logging
import re
from collections.abc import Callable, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from .numbers import finite, real_array
from .state import Elements, Floats, Instant

OwnForce = Callable[[Instant], Any]
_log = logging.getLogger("ropewalk")
_Found = tuple[Floats, Floats, Optional[float]]


def _vectors(values: Optional[ArrayLike], elements: int, what: str) -> Floats:
    if values is None:
        return np.zeros((elements, 3))
    array = real_array(values, what)
    if array.shape[-1:] != (3,) or array.size != 3 * elements:
        raise ValueError(f"{what} has the shape {array.shape}; ({elements}, 3) is needed")
    array = array.reshape(elements, 3)
    wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(wrong) > 0:
        more = f" and {len(wrong) - 1} more" if len(wrong) > 1 else ""
        raise ValueError(f"{what} is not finite: {array[wrong[0]]} on element {wrong[0]}{more}")
    return array


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

    name = name_of(force)
    said = False

    def call(step: int, time: float, *arrays: Floats) -> _Found:
        nonlocal said
        found = force(Instant(Elements(*arrays), tube_begin, element_length_nm, step, time))
        parts = found if isinstance(found, tuple) else (found,)
        if len(parts) > 3:
            raise ValueError(f"{name} gives {len(parts)} values; forces, torques and energy are all that a force of one's "
                             "own may give")
        if found is None and not said:
            said = True
            _log.warning("%s gives None at %g ps, which stands for no force: is a return missing?", name, time)
        forces, torques, energy = (*parts, None, None, None)[:3]
        n, at = len(arrays[0]), f" of {name}, a force of one's own, at {time:.6g} ps,"
        found_energy = None if energy is None else finite(energy, "the energy" + at)
        return _vectors(forces, n, "the force" + at), _vectors(torques, n, "the torque" + at), found_energy

    call.__name__ = name
    return call
