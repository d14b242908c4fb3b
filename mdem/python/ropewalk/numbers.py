"""Numbers that users give."""
from __future__ import annotations

import math
import operator
from typing import Any, Optional

import numpy as np

from .state import Floats


def finite(value: Any, name: str, least: float = -math.inf) -> float:
    """The number itself. Raises ValueError where it is not finite or too small, TypeError where it is no real number.

    Arguments:
        value: of the user
        name: in messages
        least: smallest allowed one (unit of `value`)
    """
    if isinstance(value, (str, bytes, complex, np.complexfloating)):
        raise TypeError(f"{name} is {value!r}: a real number is needed")
    number = float(value)
    if not math.isfinite(number) or number < least:
        raise ValueError(f"{name} is {value}: a finite number{f' from {least:g}' if least > -math.inf else ''} is needed")
    return number


def whole(value: Any, name: str, least: int, most: Optional[int] = None) -> int:
    """The whole number itself. Raises ValueError outside of the bounds, TypeError where it is no number.

    Arguments:
        value: of the user
        name: in messages
        least, most: bounds; None: none (no unit)
    """
    try:
        number = operator.index(value)
    except TypeError:
        real = finite(value, name)
        number = int(real)
        if number != real:
            raise ValueError(f"{name} is {value}: a whole number is needed") from None
    if number < least or (most is not None and number > most):
        raise ValueError(f"{name} is {value}: give {least} {'or more' if most is None else f'to {most}'}")
    return number


def real_array(values: Any, name: str) -> Floats:
    """The array as real numbers. Raises ValueError where it is masked, TypeError where it holds no real numbers.

    Arguments:
        values: of the user
        name: in messages
    """
    if isinstance(values, np.ma.MaskedArray):
        raise ValueError(f"{name} is a masked array: fill what is masked")
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} has numbers of type {array.dtype}: real numbers are needed")
    return np.asarray(array, np.float64)


def finite_array(values: Any, name: str) -> Floats:
    """The array as real_array() gives it. Raises ValueError where a number is not finite.

    Arguments:
        values: of the user
        name: in messages
    """
    found = real_array(values, name)
    if not np.isfinite(found).all():
        raise ValueError(f"{name} is not finite")
    return found
