"""Elements as atoms, and atoms of ASE and MDAnalysis as elements."""
from __future__ import annotations

import logging
import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from itertools import chain
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .energy import SetName, _set_name
from .errors import InputError
from .frames import Frame, Frames
from .numbers import finite, real_array
from .parameters import ParameterSet
from .runs import Run
from .scene import Scene
from .simulation import Simulation
from .state import Floats, State

_log = logging.getLogger("ropewalk")
_CARBON = 12.011  # u
_Path = Union[str, "os.PathLike[str]"]


@dataclass(frozen=True, eq=False)
class Atoms:
    """Carbon atoms of elements.

    Attributes:
        position: (atoms, 3), nm
        tube: (atoms,), tube of each atom, from 0 (no unit)
        element: (atoms,), its element, counted in the tube from 0 (no unit)
        time_ps: ps; 0 where the elements have no time
    """

    position: Floats
    tube: NDArray[np.int64]
    element: NDArray[np.int64]
    time_ps: float = 0.0

    def __len__(self) -> int:
        """Number of atoms (no unit)."""
        return len(self.position)

    def to_ase(self) -> Any:
        """As ase.Atoms, positions in Å, with the arrays "tube" and "element" and info["time_ps"]. There is no box."""
        atoms = import_module("ase").Atoms("C" * len(self), positions=10 * self.position)
        atoms.set_array("tube", self.tube)
        atoms.set_array("element", self.element)
        atoms.info["time_ps"] = self.time_ps
        return atoms

    def to_mdanalysis(self) -> Any:
        """As an MDAnalysis.Universe of one frame, positions in Å, masses in u. A residue is a tube, whose number is its
        resid; the tempfactor of an atom is its element. There is no box."""
        return _universe(self, [self])


def _universe(first: Atoms, frames: Iterable[Atoms]) -> Any:
    tubes, residue = np.unique(first.tube, return_inverse=True)
    universe = import_module("MDAnalysis").Universe.empty(
        len(first), n_residues=len(tubes), atom_resindex=residue, trajectory=False)
    universe.add_TopologyAttr("names", ["C"] * len(first))
    universe.add_TopologyAttr("types", ["C"] * len(first))
    universe.add_TopologyAttr("elements", ["C"] * len(first))
    universe.add_TopologyAttr("masses", np.full(len(first), _CARBON))
    universe.add_TopologyAttr("tempfactors", first.element)
    universe.add_TopologyAttr("resids", tubes)
    places, times = [], []
    for atoms in frames:
        places.append((10 * atoms.position).astype(np.float32))
        times.append(atoms.time_ps)
    apart = times[1] - times[0] if len(times) > 1 else 1.0
    universe.load_new(np.array(places), format=_timed_reader(times), order="fac", dt=apart)
    return universe


def _timed_reader(times: list[float]) -> Any:
    """The reader of arrays of MDAnalysis, with times that need not be evenly apart."""
    base = import_module("MDAnalysis.coordinates.memory").MemoryReader

    class TimedReader(base):  # type: ignore[misc,valid-type]
        def _read_next_timestep(self, ts: Any = None) -> Any:
            found = super()._read_next_timestep(ts)
            found.time = times[found.frame]
            return found

    return TimedReader


def _broken(of: Any, scene: Scene) -> list[int]:
    """Elements behind which tubes have broken (no unit)."""
    if isinstance(of, Frame):
        return _core.broken_in_run(os.path.join(os.path.dirname(of._of._path), "events.csv"), scene._core, of.time_ps)
    return _core.broken_now(of._core) if isinstance(of, Simulation) else _core.broken_at_start(scene._core)


def atoms(
    of: Union[State, Scene, Simulation, Run, _Path],
    parameters: Union[SetName, Sequence[SetName], None] = None,
    *,
    tube_types: Sequence[int] = (),
    tubes: Sequence[int] = (),
    from_nm: Optional[float] = None,
    to_nm: Optional[float] = None,
) -> Atoms:
    """The atoms of elements, as `ropewalk atoms` writes them: positions in nm, and which element each one is of. No atom
    stands between the parts of a tube that has broken.

    Arguments:
        of: a run, whose last frame counts, a frame, a scene (its start), a simulation, a state, or a state file
        parameters: the set of a state or state file, or one for each type of tube; all others know theirs
        tube_types: which of these sets each tube is, from 0; empty: all the first (no unit)
        tubes: those that are wanted, from 0; empty: all (no unit)
        from_nm: leaves out what comes earlier along a tube at rest, nm
        to_nm: leaves out what comes later, nm
    """
    wanted = ([int(t) for t in tubes], from_nm, to_nm)
    if isinstance(of, Run):
        of = of.frames[-1]
    scene = of._of._scene if isinstance(of, Frame) else of if isinstance(of, Scene) else None
    if isinstance(of, Simulation):
        scene = of.scene
    state = of.start if isinstance(of, Scene) else of.state if isinstance(of, Simulation) else of
    time = of.time_ps if isinstance(of, (Frame, Simulation)) else 0.0
    if scene is not None and parameters is None:
        assert isinstance(state, State)
        found = _core.atoms_in_scene(scene._core, real_array(state.flat.position, "position"),
                                     real_array(state.flat.orientation, "orientation"), _broken(of, scene), *wanted)
        return Atoms(*found, time)
    if parameters is None:
        raise TypeError("a state alone does not know its parameter set: give `parameters`")
    one = isinstance(parameters, (str, os.PathLike, ParameterSet))
    sets: Sequence[SetName] = [parameters] if one else parameters  # type: ignore[list-item,assignment]
    options = _core.StateOptions([_set_name(s) for s in sets], list(tube_types), "", "", False, 0.0, 0.0, 0, False)
    if isinstance(state, State):
        flat = state.flat
        found = _core.atoms_of_state(
            state.tube_begin.tolist(), real_array(flat.position, "position"), real_array(flat.orientation, "orientation"),
            state.element_length_nm, options, *wanted)
    else:
        found = _core.atoms_of_file(os.fspath(state), options, *wanted)
    return Atoms(*found, time)


