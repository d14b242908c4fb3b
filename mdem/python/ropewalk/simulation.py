"""Simulations that Python steps."""
from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Optional, Union, overload

from . import _core
from .errors import BusyError, Error, InputError
from .files import read_regular, write_whole
from .forces import OwnForce, checked
from .numbers import finite, whole
from .observables import index_of, observables
from .scene import Scene, as_scene
from .state import Elements, Floats, State

_most_steps = 2**53  # beyond, a log has no place for their number


_DRIVES = ("grip", "load", "thermostat", "twist")  # the tables that change() may change


@dataclass(frozen=True)
class Energies:
    """Energies of a state, eV.

    Attributes:
        stretch, shear, bend, twist: of the bonds, eV
        vdw: of the contacts between tubes, eV
        terms: of all force terms, such as tethers, eV
        kinetic: of translation and rotation, eV
    """

    stretch: float
    shear: float
    bend: float
    twist: float
    vdw: float
    terms: float = 0.0
    kinetic: float = 0.0

    @property
    def bonds(self) -> float:
        """Of all bonds, eV."""
        return self.stretch + self.shear + self.bend + self.twist

    @property
    def potential(self) -> float:
        """Of bonds, contacts and force terms, eV."""
        return self.bonds + self.vdw + self.terms

    @property
    def total(self) -> float:
        """Potential and kinetic, eV."""
        return self.potential + self.kinetic


@dataclass(frozen=True)
class Relaxed:
    """How a relaxation ended.

    Attributes:
        at_rest: whether the goal was reached
        force_eV_per_nm: the largest force left, torques over the tube's radius included, eV/nm
        above_eV: energy above the minimum by estimate, eV; inf: no minimum is near; nan: not known
        error: relative error of the energy of the bonds by estimate (no unit)
        saddles: saddles of the energy that the relaxation left on its way (no unit)
        falls_eV: it ended on a saddle, beyond which the energy falls by so much or more, eV; 0: on none
    """

    at_rest: bool
    force_eV_per_nm: float
    above_eV: float
    error: float
    saddles: int
    falls_eV: float


