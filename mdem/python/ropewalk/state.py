"""Where elements are: of a simulation, of a frame, of the start of a scene."""
from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Error

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements one after another, those of a tube along it. What is not known is None.

    Attributes:
        position: (elements, 3), centres, nm
        orientation: (elements, 4), unit quaternions in the order w, x, y, z, which turn z into the tube axis (no unit)
        velocity: (elements, 3), nm/ps
        angular_velocity: (elements, 3), in space, rad/ps
        bond_energy: (elements,), half of the energy of each bond of the element, eV
        vdw_energy: (elements,), half of the energy of each contact of the element, eV
        bending_moment: (elements,), EI times curvature, eV
        twist_angle: (elements,), mean twist of the bonds of the element, rad
    """

    position: Floats
    orientation: Floats
    velocity: Optional[Floats] = None
    angular_velocity: Optional[Floats] = None
    bond_energy: Optional[Floats] = None
    vdw_energy: Optional[Floats] = None
    bending_moment: Optional[Floats] = None
    twist_angle: Optional[Floats] = None

    @property
    def axis(self) -> Floats:
        """Unit vectors along the tube, (elements, 3) (no unit)."""
        w, x, y, z = self.orientation.T
        return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1)

    def __len__(self) -> int:
        """Number of elements (no unit)."""
        return len(self.position)

    def __eq__(self, other: object) -> bool:
        """Whether the same is known of `other`, with the same numbers (no unit)."""
        return isinstance(other, Elements) and all(_same(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    __hash__ = None  # type: ignore[assignment]

    def _part(self, begin: int, end: int) -> Elements:
        given = {f.name: getattr(self, f.name) for f in fields(self)}
        return replace(self, **{k: v[begin:end] for k, v in given.items() if v is not None})


def _same(one: Optional[Floats], other: Optional[Floats]) -> bool:
    return one is other or (one is not None and other is not None and np.array_equal(one, other))


class State:
    """The elements of all tubes at one time.

    `position`, `orientation` and the others have the shape (tubes, elements of a tube, ...) where all tubes have the same
    number of elements. For tubes of unequal numbers take `flat` (all elements one after another) or `tubes` (one
    after another): those are there for every state. `tube` says to which tube an element of `flat` belongs.
    """

    def __init__(self, flat: Elements, tube_begin: Sequence[int], element_length_nm: float) -> None:
        """The elements and their tubes.

        Arguments:
            flat: all elements, those of a tube one after another
            tube_begin: (tubes + 1,), number of the first element of each tube, then that of all elements (no unit)
            element_length_nm: nm
        """
        self._flat = flat
        self._begin = list(tube_begin)
        self._element_length = element_length_nm

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its values, as copies where it has views (nm, ps, eV, rad)."""
        return State, (self.flat, self._begin, self._element_length)

    def __eq__(self, other: object) -> bool:
        """Whether `other` has the same tubes and elements (no unit)."""
        return isinstance(other, State) and (self._begin, self._element_length, self.flat) == (
            other._begin, other._element_length, other.flat)

    __hash__ = None  # type: ignore[assignment]

    @property
    def flat(self) -> Elements:
        """All elements one after another: arrays (elements, ...), in nm, ps, eV, rad."""
        return self._flat

    @property
    def tubes(self) -> tuple[Elements, ...]:
        """One tube after another: arrays (elements of this tube, ...), in nm, ps, eV, rad."""
        return tuple(self.flat._part(a, b) for a, b in zip(self._begin, self._begin[1:]))

    @property
    def tube(self) -> NDArray[np.int64]:
        """Tube of each element of `flat`, from 0: (elements,) (no unit)."""
        return np.repeat(np.arange(len(self._begin) - 1), np.diff(self._begin))

    @property
    def tube_begin(self) -> NDArray[np.int64]:
        """First element of each tube, and at the end the number of all elements: (tubes + 1,) (no unit)."""
        return np.array(self._begin)

    @property
    def element_length_nm(self) -> float:
        """Length of an element, nm."""
        return self._element_length

    def _by_tube(self, name: str) -> Floats:
        values = getattr(self.flat, name)
        if values is None:
            raise Error(f"{name} is not known here: {type(self).__name__} does not hold it")
        lengths = set(np.diff(self._begin).tolist())
        if len(lengths) > 1:
            raise Error(f"tubes have {min(lengths)} to {max(lengths)} elements: take flat.{name} or tubes[i].{name}")
        array: Floats = values.reshape(len(self._begin) - 1, -1, *values.shape[1:])
        return array

    @property
    def position(self) -> Floats:
        """Centres of the elements, (tubes, elements, 3), nm."""
        return self._by_tube("position")

    @property
    def orientation(self) -> Floats:
        """Unit quaternions, (tubes, elements, 4), in the order w, x, y, z: they turn z into the tube axis (no unit)."""
        return self._by_tube("orientation")

    @property
    def axis(self) -> Floats:
        """Unit vectors along the tubes, (tubes, elements, 3) (no unit)."""
        return self._by_tube("axis")

    @property
    def velocity(self) -> Floats:
        """Velocities of the elements, (tubes, elements, 3), nm/ps."""
        return self._by_tube("velocity")

    @property
    def angular_velocity(self) -> Floats:
        """Angular velocities in space, (tubes, elements, 3), rad/ps."""
        return self._by_tube("angular_velocity")


class Instant(State):
    """The elements at one time: what a force of one's own acts on. The arrays are copies."""

    def __init__(self, flat: Elements, tube_begin: Sequence[int], element_length_nm: float, step: int, time_ps: float) -> None:
        """As Simulation makes it.

        Arguments:
            flat, tube_begin, element_length_nm: as of State (nm)
            step: time step (no unit)
            time_ps: ps
        """
        super().__init__(flat, tube_begin, element_length_nm)
        self._step = step
        self._time = time_ps

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its values (nm, ps, rad)."""
        return Instant, (self.flat, self._begin, self._element_length, self._step, self._time)

    @property
    def step(self) -> int:
        """Time step (no unit)."""
        return self._step

    @property
    def time_ps(self) -> float:
        """Time, ps."""
        return self._time


def write_state(path: str | os.PathLike[str], position: ArrayLike, orientation: ArrayLike) -> None:
    """Writes a state file, from which a scene starts with {"state": {"file": path}}.

    Arguments:
        path: the file
        position: (tubes, elements, 3), centres of the elements, nm
        orientation: (tubes, elements, 4), quaternions w, x, y, z, which turn z into the tube axis (no unit)
    """
    from .numbers import finite_array

    places, turns = finite_array(position, "position"), finite_array(orientation, "orientation")
    if places.ndim != 3 or places.shape[2] != 3 or turns.shape != (*places.shape[:2], 4):
        raise ValueError(
            f"position {places.shape} and orientation {turns.shape}: (tubes, elements, 3) and (tubes, elements, 4) are "
            "needed"
        )
    lines = ["tube,x_nm,y_nm,z_nm,qw,qx,qy,qz"]
    for tube in range(len(places)):
        for row in np.concatenate([places[tube], turns[tube]], axis=1).tolist():
            lines.append(",".join([str(tube), *map(repr, row)]))
    from .files import write_whole

    write_whole(path, "\n".join(lines).encode() + b"\n")
