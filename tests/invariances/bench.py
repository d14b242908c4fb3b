"""Scenes as tables, states as rows, runs of the program, and how two runs may differ."""
import copy
import csv
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "cli"))
from stops import is_relaxation, pair, run_table, shortened  # noqa: E402

SOURCES = ("rope", "plies", "film", "chain", "state")
AXES = ("x", "y", "z", "about_x", "about_y", "about_z")
EXACT_FILES = ("final.csv", "final-memory.csv", "log.csv", "frames.gsd", "events.csv")


class Skip(Exception):
    """The transformation does not apply to the scene; the text says why."""


class Differs(Exception):
    """What must not matter does; the text says what differs."""


def skip_if(condition, why):
    if condition:
        raise Skip(why)


# --- scenes ----------------------------------------------------------------------------------------------------------


def _value(v):
    if isinstance(v, bool):
        return "true" if v else "false"
    if isinstance(v, dict):
        return "{ " + ", ".join(f"{k} = {_value(x)}" for k, x in v.items()) + " }"
    if isinstance(v, list):
        return "[" + ", ".join(map(_value, v)) + "]"
    return json.dumps(v) if isinstance(v, str) else repr(v)


class Scene(dict):
    """A scene file: tables of keys; tables that may stand several times are lists."""

    @staticmethod
    def of(text):
        return Scene(tomllib.loads(text))

    def copy(self):
        return copy.deepcopy(self)

    def text(self):
        def is_table(v):
            return isinstance(v, dict) or isinstance(v, list) and v and isinstance(v[0], dict)

        lines = [f"{k} = {_value(v)}" for k, v in self.items() if not is_table(v)]
        for name, v in self.items():
            if is_table(v):
                for table in v if isinstance(v, list) else [v]:
                    lines.append(f"[[{name}]]" if isinstance(v, list) else f"[{name}]")
                    lines += [f"{k} = {_value(x)}" for k, x in table.items()]
        return "\n".join(lines) + "\n"

    def with_keys(self, **tables):
        """Another scene: with_keys(run={"duration_ps": 3}); None takes a key or a table away."""
        out = self.copy()
        for name, keys in tables.items():
            if not isinstance(keys, dict):
                if keys is None:
                    out.pop(name, None)
                else:
                    out[name] = keys
                continue
            table = out.setdefault(name, {})
            for key, value in keys.items():
                if value is None:
                    table.pop(key, None)
                else:
                    table[key] = value
        return out

    @property
    def source(self):
        return next(s for s in SOURCES if s in self)

    def list(self, name):
        return self.get(name, [])

    def sets(self):
        return self["parameters"] if isinstance(self["parameters"], list) else [self["parameters"]]

    def relaxes(self):
        return self.get("run", {}).get("mode") == "relax"

    def bigger(self, duration):
        """Of some 600 elements or more, which several threads share, for a shorter time."""
        out = self.copy()
        table = out[self.source]
        for key, least in (("tubes", 19 if self.source == "plies" else 37), ("elements", 600)):
            if key in table:
                table[key] = max(table[key], least)
        if "tube_types" in out:
            out["tube_types"] = [k % 2 for k in range(table["tubes"])]
        if self.source == "film":
            out["film"].update(width_nm=60, depth_nm=60)
        return out if self.relaxes() else out.with_keys(run={"duration_ps": duration})

    def is_warm(self):
        return "thermostat" in self or self.get("start", {}).get("temperature_K", 0) > 0

    def tube_count(self):
        if self.source == "plies":
            return self["plies"]["ropes"] * self["plies"]["tubes"]
        return self[self.source].get("tubes", 1)

    def has_strands(self):
        return "tube_length_nm" in self.get("rope", {})

    def has_memory(self):
        return any(t in self for t in ("friction", "links", "tether", "failure"))


def each_value(spec, change):
    """A component of a grip with `change` made to its values, not to its rates and times."""
    if not isinstance(spec, dict):
        return spec

    def of(v):
        if isinstance(v, list) and v and isinstance(v[0], list):
            return [[time, change(x)] for time, x in v]
        return [change(x) for x in v] if isinstance(v, list) else change(v)

    return {k: v if k.startswith("rate_") else of(v) for k, v in spec.items()}


def negative(spec):
    return each_value(spec, lambda v: 0 - v)


# --- states ----------------------------------------------------------------------------------------------------------