class Simulation:
    """A scene in motion, step by step. Forces, loads, damping and thermostat are those of `ropewalk run`.

    The motion is the same, bit for bit, on any number of threads, and however the steps are divided into calls. The
    program also halves its step where the energy balance does not close, watches limits and ends by [[stop]]; here you
    see all of it by measure("balance_eV"), measure("kinked") and so on, and set `divided` yourself.

    Another Python thread may run while this one steps. The simulation itself belongs to one thread at a time.
    """

    def __init__(
        self, scene: Scene | Mapping[str, Any] | str | os.PathLike[str], *, forces: Sequence[OwnForce] = ()
    ) -> None:
        """The state of the scene at time zero.

        Arguments:
            scene: a scene, a dict of its keys (units stand in their names), or a file
            forces: forces of one's own: functions that get an Instant and return forces (elements, 3) in eV/nm, or a
                tuple of forces, torques about the centres (elements, 3) in eV, and energy in eV. None stands for zeros.
                A force with an energy is one of the system; the work of one without counts as that of loads. The time
                step does not know how stiff they are: set run.time_step_fs for stiff ones.
        """
        self._of_start = self._scene = as_scene(scene)
        self._forces = tuple(forces)
        core = self._of_start._core
        own = [checked(f, core.tube_begin, core.element_length) for f in self._forces]
        self._core = _core.Simulation(core, own)
        self._hooks: list[tuple[Callable[[Simulation], object], int]] = []
        self._observers: list[tuple[Callable[[Simulation], object], int]] = []
        self._moving = threading.Lock()
        self._mover = 0

    def __repr__(self) -> str:
        """Scene, step and time, ps."""
        try:
            return f"<Simulation of {self._scene.name}: step {self.step_number}, {self.time_ps:g} ps>"
        except BusyError:
            return f"<Simulation of {self._scene.name}, at work>"

    @contextmanager
    def _motion(self, what: str) -> Iterator[None]:
        """Around all that moves the state: it belongs to one call at a time."""
        if not self._moving.acquire(blocking=False):
            if self._mover == threading.get_ident():
                raise Error(f"a hook, an observer or a force cannot {what} the simulation that calls it")
            raise BusyError("the simulation is at work in another thread")
        self._mover = threading.get_ident()
        try:
            yield
        finally:
            self._mover = 0
            self._moving.release()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by the scene, the forces and the checkpoint, without hooks and observers (no unit)."""
        return _simulation_again, (self._of_start, self._forces, self.checkpoint())

    def __eq__(self, other: object) -> bool:
        """Whether `other` has the same scene and forces, and stands at the same state to the bit (no unit)."""
        return isinstance(other, Simulation) and (self._of_start, self._forces, self.checkpoint()) == (
            other._of_start, other._forces, other.checkpoint())

    __hash__ = None  # type: ignore[assignment]

    @property
    def scene(self) -> Scene:
        """The scene, with the changes of change(); units stand in the names of its keys."""
        return self._scene

    @property
    def forces(self) -> tuple[OwnForce, ...]:
        """The forces of one's own."""
        return self._forces

    @property
    def step_number(self) -> int:
        """Steps since the start (no unit)."""
        return self._core.step

    @property
    def time_ps(self) -> float:
        """Time, ps."""
        return self._core.time

    @property
    def time_step_fs(self) -> float:
        """By how much a step takes time forward, fs."""
        return 1000 * self._core.time_step

    @property
    def divided(self) -> int:
        """Into how many shorter steps a step is divided, 1 at first; steps are counted as before (no unit)."""
        return self._core.divided

    @divided.setter
    def divided(self, parts: int) -> None:
        self._core.divided = whole(parts, "divided", 1, 1024)

    # --- motion ---

    def step(self, n: int = 1, *, energies: bool = True) -> None:
        """Steps on. Ctrl-C ends it between two steps; the simulation can then go on.

        Arguments:
            n: so many steps (no unit)
            energies: whether the last step computes the energies, a tenth of a step; without, they are computed when
                they are asked for, which takes a whole evaluation of the forces
        """
        n = whole(n, "the number of steps", 0, _most_steps)
        with self._motion("step"):
            self._steps(n, energies)

    def _steps(self, n: int, energies: bool = True) -> None:
        end = self.step_number + n
        while self.step_number < end:
            self._call(self._hooks)
            at = self.step_number
            stop = min([end, *(at - at % every + every for _, every in self._observers + self._hooks)])
            self._core.steps(stop - at, energies or stop < end)
            self._call(self._observers)

    def step_until(self, time_ps: float) -> None:
        """Steps on to a time, in whole steps.

        Arguments:
            time_ps: ps
        """
        time_ps = finite(time_ps, "time_ps")
        with self._motion("step"):
            left = time_ps - self.time_ps
            if left < -1e-9:
                raise ValueError(f"{time_ps} ps lie before {self.time_ps} ps")
            self._steps(whole(round(left / self._core.time_step), "the number of steps", 0, _most_steps))

    def relax(
        self, force_eV_per_nm: Optional[float] = None, energy: Optional[float] = None, *, max_steps: Optional[int] = None
    ) -> Relaxed:
        """Goes to a nearby minimum of the energy (FIRE), under the loads of now; velocities are zero afterwards.

        What is None is that of the [run] of the scene.

        Arguments:
            force_eV_per_nm: largest force at the end, torques over the tube's radius included, eV/nm
            energy: relative error of the energy of the bonds at the end, by estimate (no unit)
            max_steps: at most so many steps (no unit)
        """
        of_scene = self._scene._core.goal
        goal = (
            of_scene[0] if force_eV_per_nm is None else finite(force_eV_per_nm, "force_eV_per_nm", 0),
            of_scene[1] if energy is None else finite(energy, "energy", 0),
            of_scene[2] if max_steps is None else whole(max_steps, "max_steps", 0, _most_steps),
        )
        with self._motion("relax"):
            return Relaxed(*self._core.relax(*goal))

    def change(self, changes: Mapping[str, Any]) -> None:
        """From now on grips, loads, twist and bath are those of `scene.changed(changes)` at this time: a moment jumps to its new
        value, a clamp moves on from where it is, by what its new schedule rises. All else of the scene stays, the time step too.

        Arguments:
            changes: values by key, with the table before it, as of Scene.changed: {"twist.moment_nN_nm": 6},
                {"grip.1.about_z.rotation_deg": [[0, 0], [20, 5]]}. Times in schedules count from the start, ps.
        """
        scene = self._scene.changed(changes)
        before, after = self._scene._whole_keys(), scene._whole_keys()
        for name in {**before, **after}:
            if name not in _DRIVES and before.get(name) != after.get(name):
                raise InputError(f"{name}: stays as it is while a simulation runs; make a simulation of the other scene",
                                 key=name)
        self._core.drive(scene._core)
        self._scene = scene

    # --- hooks and observers ---

    def add_hook(self, hook: Callable[[Simulation], object], every: int = 1) -> None:
        """Calls a function before every so many steps: where the number of steps so far is a multiple of `every`.

        Arguments:
            hook: gets this simulation and may change() it; what it returns is not used, what it raises ends step()
            every: steps (no unit)
        """
        self._hooks.append((hook, whole(every, "every", 1)))

    def remove_hook(self, hook: Callable[[Simulation], object]) -> None:
        """Takes a hook away.

        Arguments:
            hook: the function that was given to add_hook (no unit)
        """
        self._hooks = [(f, every) for f, every in self._hooks if f is not hook]

    def add_observer(self, observer: Callable[[Simulation], object], every: int) -> None:
        """Calls a function after every so many steps: those whose number is a multiple of `every`.

        Arguments:
            observer: gets this simulation; what it returns is not used, what it raises ends step()
            every: steps (no unit)
        """
        self._observers.append((observer, whole(every, "every", 1)))

    def remove_observer(self, observer: Callable[[Simulation], object]) -> None:
        """Takes an observer away.

        Arguments:
            observer: the function that was given to add_observer (no unit)
        """
        self._observers = [(f, every) for f, every in self._observers if f is not observer]

    def _call(self, functions: Sequence[tuple[Callable[[Simulation], object], int]]) -> None:
        for function, every in list(functions):
            if self.step_number % every == 0:
                function(self)

    # --- what it is like now ---

    @property
    def state(self) -> State:
        """The state, as views: no copies, read-only, and always of the present step. Positions are in nm.

        position (tubes, elements, 3) in nm, orientation (tubes, elements, 4), velocity in nm/ps and angular_velocity in
        rad/ps, or all of them under `flat`. Take a .copy() to keep one. A view keeps the simulation in memory.
        """
        c = self._core
        flat = Elements(c.position, c.orientation, c.velocity, c.angular_velocity)
        return State(flat, self._of_start._core.tube_begin, self._of_start.element_length_nm)

    @property
    def force(self) -> Floats:
        """Forces on all elements, loads included, a view (elements, 3), eV/nm."""
        return self._core.force

    @property
    def torque(self) -> Floats:
        """Torques on all elements about their centres, loads included, a view (elements, 3), eV."""
        return self._core.torque

    @property
    def largest_force_eV_per_nm(self) -> float:
        """Largest force, torques over the tube's radius included, constrained components left out, eV/nm."""
        return self._core.largest_force

    @property
    def energies(self) -> Energies:
        """Energies by kind, eV."""
        return Energies(*self._core.energies, self._core.kinetic)

    @overload
    def measure(self, name: str) -> float: ...

    @overload
    def measure(self, name: None = None) -> dict[str, float]: ...

    def measure(self, name: Optional[str] = None) -> Union[float, dict[str, float]]:
        """Observables: one by its name, in the unit that the name ends in, or all as a dict.

        They are those of log.csv. Forces and torques at the ends are means since the step that was measured before. All are
        computed at the first call after a step, which takes about as long as a step.

        Arguments:
            name: of an observable, see observables(); None: all
        """
        index = None if name is None else index_of(name)
        values = self._core.measure()
        return dict(zip((o.name for o in observables()), values)) if index is None else values[index]

    # --- files ---

    def checkpoint(self) -> bytes:
        """Everything that the future depends on, for restore() (no unit)."""
        return self._core.checkpoint()

    def restore(self, checkpoint: bytes | str | os.PathLike[str]) -> None:
        """Goes back to a checkpoint of a simulation of the same scene: from there on all is the same, bit for bit.

        Arguments:
            checkpoint: what checkpoint() returned, or the file that save() wrote (no unit)
        """
        if not isinstance(checkpoint, bytes):
            checkpoint = read_regular(checkpoint)
        with self._motion("restore"):
            self._core.restore(checkpoint)
            text = self._core.driven_as
            self._scene = Scene.from_toml(text) if text else self._of_start

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the checkpoint to a file for restore(), whole or not at all.

        Arguments:
            path: the file (no unit)
        """
        write_whole(path, self.checkpoint())

    def write_state(self, path: str | os.PathLike[str]) -> None:
        """Writes the state as final.csv of a run: nm, nm/ps, rad/ps. Scenes start from it by {"state": {"file": path}}.
        What friction, links and tethers remember goes into a second file beside it, whose name ends in -memory.csv.

        Arguments:
            path: the file (no unit)
        """
        state, memory, memory_path = self._core.state_files(os.fspath(path))
        if memory:
            write_whole(memory_path, memory.encode())
        write_whole(path, state.encode())


def _simulation_again(scene: Scene, forces: tuple[OwnForce, ...], checkpoint: bytes) -> Simulation:
    simulation = Simulation(scene, forces=forces)
    simulation.restore(checkpoint)
    return simulation
