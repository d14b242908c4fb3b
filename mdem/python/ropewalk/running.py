"""Runs of scenes in this process."""
from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from typing import Optional

from . import _core
from .forces import OwnForce, checked
from .runs import Run
from .scene import Scene, SceneLike, as_scene
from .threads import threads_at_most

_log = logging.getLogger("ropewalk")

Progress = Callable[[int, int, str], object]


def _options(
    steps: Optional[int], until_ps: Optional[float], threads: Optional[int], on_limit: str,
    wall_time_s: Optional[float], instructions: Optional[str], device: Optional[str],
    progress: Optional[Progress], forces: Sequence[OwnForce], core: Optional[_core.Scene],
) -> _core.RunOptions:
    return _core.RunOptions(
        steps=steps, until_ps=until_ps, threads=threads_at_most(threads), on_limit=on_limit, wall_time_s=wall_time_s,
        instructions=instructions or "", device=device or "", tell=_log.warning, progress=progress,
        forces=[checked(f, core.tube_begin, core.element_length) for f in forces] if core else [],
    )


def run(
    scene: SceneLike,
    out: str | os.PathLike[str],
    *,
    until_ps: Optional[float] = None,
    steps: Optional[int] = None,
    threads: Optional[int] = None,
    on_limit: str = "warn",
    wall_time_s: Optional[float] = None,
    instructions: Optional[str] = None,
    device: Optional[str] = None,
    force: bool = False,
    forces: Sequence[OwnForce] = (),
    progress: Optional[Progress] = None,
) -> Run:
    """Runs a scene as `ropewalk run` does, in a directory with log, frames, checkpoint and report. Times are in ps.

    It runs in this process; other threads of Python run meanwhile. Notes are logged by `logging` as "ropewalk". After
    Ctrl-C, which raises KeyboardInterrupt, the run can be resumed.

    Arguments:
        scene: a scene, a dict of its keys (units stand in their names), or a file
        out: directory to make
        until_ps: time to stop at instead of the scene's, ps
        steps: time step to stop at instead (no unit)
        threads: threads; None: as of set_threads(), at first all cores (no unit)
        on_limit: where a limit of [limits] is passed: "warn", "stop" or "refine" (it then goes on in OUT.fine)
        wall_time_s: stops with a checkpoint before the run has taken so long, s
        instructions: instruction set, for the same bits on other processors; runs of other threads may have others
        device: moves the elements: "gpu", "opencl:TEXT", "c++"; None: this processor alone (no unit)
        force: replaces an earlier run in `out`
        forces: forces of one's own, as Simulation takes them (eV/nm, eV), functions of the Instant alone: a run may go back
            some steps. No file holds them, only their names: resume() and Run.simulation() take them again, and the
            program refuses such a run where it would compute forces
        progress: called twice a second with the time step, the last one (0: not known) and a line of words (no unit)
    """
    of = as_scene(scene)
    if not forces:  # those of a run whose scene this is
        of._core.refuse_missing_forces()
    core = of._to_run()
    _core.run(core, os.fspath(out), force,
              _options(steps, until_ps, threads, on_limit, wall_time_s, instructions, device, progress, forces, core))
    return Run(out)


def resume(
    directory: str | os.PathLike[str],
    *,
    until_ps: Optional[float] = None,
    steps: Optional[int] = None,
    threads: Optional[int] = None,
    on_limit: str = "warn",
    wall_time_s: Optional[float] = None,
    accept_changes: bool = False,
    device: Optional[str] = None,
    forces: Sequence[OwnForce] = (),
    progress: Optional[Progress] = None,
) -> Run:
    """Goes on with a run from its last checkpoint, bit for bit, as `ropewalk resume`. Times are in ps.

    Arguments:
        directory: of the run
        until_ps: time to stop at, ps; None: the scene's
        steps: time step to stop at instead (no unit)
        threads: threads; None: as of set_threads(), at first all cores (no unit)
        on_limit: where a limit of [limits] is passed: "warn", "stop" or "refine"
        wall_time_s: stops with a checkpoint before the run has taken so long, s
        accept_changes: goes on although scene, parameter set or program are not what the run was begun with
        device: as of run(), "none": this processor alone; None: that of the run (no unit)
        forces: those that the run was begun with (eV/nm, eV); others of as many, by their names, with accept_changes
        progress: called twice a second with the time step, the last one (0: not known) and a line of words (no unit)
    """
    core = Scene._of_run(os.fspath(directory))._core if forces else None
    _core.resume(os.fspath(directory), accept_changes,
                 _options(steps, until_ps, threads, on_limit, wall_time_s, None, device, progress, forces, core))
    return Run(directory)