def times(p, q):
    """The product of two quaternions, w first."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e)


def turned(v, q):
    w, x, y, z = q
    return times(times(q, (0, *v)), (w, -x, -y, -z))[1:]


class State:
    """The rows of a state file: tube, position, quaternion, velocity, angular velocity."""

    def __init__(self, path):
        lines = pathlib.Path(path).read_text().splitlines()
        self.header = lines[0]
        # Without the sum over the numbers: they are changed here.
        self.notes = [line for line in lines if line.startswith("#") and not line.startswith("# elements_and_sum")]
        cells = [line.split(",") for line in lines[1:] if not line.startswith("#")]
        self.rows = [(int(c[0]), *(tuple(map(float, c[k:k + n])) for k, n in ((1, 3), (4, 4), (8, 3), (11, 3))))
                     for c in cells]

    def note(self, word):
        return next((line for line in self.notes if line.startswith(f"# {word}:")), None)

    def without_memory(self):
        self.notes = [line for line in self.notes if not line.startswith("# memory")]
        return self

    def each(self, change):
        self.rows = [(row[0], *change(*row[1:])) for row in self.rows]
        return self

    def write(self, path):
        lines = [",".join([str(row[0])] + [repr(x) for part in row[1:] for x in part]) for row in self.rows]
        pathlib.Path(path).write_text("\n".join([self.header, *self.notes, *lines]) + "\n")

    def tubes(self):
        out = {}
        for row in self.rows:
            out.setdefault(row[0], []).append(row)
        return list(out.values())


# --- runs ------------------------------------------------------------------------------------------------------------


class Run:
    """A run directory and how the program ended."""

    def __init__(self, path, done):
        self.path, self.code, self.said = pathlib.Path(path), done.returncode, done.stderr + done.stdout

    def __truediv__(self, name):
        return self.path / name

    @property
    def log(self):
        return read_log(self.path / "log.csv")

    @property
    def manifest(self):
        return json.loads((self.path / "manifest.json").read_text())

    def state(self):
        return State(self.path / "final.csv")


def read_log(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return {name: [float(row[k]) if row[k] else math.nan for row in rows[1:]] for k, name in enumerate(rows[0])}


# --- comparisons -----------------------------------------------------------------------------------------------------


def same_files(a, b, files=EXACT_FILES):
    for name in files:
        one, other = a / name, b / name
        if one.exists() != other.exists():
            raise Differs(f"{name} is in one of the two")
        if one.exists() and one.read_bytes() != other.read_bytes():
            raise Differs(f"{name}: {first_difference(one, other)}")


def first_difference(one, other):
    if one.suffix not in (".csv", ".json"):
        return "other bytes"
    first, second = one.read_text().splitlines(), other.read_text().splitlines()
    if len(first) != len(second):
        return f"{len(first)} and {len(second)} lines"
    for k, (x, y) in enumerate(zip(first, second)):
        if x != y:
            head = next((line for line in first if not line.startswith("#")), "").split(",")
            cells = [(h, p, q) for h, p, q in zip(head, x.split(","), y.split(",")) if p != q]
            return f"line {k + 1}: " + ", ".join(f"{h} {p} / {q}" for h, p, q in cells[:3])
    return "other bytes"


def unit_of(column):
    return column.rsplit("_", 1)[-1] if "_" in column else ""


def same_columns(a, b, within, rounding=1e-9, only=None, leave=(), sign=lambda name: 1, other=lambda name: name,
                 factor=lambda name: 1, last=False, floor=1e-12):
    """Columns of two logs are equal, within a part of the largest value of the column and `rounding` of the largest
    in the column's unit. `sign`, `factor` and `other` say what b has for a column of a. Rows are compared by number."""
    names = [n for n in a if n not in ("step", *leave) and (only is None or n in only) and other(n) in b]
    count = len(a["time_ps"])
    if not last and count != len(b["time_ps"]):
        raise Differs(f"{count} and {len(b['time_ps'])} rows")
    largest = {}
    for n in names:
        most = max((abs(x) for x in a[n] if math.isfinite(x)), default=0)
        largest[n] = most
        largest[unit_of(n)] = max(most, largest.get(unit_of(n), 0))
    found = []
    for n in names:
        slack = within * largest[n] + rounding * largest[unit_of(n)] + floor
        worst, words = 1, ""
        for k in [-1] if last else range(count):
            x, y = factor(n) * a[n][k], sign(n) * b[other(n)][k]
            if math.isnan(x) and math.isnan(y):
                continue
            off = abs(x - y) / (slack * abs(factor(n)))
            if not off <= worst:
                worst = off if math.isfinite(off) else math.inf
                words = f"{n} {x:.8g} / {y:.8g} at {a['time_ps'][k]:.4g} ps"
        if words:
            found.append((worst, words))
    if found:
        found.sort(reverse=True)
        more = f"; {len(found)} columns" if len(found) > 3 else ""
        raise Differs("; ".join(words for _, words in found[:3]) + more)


