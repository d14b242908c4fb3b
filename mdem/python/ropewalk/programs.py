"""What the programs of Ropewalk do, as functions: they are started, and their results read."""
from __future__ import annotations

import contextlib
import json
import logging
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn, Optional

from numpy.typing import NDArray

from .errors import InputError, NumericalError, ProgramError
from .parameters import ParameterSet
from .results import Campaign, Check, ValidationCase, table_of
from .scene import Scene, SceneLike, as_scene
from .toml import toml_of

_SCENE = "scene-of-python.toml"  # the temporary file of a scene that has none

_log = logging.getLogger("ropewalk")


def find_program() -> str:
    """The program `ropewalk` of this package: in a wheel inside of it, else in the tree it stands in, else on PATH (no unit)."""
    folder = os.path.dirname(os.path.abspath(__file__))
    for _ in range(5):
        for place in (os.path.join(folder, "bin", "ropewalk"), os.path.join(folder, "ropewalk")):
            if os.path.isfile(place) and os.access(place, os.X_OK):
                return place
        folder = os.path.dirname(folder)
    found = shutil.which("ropewalk")
    if not found:
        raise ProgramError("the program ropewalk is not there; install it beside the package, or name its folder in PATH")
    return found


def main() -> NoReturn:
    """Becomes the program, with the arguments of this process: the command `ropewalk` of a wheel (no unit)."""
    program = find_program()
    os.execv(program, [program, *sys.argv[1:]])


def _said(line: str) -> str:
    """A line of a program without its name: "ropewalk run: ..." is of `run`."""
    name, colon, rest = line.partition(": ")
    return rest if colon and name.split()[:1] == ["ropewalk"] else line