def atoms_universe(frames: Union[Run, Frames, Sequence[Frame]]) -> Any:
    """The atoms of frames as an MDAnalysis.Universe with a trajectory, positions in Å, times in ps. All frames are in
    memory, 12 bytes an atom each; of a long run take some: run.frames[::10].

    Arguments:
        frames: a run, its frames, or some of them
    """
    chosen = frames.frames if isinstance(frames, Run) else frames
    return _universe(atoms(chosen[0]), (atoms(frame) for frame in chosen))


# --- atoms to elements ---

_FrameOf = tuple[Floats, Optional[Floats], Optional[Floats], Optional[tuple[bool, bool, bool]], float]


def _frames_of_ase(images: Iterable[Any], name: str, frame_ps: Optional[float],
                   periodic: Optional[tuple[bool, bool, bool]]) -> Iterator[_FrameOf]:
    per_ps = 100 * import_module("ase.units").fs  # from Å over its unit of time to nm/ps
    numbers = None
    for k, image in enumerate(images):
        if numbers is not None and not np.array_equal(numbers, image.numbers):
            raise InputError(f"{name}: image {k} has other atoms than the first one; give images of one simulation", name)
        numbers = image.numbers
        pbc = periodic or _flags(image.pbc)
        box = np.asarray(image.cell.complete()) / 10 if pbc and any(pbc) else None
        if box is not None and not abs(np.linalg.det(box)) > 0:
            raise InputError(f"{name}: image {k} is periodic and has no cell; set its cell, or pbc to False", name)
        moving = image.has("momenta")
        time = k * frame_ps if frame_ps is not None else float(image.info.get("time_ps", k))
        yield image.positions / 10, image.get_velocities() * per_ps if moving else None, box, pbc, time


# As a number, a step of MD of carbon is shorter in ps and longer in fs.
_LONGEST_STEP_PS = 0.05


def _times_of_mdanalysis(trajectory: Any, name: str, frame_ps: Optional[float]) -> Callable[[int, Any], float]:
    """The time of frame k and its Timestep, ps, as MDAnalysis has it; a warning says where it has none. A DCD of LAMMPS
    holds the step in LAMMPS's unit of time and not the unit, which MDAnalysis takes for that of CHARMM, or for fs."""
    if frame_ps is not None:
        given = frame_ps
        return lambda k, timestep: k * given
    header = getattr(getattr(trajectory, "_file", None), "header", None)
    if isinstance(header, dict) and str(header.get("remarks")).startswith("Written by LAMMPS"):
        delta, first, every = float(header["delta"]), int(header["istart"]), int(header["nsavc"])
        unit, step = ("ps", delta) if delta < _LONGEST_STEP_PS else ("fs", delta / 1000)
        _log.warning("%s: LAMMPS left out its unit of time; its step of %.4g is taken as %s, and frames are %.4g ps apart; "
                     "if they are not, say frame_ps", name, delta, unit, every * step)
        return lambda k, timestep: (first + k * every) * step
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        apart = trajectory.ts.dt
    unknown = "time" not in trajectory.ts.data and any("no dt" in str(warning.message) for warning in told)
    # MDAnalysis writes such a DCD where it is not given dt.
    unknown |= isinstance(header, dict) and header.get("nsavc") == 1 and abs(apart - 1) < 1e-6
    if unknown and len(trajectory) > 1:
        _log.warning("%s: MDAnalysis has no times of it, and takes frames to be 1 ps apart; if they are not, say frame_ps",
                     name)
    return lambda k, timestep: float(timestep.time)