def near(name, x, y, within, floor=0.0):
    if not abs(x - y) <= within * max(abs(x), abs(y)) + floor:
        raise Differs(f"{name} {x:.10g} / {y:.10g}")


def by_time(log, times_wanted):
    """The log at other times, between its rows on straight lines."""
    own = log["time_ps"]
    out = {name: [] for name in log}
    k = 0
    for time in times_wanted:
        while k + 2 < len(own) and own[k + 1] < time:
            k += 1
        part = (time - own[k]) / (own[k + 1] - own[k])
        for name, values in log.items():
            x, y = values[k], values[k + 1]
            out[name].append(x if part == 0 else y if part == 1 else x + part * (y - x))
    out["time_ps"] = list(times_wanted)
    return out


# --- the bench -------------------------------------------------------------------------------------------------------


class Bench:
    """The program, a folder, and the runs that several transformations compare with."""

    def __init__(self, program, folder):
        self.program, self.folder = pathlib.Path(program).resolve(), pathlib.Path(folder)
        self.build = self.program.parent.parent
        self.scenes, self.kept = {}, {}
        self.add_templates()
        self.add_more()

    def call(self, *arguments, cwd=None, environment=None):
        return subprocess.run([str(self.program), *map(str, arguments)], cwd=cwd or self.folder, capture_output=True,
                              text=True, env={**os.environ, **environment} if environment else None)

    def add_templates(self):
        for line in self.call("new", "--list").stdout.splitlines():
            kind = line.split()[0]
            self.call("new", "template", "--kind", kind, "--short", "--force")
            text = shortened((self.folder / "template.toml").read_text())
            scene = Scene.of(text if is_relaxation(text) else text + run_table(6, 0.5, 2, 1000))
            self.scenes[kind] = scene.with_keys(expect=None)

    def add_more(self):
        """What no template has."""
        for file in sorted((HERE / "scenes").glob("*.toml")):
            self.scenes[file.stem] = Scene.of(file.read_text())
        (self.folder / "pair.csv").write_text(pair())

    def data(self, folder):
        return HERE.parent.parent / "data" / folder

    def defaults(self):
        """By table, the keys whose default is a value that can be typed."""
        if "defaults" not in self.kept:
            self.call("new", "template", "--kind", "rope", "--force")
            found, table = {}, ""
            for line in (self.folder / "template.toml").read_text().splitlines():
                if header := re.fullmatch(r"(?:# )?\[+(\w+)\]+", line):
                    table = header[1]
                key = re.fullmatch(r"(?:# )?(\w+) = (.*?) +# .*\(default: (.*)\)", line)
                if key and key[2] == key[3]:
                    found.setdefault(table, {})[key[1]] = tomllib.loads(f"x = {key[2]}")["x"]
            self.kept["defaults"] = found
        return self.kept["defaults"]

    def instruction_sets(self):
        said = self.call("run", "--help").stdout
        names = re.search(r"Instruction set of the calculation[^:]*: ([^\[]*)", " ".join(said.split()))
        return names[1].strip().split(", ")

    def interpreter(self):
        """Of the package, which belongs to one version of Python."""
        if "interpreter" not in self.kept:
            found = [p for p in (sys.executable, "/usr/bin/python3") if subprocess.run(
                [p, "-c", "import ropewalk"], env=self.with_package(), capture_output=True).returncode == 0]
            self.kept["interpreter"] = (found or [sys.executable])[0]
        return self.kept["interpreter"]

    def with_package(self):
        return {**os.environ, "PYTHONPATH": str(self.build / "mdem" / "python")}

    def python(self, script):
        done = subprocess.run([self.interpreter(), "-B", "-c", script], cwd=self.folder, capture_output=True, text=True,
                              env=self.with_package())
        return done.stdout or done.stderr

    def has_python(self, module="ropewalk"):
        key = f"python {module}"
        if key not in self.kept:
            self.kept[key] = self.python(f"import ropewalk, {module}; print('here')").startswith("here")
        return self.kept[key]

    def lammps(self):
        program = self.build / "mdem" / "lammps" / "lmp-ropewalk"
        return program if program.exists() else None

    def case(self, kind, transformation, seed):
        return Case(self, kind, random.Random(f"{seed}/{kind}/{transformation}"))