def _call(arguments: Sequence[str], accept: Sequence[int] = (0,)) -> str:
    """Starts `ropewalk`; returns its standard output. What it says on the way is logged as "ropewalk"."""
    process = subprocess.Popen(
        [find_program(), *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace"
    )
    try:
        out, told = process.communicate()
    except KeyboardInterrupt:  # let the program end by itself, with a checkpoint
        process.send_signal(signal.SIGINT)
        process.communicate()
        raise
    lines = [_said(line) for line in told.splitlines() if line.strip()]
    if process.returncode in accept:
        for line in lines:
            _log.warning(line)
        return out
    text = lines[-1] if lines else f"ropewalk {arguments[0]} ended with code {process.returncode}"
    for argument in arguments:
        if os.path.basename(argument) == _SCENE:
            text = text.replace(argument, "scene")
    if process.returncode == 2:
        raise InputError(text)
    if process.returncode == 3:
        raise NumericalError(text)
    raise ProgramError(text, process.returncode)


@contextlib.contextmanager
def _scene_file(scene: Scene) -> Iterator[str]:
    """The file of a scene; a temporary one where it has none, with whole paths in it."""
    if scene._path is not None:
        yield scene._path
        return
    _ = scene.time_step_fs  # what is wrong is said here, without the name of a temporary file
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as folder:
        path = os.path.join(folder, _SCENE)
        with open(path, "w", encoding="utf-8") as file:
            file.write(toml_of(scene._whole_keys()))
        yield path


def _options(**given: Any) -> list[str]:
    """--name=value of each that is not None or False; True is a flag alone."""
    words = []
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        words.append(option if value is True else f"{option}={value}")
    return words


def sweep(
    scene: SceneLike,
    vary: Mapping[str, Any],
    out: str | os.PathLike[str],
    *,
    replicates: Optional[int] = None,
    combine: str = "grid",
    jobs: Optional[int] = None,
    on_limit: str = "warn",
    again: bool = False,
    force: bool = False,
) -> Campaign:
    """Runs a scene for many values of its keys, as `ropewalk sweep`. The same call goes on after an interruption.

    Arguments:
        scene: a scene, a dict of its keys (units stand in their names), or a file
        vary: values by key, with the table before it: {"rope.tubes": [7, 19]}, or {"from": 20, "to": 60, "points": 5}
        out: directory of the campaign
        replicates: each point so many times, with other seeds (no unit)
        combine: "grid": every value with every other; "zip": the first values, then the second ones, ...
        jobs: runs at a time; None: one on each core (no unit)
        on_limit: where a limit of [limits] is passed: "warn" or "stop"
        again: runs failed points once more
        force: replaces points that were run with another scene
    """
    of = as_scene(scene)
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as folder, _scene_file(of) as path:
        table: dict[str, Any] = {"format": "ropewalk-sweep-1", "scene": path, "combine": combine, "vary": dict(vary)}
        if replicates is not None:
            table["replicates"] = replicates
        file_name = os.path.join(folder, "sweep.toml")
        with open(file_name, "w", encoding="utf-8") as file:
            file.write(toml_of(table))
        _call(["sweep", file_name, f"--out={os.fspath(out)}", "--quiet",
               *_options(jobs=jobs, on_limit=on_limit, again=again, force=force)])
    return Campaign(out)


def gather(
    campaign: Campaign | str | os.PathLike[str],
    *,
    columns: Sequence[str] = (),
    mean_ps: Optional[float] = None,
    series: bool = False,
) -> dict[str, NDArray[Any]]:
    """The table of a campaign as `ropewalk gather` makes it: columns (rows,) by name, units in the names.

    Arguments:
        campaign: a campaign, or its directory
        columns: observables; empty: all
        mean_ps: means over the last rows of so much time, ps; None: the last row
        series: all rows of all logs instead of the ends
    """
    directory = campaign.path if isinstance(campaign, Campaign) else os.fspath(campaign)
    words = ["--columns", *columns] if columns else []
    return table_of(_call(["gather", directory, *_options(mean=mean_ps, series=series), *words]))


def calibrate(
    chirality: tuple[int, int],
    out: Optional[str | os.PathLike[str]] = None,
    *,
    potential: str = "tersoff",
    epsilon_eV: float = 2.84e-3,
    sigma_nm: float = 0.34,
    lj_cutoff_nm: float = 1.2,
    envelope: bool = False,
    force: bool = False,
) -> ParameterSet:
    """Derives the parameter set of a tube from atoms, as `ropewalk calibrate`: some seconds. LAMMPS is needed.

    Arguments:
        chirality: (n, m) (no unit)
        out: file to write, with its tables beside it; None: cnt-N-M-POTENTIAL.toml in the current directory
        potential: between bonded atoms: "tersoff", "airebo", "rebo" or "lcbop"
        epsilon_eV: depth of the Lennard-Jones law between atoms of two tubes, eV
        sigma_nm: its length, nm
        lj_cutoff_nm: its cutoff, nm; 0: none
        envelope: measures kink, collapse and 1 % limits as well (minutes)
        force: replaces existing files
    """
    n, m = chirality
    found = json.loads(_call(["calibrate", f"--chirality={n},{m}", "--json", "--quiet",
                              *_options(out=os.fspath(out) if out is not None else None, potential=potential,
                                        lj=f"{epsilon_eV!r},{sigma_nm!r}", lj_cutoff=lj_cutoff_nm, envelope=envelope,
                                        force=force)]))
    return ParameterSet(found["file"])


def validate(
    cases: Sequence[str] = (),
    *,
    parameters: Optional[str | os.PathLike[str] | ParameterSet] = None,
    tier: str = "full",
    atoms: bool = False,
    out: str | os.PathLike[str] = "validation",
    jobs: Optional[int] = None,
    again: bool = False,
) -> list[ValidationCase]:
    """Holds the model against theory and atoms, as `ropewalk validate run`. Every number has its unit in Check.unit.

    Arguments:
        cases: names of cases; empty: all
        parameters: a parameter set to run them with; None: that of each case
        tier: "full", or "quick": without ropes and bundles
        atoms: makes the references of the set's tube with LAMMPS (minutes)
        out: directory of results and report; finished cases in it are not run again
        jobs: cases at a time; None: one for each core (no unit)
        again: runs finished cases again
    """
    name = parameters.path if isinstance(parameters, ParameterSet) else parameters
    told = _call(["validate", "run", "--json", "--quiet",
                  *_options(parameters=os.fspath(name) if name is not None else None, tier=tier, atoms=atoms,
                            out=os.fspath(out), jobs=jobs, again=again), *cases], (0, 1))
    return [
        ValidationCase(
            case["case"],
            case["verdict"],
            tuple(
                Check(c["name"], c["value"], c["reference"], c["unit"], c["tolerance"], c["relative"], c["holds"],
                      c["informative"])
                for c in case["checks"]
            ),
            os.path.join(os.fspath(out), "report.html"),
        )
        for case in json.loads(told)["cases"]
    ]
