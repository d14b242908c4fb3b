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
from .runs import Run
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
    common_noise: bool = False,
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
        common_noise: all points have the random numbers of one; without it each has its own
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
        if common_noise:
            table["common_noise"] = True
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
        mean_ps: means over the last rows of so much time, ps, each with its standard error in a column NAME_error, which is
            nan where that time is too short for one, and with NAME_correlation_ps; None: the last row
        series: all rows of all logs instead of the ends
    """
    directory = campaign.path if isinstance(campaign, Campaign) else os.fspath(campaign)
    words = ["--columns", *columns] if columns else []
    return table_of(_call(["gather", directory, *_options(mean=mean_ps, series=series), *words]))


def threshold(
    scene: SceneLike,
    key: str,
    between: tuple[float, float],
    column: str,
    above: float,
    out: str | os.PathLike[str],
    *,
    vary: Mapping[str, Any] = {},
    accuracy: float = 0.02,
    replicates: Optional[int] = None,
    known: Optional[str | os.PathLike[str]] = None,
    jobs: Optional[int] = None,
    force: bool = False,
) -> dict[str, NDArray[Any]]:
    """The critical value of a key at each point of a sweep, as `ropewalk threshold`: columns (points,), units in the names.

    The same call goes on after an interruption. `out` then has thresholds.html, and all trials in trials.csv.

    Arguments:
        scene: a scene, a dict of its keys (units stand in their names), or a file
        key: that is searched, "twist.moment_nN_nm"
        between: its lowest and largest value, in the unit of the key
        column: observable that decides, by its name
        above: the value that it must pass, in the unit of the column
        out: directory of the campaign
        vary: values by key, as of sweep(); empty: the scene alone
        accuracy: relative, of the critical value (no unit)
        replicates: each point so many times, with other seeds (no unit)
        known: trials.csv of an earlier search, whose trials of the same scenes are not run again
        jobs: points at a time; None: one on each core (no unit)
        force: replaces runs of another scene
    """
    of = as_scene(scene)
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as folder, _scene_file(of) as path:
        table: dict[str, Any] = {"format": "ropewalk-sweep-1", "scene": path}
        if replicates is not None:
            table["replicates"] = replicates
        if vary:
            table["vary"] = dict(vary)
        table["threshold"] = {"key": key, "from": between[0], "to": between[1], "column": column, "above": above,
                              "accuracy": accuracy}
        file_name = os.path.join(folder, "sweep.toml")
        with open(file_name, "w", encoding="utf-8") as file:
            file.write(toml_of(table))
        _call(["threshold", file_name, f"--out={os.fspath(out)}", "--quiet",
               *_options(known=known, jobs=jobs, force=force)])
    with open(os.path.join(os.fspath(out), "thresholds.csv"), encoding="utf-8", newline="") as read:
        return table_of(read.read())


def _directory(run: Run | str | os.PathLike[str]) -> str:
    return run.path if isinstance(run, Run) else os.fspath(run)


def compare(
    runs: Sequence[Run | Campaign | str | os.PathLike[str]],
    *,
    x: str = "time_ps",
    y: Sequence[str] = (),
    mean_ps: Optional[float] = None,
    page: Optional[str | os.PathLike[str]] = None,
    force: bool = False,
) -> dict[str, NDArray[Any]]:
    """The curves of runs and campaigns side by side, as `ropewalk compare`: columns (rows,) by name, units in the names.

    Replicates of a campaign are one curve, with its standard errors.

    Arguments:
        runs: runs and campaigns, or their directories
        x: observable on the horizontal axis
        y: observables; empty: the usual ones that vary
        mean_ps: one row for each run instead, of means over the last so many ps with their errors and correlation times; None: curves
        page: a page with all curves (HTML) to write as well
        force: replaces an existing page
    """
    names = [r.path if isinstance(r, Campaign) else _directory(r) for r in runs]
    words = ["--y", ",".join(y)] if y else []
    if page is not None:
        _call(["compare", *names, f"--page={os.fspath(page)}", f"--x={x}", *_options(force=force, mean=mean_ps), *words])
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as folder:
        path = os.path.join(folder, "curves.csv")
        _call(["compare", *names, f"--csv={path}", f"--x={x}", *_options(mean=mean_ps), *words])
        with open(path, encoding="utf-8", newline="") as file:
            return table_of(file.read())


def picture(
    run: Run | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    at_ps: Sequence[float] = (),
    seen_from: str = "side",
    colour: Optional[str] = None,
    curves: Sequence[str] = (),
    sections: bool = False,
    width: Optional[float] = None,
    highest: Optional[float] = None,
    zoom: Optional[float] = None,
    force: bool = False,
) -> str:
    """Draws states of a run for a paper, as `ropewalk picture`, and returns the file.

    Arguments:
        run: a run, or its directory
        out: file to write: .svg, .pdf or .png
        at_ps: times of the states, ps; empty: four over the run
        seen_from: "side" (the largest deflection in the page), "x", "y", "z", or two angles "30,20" in deg
        colour: what tubes are coloured by, as "tension" or "shell"; None: bending moment, where frames have it
        curves: charts below: columns of log.csv, "twist_eV+bend_eV" for two in one
        sections: the cross-section of each state beside it
        width: of the figure, pixels (no unit)
        highest: largest height of a state, pixels (no unit)
        zoom: pixels of a PNG per pixel of the figure (no unit)
        force: replaces the file
    """
    lists = {"at": ",".join(map(repr, map(float, at_ps))) or None, "curves": ",".join(curves) or None}
    _call(["picture", _directory(run), "-o", os.fspath(out), f"--from={seen_from}",
           *_options(colour=colour, sections=sections, width=width, highest=highest, zoom=zoom, force=force, **lists)])
    return os.fspath(out)


def view(
    run: Run | str | os.PathLike[str],
    out: Optional[str | os.PathLike[str]] = None,
    *,
    frames: int = 100,
    megabytes: float = 15,
    force: bool = False,
) -> str:
    """Writes a page to turn, play and cut through the frames of a run, as `ropewalk view`, and returns the file.

    Arguments:
        run: a run, or its directory
        out: page to write; None: view.html in the directory of the run
        frames: at most so many, evenly over the run (no unit)
        megabytes: the page is not longer, 10^6 bytes (no unit of the model)
        force: replaces the file
    """
    file = os.fspath(out) if out is not None else os.path.join(_directory(run), "view.html")
    _call(["view", _directory(run), "-o", file, *_options(frames=frames, megabytes=megabytes, force=force)])
    return file


def convert(
    run: Run | str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    from_ps: float = 0,
    to_ps: Optional[float] = None,
    every: int = 1,
    force: bool = False,
) -> str:
    """Writes the frames of a run in another format, as `ropewalk convert`, and returns the file.

    Arguments:
        run: a run, or its directory
        out: file to write: .gsd, .lammpstrj or .pvd (ParaView)
        from_ps: leaves out what is earlier, ps
        to_ps: leaves out what is later, ps; None: nothing
        every: every so manieth frame (no unit)
        force: replaces the file
    """
    _call(["convert", _directory(run), os.fspath(out), *_options(from_ps=from_ps, to_ps=to_ps, every=every, force=force)])
    return os.fspath(out)


def errors(
    run: Run | str | os.PathLike[str],
    *,
    numerics: bool = False,
    mean_ps: Optional[float] = None,
    jobs: Optional[int] = None,
    again: bool = False,
) -> dict[str, Any]:
    """Error bars of a finished run, from the standard errors of its parameter sets, friction files and scene numbers, as
    `ropewalk errors`, which repeats the run: what `--json` says, with units in the names.

    Arguments:
        run: a run, or its directory
        numerics: the whole error of each result, also by elements, time step, rate, and other starts; "decides" names its largest part
        mean_ps: with `numerics`, of means over the last so many ps; None: of the last row
        jobs: runs at a time; None: one for each core (no unit)
        again: repeats also what is finished
    """
    found: dict[str, Any] = json.loads(_call(["errors", _directory(run), "--json", "--quiet",
                                              *_options(numerics=numerics, mean=mean_ps, jobs=jobs, again=again)]))
    return found


def rest(
    scene: SceneLike,
    out: str | os.PathLike[str],
    *,
    viscosity: Optional[float] = None,
    tolerance: float = 0.02,
    jobs: Optional[int] = None,
    force: bool = False,
) -> dict[str, Any]:
    """Where a rope under a moment comes to rest, from below and from above, as `ropewalk rest`: what `--json` says, with
    units in the names. "agree" tells whether both sides do and are at rest; angles are None where they do not. "verdict" is
    "rests", "creeps" (with an "estimate"), "moves", "apart" or "several".

    Arguments:
        scene: a scene, a dict of its keys (units stand in their names), or a file
        out: directory of both runs; the same call goes on after an interruption
        viscosity: contact viscosity (eV ps/nm^3); None: the scene's, or a tenth of the default
        tolerance: part of the twist within which both sides agree (no unit)
        jobs: runs at a time; None: one on each core (no unit)
        force: replaces runs of another scene
    """
    with _scene_file(as_scene(scene)) as path:
        found: dict[str, Any] = json.loads(_call(["rest", path, f"--out={os.fspath(out)}", "--json", "--quiet",
                                                  *_options(viscosity=viscosity, tolerance=tolerance, jobs=jobs,
                                                            force=force)]))
    return found


def modes(
    state: Run | SceneLike,
    *,
    count: int = 8,
    shift_per_ns: float = 50,
    anyway: bool = False,
) -> dict[str, NDArray[Any]]:
    """Which motions of a state at rest grow, how fast, and what they move, as `ropewalk modes`: columns (count,) by name, the fastest
    growing motion first, units in the names.

    Arguments:
        state: a run, whose newest checkpoint counts; or a scene, a dict of its keys, or a file, at its start
        count: motions to find (no unit)
        shift_per_ns: those nearest to this rate (unit 1/ns), which should be above the largest
        anyway: also for a state that does not rest
    """
    with tempfile.TemporaryDirectory(prefix="ropewalk-") as folder:
        path = os.path.join(folder, "modes.csv")
        words = [f"--csv={path}", *_options(count=count, shift=shift_per_ns, anyway=anyway)]
        if isinstance(state, Run):
            _call(["modes", state.path, *words])
        else:
            with _scene_file(as_scene(state)) as scene:
                _call(["modes", scene, *words])
        with open(path, encoding="utf-8", newline="") as file:
            return table_of(file.read())


def parametrize(
    chiralities: Sequence[tuple[int, int]],
    out: str | os.PathLike[str] = "parametrized",
    *,
    potentials: Sequence[str] = ("tersoff",),
    tier: str = "full",
    budget_min: Optional[float] = None,
    jobs: Optional[int] = None,
    again: bool = False,
) -> list[ParameterSet]:
    """From chiralities to validated sets, as `ropewalk parametrize`: calibrates, makes atoms, validates, reports. It takes from
    minutes to hours; the same call goes on after an interruption. Returns the sets (units as of Quantity).

    Arguments:
        chiralities: (n, m) of each tube (no unit)
        out: directory of sets, atoms and reports, with report.html
        potentials: "tersoff", "airebo", "rebo", "lcbop" (no unit)
        tier: "full", or "quick": cases without ropes and bundles (no unit)
        budget_min: that the references of one tube may take, min (60 s); None: any
        jobs: processes at a time; None: one for each core (no unit)
        again: makes sets and results anew; references of atoms are kept
    """
    _call(["parametrize", *(f"{n},{m}" for n, m in chiralities), f"--out={os.fspath(out)}", "--quiet",
           f"--potential={','.join(potentials)}", *_options(tier=tier, budget=budget_min, jobs=jobs, again=again)])
    names = [f"cnt-{n}-{m}-{potential}.toml" for n, m in chiralities for potential in potentials]
    return [ParameterSet(os.path.join(os.fspath(out), name)) for name in names]


def calibrate(
    chirality: tuple[int, int] | Sequence[tuple[int, int]],
    out: Optional[str | os.PathLike[str]] = None,
    *,
    atoms: str | os.PathLike[str] = "C",
    potential: Optional[str] = None,
    carried_by: Optional[str] = None,
    epsilon_eV: Optional[float] = None,
    sigma_nm: Optional[float] = None,
    lj_cutoff_nm: Optional[float] = None,
    envelope: bool = False,
    force: bool = False,
) -> ParameterSet:
    """Derives the parameter set of a tube from atoms, as `ropewalk calibrate`: some seconds. LAMMPS is needed.

    Arguments:
        chirality: (n, m), or one for each wall, inside first (no unit)
        out: file to write, with its tables beside it; None: as cnt-10-10-tersoff.toml in the current directory
        atoms: "C", "BN", or a file that names species, potentials and contact of another honeycomb
        potential: between bonded atoms: "tersoff", "airebo", "rebo" or "lcbop" of carbon; None: the first of the atoms
        carried_by: several walls: those that carry stretch and torsion, "outer" or "all"; None: all where they lock
        epsilon_eV: depth of the Lennard-Jones law between atoms of two tubes, eV; None: that of carbon, or of the file
        sigma_nm: its length, nm; None: that of carbon, or of the file
        lj_cutoff_nm: its cutoff, nm; 0: none; None: 1.2 for one wall, 3 for several
        envelope: measures kink, collapse and 1 % limits as well (minutes)
        force: replaces existing files
    """
    walls: list[Any] = [chirality] if isinstance(chirality[0], int) else list(chirality)
    written = "@".join(f"{n},{m}" for n, m in walls)
    law = None
    if epsilon_eV is not None or sigma_nm is not None:
        law = f"{2.84e-3 if epsilon_eV is None else epsilon_eV!r},{0.34 if sigma_nm is None else sigma_nm!r}"
    found = json.loads(_call(["calibrate", f"--chirality={written}", "--json", "--quiet",
                              *_options(out=os.fspath(out) if out is not None else None, atoms=os.fspath(atoms),
                                        potential=potential, carried_by=carried_by, lj=law, lj_cutoff=lj_cutoff_nm,
                                        envelope=envelope, force=force)]))
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