class Case:
    """One scene under one transformation."""

    def __init__(self, bench, kind, numbers):
        self.bench, self.kind, self.random = bench, kind, numbers
        self.count = 0

    @property
    def scene(self):
        return self.bench.scenes[self.kind].copy()

    @property
    def folder(self):
        return self.bench.folder

    def name(self):
        self.count += 1
        return f"other-{self.count}"

    def start(self, scene, *options, name=None):
        """Runs a scene, refused or not."""
        name = name or self.name()
        (self.folder / f"{name}.toml").write_text(scene if isinstance(scene, str) else scene.text())
        count = [] if "--threads" in options else ["--threads", 1]
        done = self.bench.call("run", f"{name}.toml", "--out", name, "--quiet", "--force", *count, *options)
        return Run(self.folder / name, done)

    def run(self, scene, *options, name=None):
        """Runs a scene that must run."""
        out = self.start(scene, *options, name=name)
        if out.code not in (0, 4, 7):
            raise Differs(f"ended with {out.code}: {out.said.strip()[-300:]}")
        return out

    def check(self, scene):
        (self.folder / "checked.toml").write_text(scene.text())
        done = self.bench.call("check", "checked.toml")
        if done.returncode != 0:
            raise Differs(f"check ended with {done.returncode}: {done.stderr.strip()[-300:]}")
        return done.stdout

    def energy(self, state, scene, *options):
        """What `ropewalk energy` says of a state: the JSON, or None where it refuses."""
        state.write(self.folder / "state.csv")
        sets = ",".join(scene.sets())
        law, bond = scene.get("contact", {}).get("law"), scene.get("bond", {}).get("law")
        types = scene.get("tube_types")
        done = self.bench.call("energy", "state.csv", "--parameters", sets, "--json", "--threads", 1,
                               *(["--law", law] if law else []), *(["--bond", bond] if bond else []),
                               *(["--tube-types", ",".join(map(str, types))] if types else []), *options)
        return json.loads(done.stdout) if done.returncode == 0 else None

    def kept(self, what, make):
        """A run that all transformations of this scene share."""
        key = f"{self.kind}-{what}"
        if key not in self.bench.kept:
            self.bench.kept[key] = make(key)
        return self.bench.kept[key]

    @property
    def base(self):
        return self.kept("base", lambda name: self.run(self.scene, name=name))

    def in_double(self):
        return self.scene.with_keys(contact={"precision": "double"})

    @property
    def double(self):
        """The scene in double precision, in which rounding is small."""
        return self.kept("double", lambda name: self.run(self.in_double(), name=name))

    def moving(self, change=None):
        """The scene from a state in the midst of its motion, in double precision; `change` makes another of it."""
        skip_if("periodic" in self.scene, "a slice begins as a [rope], not from a state file")
        early = ["--steps", 12] if self.scene.relaxes() else []
        first = self.kept("midst", lambda name: self.run(self.in_double(), *early, name=name))
        scene = self.in_double()
        scene = scene.with_keys(**{scene.source: None}).with_keys(start={k: None for k in (
            "temperature_K", "may_cool", "twist_deg_per_nm", "wave_nm", "half_waves")})
        state = first.state().without_memory()
        if scene.relaxes():
            state.each(lambda r, q, v, w: (r, q, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)))
        else:
            step = first.manifest["time_step_fs"]
            scene = scene.with_keys(
                run={"duration_ps": 3, "log_every_ps": 0.25, "time_step_fs": float(f"{0.8 * step:.3g}")})
        file = f"{self.kind}-{change.__name__ if change else 'midst'}.csv"
        scene["state"] = {"file": file}
        if change:
            scene, state = change(scene, state)
        state.write(self.folder / file)
        return scene

    @property
    def moved(self):
        return self.kept("moving", lambda name: self.run(self.moving(), name=name))
