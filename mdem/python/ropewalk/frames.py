"""Stored frames of a run."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from typing import Any, Optional, Union, overload

import numpy as np

from . import _core
from .errors import InputError
from .observables import index_of, observables
from .scene import Scene
from .state import Elements, Floats, State

_AMU = 0.0103642697  # eV ps^2/nm^2


class Frame(State):
    """The elements of all tubes at one time of a run, as stored: positions, orientations and values to colour by.

    Velocities are not stored.
    """

    def __init__(
        self, flat: Elements, tube_begin: Sequence[int], element_length_nm: float, of: Frames, number: int,
        step: int, time_ps: float,
    ) -> None:
        """As Frames makes it.

        Arguments:
            flat, tube_begin, element_length_nm: as of State (nm)
            of, number: where it comes from (no unit)
            step: time step (no unit)
            time_ps: ps
        """
        super().__init__(flat, tube_begin, element_length_nm)
        self._of = of
        self._number = number
        self._step = step
        self._time = time_ps

    def __repr__(self) -> str:
        """Size, step and time, ps."""
        return f"<Frame: {len(self._begin) - 1} tubes, {len(self.flat)} elements, step {self.step}, {self.time_ps:g} ps>"

    @property
    def step(self) -> int:
        """Time step (no unit)."""
        return self._step

    @property
    def time_ps(self) -> float:
        """Time, ps."""
        return self._time

    @property
    def bond_energy(self) -> Floats:
        """Half of the energy of each bond of an element, (tubes, elements), eV."""
        return self._by_tube("bond_energy")

    @property
    def vdw_energy(self) -> Floats:
        """Half of the energy of each contact of an element, (tubes, elements), eV."""
        return self._by_tube("vdw_energy")

    @property
    def bending_moment(self) -> Floats:
        """Bending moment, EI times curvature, (tubes, elements), eV."""
        return self._by_tube("bending_moment")

    @property
    def twist_angle(self) -> Floats:
        """Mean twist of the bonds of an element, (tubes, elements), rad."""
        return self._by_tube("twist_angle")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its values (nm, eV, rad, ps) and the file of its run, which measure() reads."""
        return Frame, (self.flat, self._begin, self._element_length, self._of, self._number, self._step, self._time)

    def __eq__(self, other: object) -> bool:
        """Whether `other` has the same step, time and elements (no unit)."""
        return isinstance(other, Frame) and (self.step, self.time_ps) == (other.step, other.time_ps) and super().__eq__(other)

    __hash__ = None  # type: ignore[assignment]

    def to_ase(self) -> Any:
        """The elements as ase.Atoms, in its units Å and u: symbols X, the masses of the elements, and the arrays "tube"
        and "axis" (elements, 3). `info` has "time_ps" and "step"."""
        scene = self._of._scene
        masses = scene._core.mass / _AMU
        atoms = import_module("ase").Atoms(
            positions=10 * self.flat.position, numbers=np.zeros(len(self.flat), int), masses=masses[self.tube]
        )
        atoms.set_array("tube", self.tube)
        atoms.set_array("axis", self.flat.axis)
        atoms.info.update(time_ps=self.time_ps, step=self.step)
        return atoms

    def measure(self, name: Optional[str] = None) -> Union[float, dict[str, float]]:
        """Observables of this frame: one by its name, in the unit that the name ends in, or all as a dict.

        Arguments:
            name: of an observable with in_frames; None: all of these
        """
        if name is not None and not observables()[index_of(name)].in_frames:
            raise InputError(f"{name} is not known from a frame; take it from run.log", key=name)
        values = dict(zip((o.name for o in observables()), self._of._file.measure(self._number)))
        if name is not None:
            return values[name]
        return {o.name: values[o.name] for o in observables() if o.in_frames}


class Frames(Sequence[Frame]):
    """The frames of a run: len(), frames[i] (also from the end), frames[a:b:c], and iteration.

    A frame is read from the file when it is asked for, in any order.
    """

    def __init__(self, path: str, scene: Scene, numbers: Optional[range] = None, file: Optional[_core.Frames] = None) -> None:
        """As Run makes it.

        Arguments:
            path: the file (no unit)
            scene: that of the run (units stand in the names of its keys)
            numbers: of the frames in the file; None: all (no unit)
            file: its reader, which others use as well; None: one of its own (no unit)
        """
        self._path = path
        self._scene = scene
        self._numbers = numbers
        self._file = file or _core.Frames(path, scene._core)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by the file's path (no unit)."""
        return Frames, (self._path, self._scene, self._numbers)

    def __eq__(self, other: object) -> bool:
        """Whether `other` has equal frames (no unit)."""
        return isinstance(other, Frames) and len(self) == len(other) and all(a == b for a, b in zip(self, other))

    __hash__ = None  # type: ignore[assignment]

    def __len__(self) -> int:
        """Number of frames (no unit)."""
        return len(self._file) if self._numbers is None else len(self._numbers)

    def __repr__(self) -> str:
        """Number of frames (no unit)."""
        return f"<Frames: {len(self)}>"

    def _frame(self, number: int) -> Frame:
        step, time, position, orientation, colours = self._file.at(number)
        flat = Elements(position, orientation, **colours)
        core = self._scene._core
        return Frame(flat, core.tube_begin, core.element_length, self, number, step, time)

    @overload
    def __getitem__(self, index: int) -> Frame: ...

    @overload
    def __getitem__(self, index: slice) -> Frames: ...

    def __getitem__(self, index: Union[int, slice]) -> Union[Frame, Frames]:
        """A frame by its number, or some of the frames by a slice (no unit)."""
        if isinstance(index, slice):
            numbers = range(len(self)) if self._numbers is None else self._numbers
            return Frames(self._path, self._scene, numbers[index], self._file)
        if self._numbers is not None:
            return self._frame(self._numbers[index])
        if index < 0:
            index += len(self)
            if index < 0:
                raise IndexError(f"there are {len(self)} frames")
        return self._frame(index)

    def __iter__(self) -> Iterator[Frame]:
        """One frame after another (units as of Frame)."""
        number = 0
        while True:
            try:
                frame = self[number]
            except IndexError:
                return
            yield frame
            number += 1
