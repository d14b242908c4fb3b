"""Stored frames of a run."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Optional, Union, overload

from . import _core
from .errors import InputError
from .observables import index_of, observables
from .state import Elements, Floats, State


class Frame(State):
    """The elements of all tubes at one time of a run, as stored: positions, orientations and values to colour by.

    Velocities are not stored.
    """

    def __init__(
        self, flat: Elements, tube_begin: Sequence[int], element_length_nm: float, file: _core.Frames, number: int,
        step: int, time_ps: float,
    ) -> None:
        """As Frames makes it.

        Arguments:
            flat, tube_begin, element_length_nm: as of State (nm)
            file, number: where it comes from (no unit)
            step: time step (no unit)
            time_ps: ps
        """
        super().__init__(flat, tube_begin, element_length_nm)
        self._file = file
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

    def measure(self, name: Optional[str] = None) -> Union[float, dict[str, float]]:
        """Observables of this frame: one by its name, in the unit that the name ends in, or all as a dict.

        Arguments:
            name: of an observable with in_frames; None: all of these
        """
        if name is not None and not observables()[index_of(name)].in_frames:
            raise InputError(f"{name} is not known from a frame; take it from run.log", key=name)
        values = dict(zip((o.name for o in observables()), self._file.measure(self._number)))
        if name is not None:
            return values[name]
        return {o.name: values[o.name] for o in observables() if o.in_frames}


class Frames(Sequence[Frame]):
    """The frames of a run: len(), frames[i] (also from the end), frames[a:b:c], and iteration.

    A frame is read from the file when it is asked for, in any order.
    """

    def __init__(self, file: _core.Frames, scene: _core.Scene, numbers: Optional[range] = None) -> None:
        """As Run makes it.

        Arguments:
            file: the reader
            scene: that of the run
            numbers: of the frames in the file; None: all (no unit)
        """
        self._file = file
        self._scene = scene
        self._numbers = numbers

    def __len__(self) -> int:
        """Number of frames (no unit)."""
        return len(self._file) if self._numbers is None else len(self._numbers)

    def __repr__(self) -> str:
        """Number of frames (no unit)."""
        return f"<Frames: {len(self)}>"

    def _frame(self, number: int) -> Frame:
        step, time, position, orientation, colours = self._file.at(number)
        flat = Elements(position, orientation, **colours)
        return Frame(flat, self._scene.tube_begin, self._scene.element_length, self._file, number, step, time)

    @overload
    def __getitem__(self, index: int) -> Frame: ...

    @overload
    def __getitem__(self, index: slice) -> Frames: ...

    def __getitem__(self, index: Union[int, slice]) -> Union[Frame, Frames]:
        """A frame by its number, or some of the frames by a slice (no unit)."""
        if isinstance(index, slice):
            return Frames(self._file, self._scene, (range(len(self)) if self._numbers is None else self._numbers)[index])
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
