"""Ropes of carbon nanotubes: scenes, simulations and runs of Ropewalk, with arrays of numpy.

    import ropewalk
    run = ropewalk.run({"parameters": "cnt-10-10-tersoff", "rope": {"tubes": 7, "length_nm": 14},
                        "twist": {"moment_nN_nm": 5, "rate_nN_nm_per_ps": 5}, "run": {"duration_ps": 2}}, "runs/first")
    run.log["beta_deg"], run.frames[-1].position

Lengths are in nm, times in ps, energies in eV, angles in rad; names of scene keys and observables end in their units.
docs/how-to/python.md is the page to read first.
"""
from __future__ import annotations

import os as _os
import sys as _sys

try:
    import numpy as _numpy  # noqa: F401
except ImportError:
    raise ImportError(f"ropewalk needs numpy, and {_sys.executable} has none: install it for this interpreter, or take "
                      "the one that has it (Debian's python3-numpy is for /usr/bin/python3)") from None


def _load_core() -> None:
    """Imports the module of the libraries. OpenMP reads its settings when it is loaded: threads that wait spin for some
    ten microseconds, as those of the program do, and then sleep."""
    chosen = "OMP_WAIT_POLICY" in _os.environ or "GOMP_SPINCOUNT" in _os.environ
    if not chosen:
        _os.environ["GOMP_SPINCOUNT"] = "2000"
    try:
        from . import _core
    finally:
        if not chosen:
            del _os.environ["GOMP_SPINCOUNT"]
    from .threads import _have_one_thread

    _os.register_at_fork(after_in_child=_have_one_thread)
    # The shipped data: in a wheel inside of the package, else in the tree that the package is installed in.
    here = _os.path.dirname(_os.path.abspath(__file__))
    for folder in (here, *(_os.path.normpath(_os.path.join(here, *[".."] * up)) for up in range(1, 5))):
        data = _os.path.join(folder, "share", "ropewalk")
        if _os.path.isdir(_os.path.join(data, "parameters")):
            _core.set_data_directory(data)
            return


_load_core()

from ._core import version as __version__  # noqa: E402
from .atoms import Atoms, atoms, atoms_universe, coarsen  # noqa: E402
from .energy import StateEnergy, energy  # noqa: E402
from .errors import BusyError, Error, InputError, NumericalError, ProgramError  # noqa: E402
from .frames import Frame, Frames  # noqa: E402
from .log import Log, Mean  # noqa: E402
from .observables import Observable, observables  # noqa: E402
from .parameters import ParameterSet, Quantity, parameter_sets  # noqa: E402
from .programs import (  # noqa: E402
    calibrate, compare, convert, errors, gather, modes, parametrize, picture, rest, sweep, threshold,
    validate, view,
)
from .results import Campaign, Check, ValidationCase  # noqa: E402
from .running import resume, run  # noqa: E402
from .runs import Limit, Run, open  # noqa: E402
from .scene import Scene  # noqa: E402
from .simulation import Energies, Relaxed, Simulation  # noqa: E402
from .state import Elements, Instant, State, write_state  # noqa: E402
from .threads import set_threads, threads  # noqa: E402

__all__ = [
    "Atoms", "BusyError", "Campaign", "Check", "Elements", "Energies", "Error", "Frame", "Frames", "InputError", "Instant",
    "Limit", "Log", "Mean", "NumericalError", "Observable", "ParameterSet", "ProgramError", "Quantity", "Relaxed", "Run",
    "Scene", "Simulation", "State", "StateEnergy", "ValidationCase", "atoms", "atoms_universe", "calibrate", "coarsen",
    "compare", "convert", "energy", "errors", "gather", "modes", "observables", "open", "parameter_sets", "parametrize",
    "picture", "rest", "resume", "run", "set_threads", "sweep", "threads", "threshold", "validate", "view", "write_state",
]


def __dir__() -> list[str]:
    """The public names alone, as completion shows them (no unit)."""
    return sorted([*__all__, "__doc__", "__version__"])
