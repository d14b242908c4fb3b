"""Runs: directories that `ropewalk run` left."""
from __future__ import annotations

import json
import os
from collections.abc import Sequence
from importlib import import_module
from typing import Any, Optional, TypedDict

import numpy as np

from . import _core
from .errors import InputError
from .forces import OwnForce
from .frames import _AMU, Frames
from .log import Log
from .scene import Scene
from .simulation import Simulation


class Limit(TypedDict):
    """A limit that a run watched.

    Keys:
        key: as in the [limits] of a scene
        unit: of `limit` and `largest`; "" for a pure number
        limit: in `unit`; 0: not watched
        largest: the value farthest beyond its limit, in `unit`, below 0 where a bond is pressed, as the limit is
        largest_at_ps: its time, ps
        tube, element: where, from 0; -1: nowhere (no unit)
        passed: whether the limit was passed
        passed_at_ps: when it was first, ps
        passed_at_step: the same as a time step (no unit)
        passed_tube, passed_element: where it was first, from 0; -1: nowhere (no unit)
        passed_held_by: what holds that place, as "the upper clamp"; "" for nothing (no unit)
    """

    key: str
    unit: str
    limit: float
    largest: float
    largest_at_ps: float
    tube: int
    element: int
    passed: bool
    passed_at_ps: float
    passed_at_step: int
    passed_tube: int
    passed_element: int
    passed_held_by: str


class Run:
    """The directory of a run. Files are read when they are asked for, so that a run at work can be looked at."""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        """Reads the scene of the run.

        Arguments:
            directory: that `ropewalk run --out` made (no unit)
        """
        self._path = os.fspath(directory)
        self._absolute = os.path.abspath(self._path)
        self._scene = Scene._of_run(self._path)

    def __repr__(self) -> str:
        """Directory, status, and since when (ps) it is beyond a limit."""
        beyond = _core.beyond_words(self._path)
        return f"<Run {self.path}: {self.status}{', ' if beyond else ''}{beyond}>"

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled by its directory (no unit)."""
        return Run, (self._absolute,)

    def __eq__(self, other: object) -> bool:
        """Whether `other` is the same directory (no unit)."""
        return isinstance(other, Run) and os.path.realpath(self._absolute) == os.path.realpath(other._absolute)

    def __hash__(self) -> int:
        """Equal for equal directories (no unit)."""
        return hash(os.path.realpath(self._absolute))

    def _file(self, name: str) -> str:
        return os.path.join(self._path, name)

    @property
    def path(self) -> str:
        """The directory (no unit)."""
        return self._path

    @property
    def scene(self) -> Scene:
        """The scene as the run had it; units stand in the names of its keys."""
        return self._scene

    @property
    def log(self) -> Log:
        """log.csv as it is now: columns (rows,), their units in log.units."""
        return Log(self._file("log.csv"))

    @property
    def frames(self) -> Frames:
        """The stored frames: positions in nm, energies in eV, times in ps."""
        return Frames(os.path.abspath(_core.frames_file(self._path)), self._scene)

    def to_mdanalysis(self) -> Any:
        """The frames as an MDAnalysis.Universe in its units: positions, radii and box in Å, masses in u, times in ps. `dt` is
        that between the first two frames. A residue is a tube, whose number is its resid; its resname and the segment are the
        parameter set of its type, so that "resid 0" and "segid cnt-5-5-tersoff" select."""
        path = _core.frames_file(self._path)
        if not path.endswith(".gsd"):
            raise InputError(f"{path}: has positions that MDAnalysis takes relative to a box that moves; make frames.gsd by "
                             "`ropewalk convert`", path)
        frames, core = self.frames, self._scene._core
        times = [frame.time_ps for frame in frames]

        # The file has no place for times that MDAnalysis reads.
        def in_its_units(timestep: Any) -> Any:
            timestep.data["time"] = times[timestep.frame]
            if len(times) > 1:
                timestep.data["dt"] = times[1] - times[0]
            timestep.positions = 10 * timestep.positions
            timestep.dimensions = [*(10 * timestep.dimensions[:3]), 90, 90, 90]
            return timestep

        universe = import_module("MDAnalysis").Universe(path)
        if times:
            tube = frames[0].tube
            universe.atoms.masses = core.mass[tube] / _AMU
            universe.atoms.radii = 10 * core.radius[tube]
            names = [_core.parameter_set(path)[1] for path in core.sets]
            universe.add_TopologyAttr("resnames", [names[of_type] for of_type in core.tube_type])
            tube_type = np.asarray(core.tube_type)
            for of_type, name in enumerate(names):
                segment = universe.add_Segment(segid=name)
                universe.residues[np.flatnonzero(tube_type == of_type)].segments = segment
        universe.trajectory.add_transformations(in_its_units)
        return universe

    @property
    def manifest(self) -> dict[str, Any]:
        """Program, inputs and how the run ended: the keys of manifest.json, with units in their names."""
        found: dict[str, Any] = json.loads(_core.manifest_json(self._file("manifest.json")))
        return found

    @property
    def status(self) -> str:
        """running, finished, interrupted, stopped, refined, failed or not relaxed (no unit)."""
        return str(self.manifest["status"])

    @property
    def limits(self) -> list[Limit]:
        """The limits that the run watched, each in its unit."""
        found: list[Limit] = json.loads(_core.limits_json(self._file("limits.json")))["limits"]
        return found

    @property
    def first_limit(self) -> Optional[Limit]:
        """The limit that was passed first, in its unit; what comes after `passed_at_ps` is beyond the model. None: all hold."""
        passed = [limit for limit in self.limits if limit["passed"]]
        passed.sort(key=lambda limit: (limit["passed_at_ps"], limit["passed_at_step"]))
        return passed[0] if passed else None

    @property
    def results(self) -> dict[str, Any]:
        """What came of it, as tables of runs have it: first_limit, torque_max_nN_nm and more, with units in the names of the
        keys; nan: the run has no such value."""
        return {"status": self.status, **_core.run_results(self._path)}

    @property
    def refinements(self) -> list[dict[str, Any]]:
        """Splittings of the elements, with units in the names of the keys; empty where there were none."""
        found: list[dict[str, Any]] = json.loads(_core.limits_json(self._file("limits.json")))["refinements"]
        return found

    def simulation(self, *, forces: Sequence[OwnForce] = ()) -> Simulation:
        """A simulation in memory that goes on from the last checkpoint of the run (units as of Simulation).

        The files of the run stay as they are.

        Arguments:
            forces: those that the run was begun with (eV/nm, eV)
        """
        out = Simulation(self._scene, forces=forces)
        out._core.restore_run(self._path)
        return out


def open(directory: str | os.PathLike[str]) -> Run:
    """Opens a run: its log, frames, scene, manifest and limits, in nm, ps, eV and nN nm as their names say.

    Arguments:
        directory: that `ropewalk run --out` made (no unit)
    """
    if not os.path.isdir(directory):
        raise InputError(f"{os.fspath(directory)}: is no directory; name the directory of a run", os.fspath(directory))
    return Run(directory)