def _frames_of_mdanalysis(group: Any, name: str, frame_ps: Optional[float],
                          periodic: Optional[tuple[bool, bool, bool]]) -> Iterator[_FrameOf]:
    trajectory = group.universe.trajectory
    time_of = _times_of_mdanalysis(trajectory, name, frame_ps)
    for k, timestep in enumerate(trajectory):
        box = None
        if timestep.dimensions is not None and (periodic is None or any(periodic)):
            vectors = np.asarray(timestep.triclinic_dimensions, np.float64) / 10
            box = vectors if abs(np.linalg.det(vectors)) > 0 else None
        moving = timestep.has_velocities
        yield (group.positions.astype(np.float64) / 10, group.velocities.astype(np.float64) / 10 if moving else None, box,
               periodic, time_of(k, timestep))


def _carbon_of_mdanalysis(group: Any, name: str) -> NDArray[np.bool_]:
    """Which atoms are carbon: by their elements, else by their masses; atoms of one type without a mass are."""
    elements = getattr(group, "elements", None)
    if elements is not None and all(elements):
        return np.array([element.upper() == "C" for element in elements])
    masses = getattr(group, "masses", None)
    if masses is not None and (np.asarray(masses) > 1.5).any():
        return np.asarray(np.abs(np.asarray(masses) - _CARBON) < 0.2)
    types = getattr(group, "types", None)
    if types is None or len(set(types)) == 1:
        return np.ones(len(group), bool)
    raise InputError(f"{name}: has {len(set(types))} types of atoms without elements and masses; give them: "
                     'universe.add_TopologyAttr("masses", ...)', name)


def _named(path: Any) -> str:
    return os.path.basename(os.fspath(path)) if isinstance(path, (str, os.PathLike)) else "atoms"


def _flags(periodic: Union[bool, Sequence[bool], None]) -> Optional[tuple[bool, bool, bool]]:
    if periodic is None:
        return None
    found = [bool(p) for p in np.broadcast_to(np.asarray(periodic), 3)]
    return found[0], found[1], found[2]


def coarsen(
    atoms: Any,
    out: _Path,
    parameters: Union[SetName, Sequence[SetName]] = (),
    *,
    element_length_nm: Optional[float] = None,
    frame_ps: Optional[float] = None,
    time_step_fs: float = 1.0,
    periodic: Union[bool, Sequence[bool], None] = None,
    force: bool = False,
) -> Run:
    """Makes a run of atoms, as `ropewalk coarsen`, and opens it. The tubes are found from the places of the carbon atoms
    alone, in the first frame; found-tubes.csv in the run says which. One frame after another is read, and none is kept.

    Arguments:
        atoms: an MDAnalysis.Universe or AtomGroup with its whole trajectory; ase.Atoms, or an iterable of them such as
            ase.io.iread(...); or files that the program reads, as one name or several (no unit)
        out: directory of the run to make
        parameters: sets of the tubes; empty: shipped ones
        element_length_nm: nm; None: that of the first set
        frame_ps: time between frames, ps; None: times of MDAnalysis, info["time_ps"] of ASE, or else 1
        time_step_fs: of the steps of a dump that states no time, fs; of files alone
        periodic: whether the box is, or that along each of its edges; None: as ASE says, and as fits the atoms for
            MDAnalysis, which does not say (no unit)
        force: replaces an earlier run in `out`
    """
    one = isinstance(parameters, (str, os.PathLike, ParameterSet))
    sets: Sequence[SetName] = [parameters] if one else parameters  # type: ignore[list-item,assignment]
    names = [_set_name(s) for s in sets]
    length = 0.0 if element_length_nm is None else finite(element_length_nm, "element_length_nm", 0)
    apart = None if frame_ps is None else finite(frame_ps, "frame_ps", 0)
    directory = os.fspath(out)
    if isinstance(atoms, (str, os.PathLike)):
        atoms = [atoms]
    if isinstance(atoms, (list, tuple)) and atoms and all(isinstance(a, (str, os.PathLike)) for a in atoms):
        step = finite(time_step_fs, "time_step_fs", 0)
        _core.coarsen_files(files=[os.fspath(a) for a in atoms], out=directory, force=force, parameters=names,
                            element_length=length, time_step_fs=step, tell=_log.warning)
        return Run(out)
    flags = _flags(periodic)
    if hasattr(atoms, "trajectory") or hasattr(atoms, "universe"):  # a Universe or an AtomGroup
        group = atoms.atoms
        name = _named(getattr(group.universe.trajectory, "filename", None))
        carbon = _carbon_of_mdanalysis(group, name)
        frames = _frames_of_mdanalysis(group, name, apart, flags)
    else:
        images = iter([atoms] if hasattr(atoms, "numbers") else atoms)
        name = "atoms"
        first = next(images, None)
        if first is None:
            raise InputError(f"{name}: there is no image; give one or more", name)
        if not hasattr(first, "numbers"):
            raise TypeError(f"{type(first).__name__}: atoms of ASE, MDAnalysis or files are needed")
        carbon = first.numbers == 6
        frames = _frames_of_ase(chain([first], images), name, apart, flags)
    _core.coarsen_frames(next=lambda: next(frames, None), carbon=carbon.tolist(), name=name, out=directory, force=force,
                         parameters=names, element_length=length, tell=_log.warning)
    return Run(out)
