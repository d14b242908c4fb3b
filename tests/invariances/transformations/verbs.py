"""The same quantity by other verbs, from Python and through LAMMPS."""
import json
import math
import os
import re
import shutil
import subprocess
import tomllib

from bench import EXACT_FILES, Differs, near, read_log, same_columns, same_files, skip_if
from transformations.common import OF_A_ROPE, ONE_CLAMP_ONLY, element_length, evaluated, transformation, undriven


@transformation
def steps_that_check_says(case):
    """Time step, steps and first energies, by `check` and by `run`."""
    scene = case.scene
    said, log = case.check(scene), case.base.log
    words = next(line for line in said.splitlines() if line.startswith("start: ")).split()
    near("energy of bonds", float(words[1]), sum(log[n][0] for n in ("stretch_eV", "shear_eV", "bend_eV", "twist_eV")),
         1e-4, 1e-6)
    near("van der Waals energy", float(words[5]), log["vdw_eV"][0], 1e-4, 1e-6)
    if scene.relaxes():
        return
    step = float(next(line for line in said.splitlines() if line.startswith("time step")).split()[2])
    near("time step", step, case.base.manifest["time_step_fs"], 1e-3)
    line = next(line for line in said.splitlines() if " ps = " in line)
    near("time", float(line.split()[0]), log["time_ps"][-1], 0.02)


@transformation
def limits_that_check_foresees(case):
    """When a limit is passed, by the forecast of `check` and by the run."""
    scene = case.in_double()
    skip_if(scene.relaxes(), "a relaxation has no time")
    skip_if(scene.is_warm(), "check foresees no heat")
    skip_if(any("tubes" in g for g in scene.list("grip")), "it pulls single tubes, as far as others hold them")
    scene = scene.with_keys(limits={"twist_deg": 0.6, "strain": 0.002, "wall_twist": 0.005})
    notes = [line for line in case.check(scene).splitlines() if "may bring" in line or "begins with" in line]
    found = {entry["key"]: {**entry, "largest": abs(entry["largest"]), "limit": abs(entry["limit"])}
             for entry in json.loads((case.run(scene) / "limits.json").read_text())["limits"]}
    for line in notes:
        words = line.split()
        key = words[words.index("bring" if "bring" in words else "with") + 1]
        if key not in ("twist_deg", "strain", "wall_twist") or "begins" in words:
            continue
        value, entry = abs(float(words[words.index("to") + 1].rstrip(","))), found[key]
        at = float(words[words.index("about") + 1]) if "about" in words else 0
        # A rope that moves overshoots, and one that follows slowly comes later or not at all within its time.
        if value > 8 * entry["largest"] + 8 * entry["limit"]:
            raise Differs(f"{key}: check foresees {value:.3g}, the run has at most {entry['largest']:.3g}")
        if entry["passed"] and entry["passed_at_ps"] < 0.25 * at - 0.2:
            raise Differs(f"{key}: check foresees it from {at:.3g} ps on, the run passes at "
                          f"{entry['passed_at_ps']:.3g} ps")
    for key in ("twist_deg", "strain", "wall_twist"):
        if found[key]["largest"] > 5 * found[key]["limit"] and not any(key in line for line in notes):
            raise Differs(f"{key}: check foresees nothing, the run has {found[key]['largest']:.3g}")


@transformation
def energy_of_the_last_state(case):
    """Energies by the log of a run and by `ropewalk energy` of its last state."""
    state, last = evaluated(case), {n: v[-1] for n, v in case.double.log.items()}
    said = case.check(case.in_double())
    length = said.split("free length ")
    options = ["--free-length-nm", length[1].split(" nm")[0].split()[-1]] if len(length) > 1 else []
    if nodes := re.search(r"contact law line, (\d+) nodes", said):
        options += ["--nodes-per-element", nodes[1]]
    found = case.energy(state, case.scene, *options)["energy_eV"]
    scale = sum(abs(x) for x in found.values())
    for part in ("stretch", "shear", "bend", "twist", "vdw"):
        near(f"{part}_eV", last[f"{part}_eV"], found[part], 1e-5 if len(length) > 1 else 1e-7, 1e-8 * scale + 1e-9)
    if not math.isnan(last.get("ends_eV", math.nan)):
        near("ends_eV", last["ends_eV"], found["ends"], 1e-7, 1e-8 * scale + 1e-9)


@transformation
def frames_observed(case):
    """Columns of the log, and the same ones measured in the stored frames."""
    done = case.bench.call("observe", case.base.path.name, "--json")
    if done.returncode != 0:
        raise Differs(f"observe ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    log = case.base.log
    row_at = {step: k for k, step in enumerate(log["step"])}
    compared = 0
    for frame in json.loads(done.stdout.replace("null", "NaN").replace("nan", "NaN")):
        k = row_at.get(frame["step"])
        if k is None:
            continue
        compared += 1
        for name, value in frame.items():
            if name not in log or name in ("Q", "Q_delaunay", "contacts", "voids", "void_area_nm2") or (
                    case.scene.source == "film" and name in OF_A_ROPE):
                continue
            x = log[name][k]
            if not (math.isnan(x) and math.isnan(value)):
                floor = 2e-3 * max((abs(v) for v in log[name] if math.isfinite(v)), default=0)
                near(f"{name} at {frame['time_ps']:.4g} ps", x, value, 2e-3, floor + rounding_of_frames(name))
    skip_if(not compared, "no frame is at the time of a row")


def rounding_of_frames(name):
    """Frames are in single precision: 1e-6 nm of 20 nm."""
    return {"nN": 0.5, "GPa": 0.02, "deg": 2e-2, "nm": 2e-4}.get(name.rsplit("_", 1)[-1], 2e-3)


@transformation
def frames_converted(case):
    """Frames as they are written, and by `convert` through a dump of LAMMPS and back."""
    text = case.folder / f"{case.kind}.lammpstrj"
    done = case.bench.call("convert", case.base.path.name, text.name, "--force")
    if done.returncode != 0:
        raise Differs(f"convert ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    lines = text.read_text().splitlines()
    begin = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS"))
    names = lines[begin].split()[2:]
    rows = [dict(zip(names, map(float, line.split()))) for line in lines[begin + 1:]]
    state, log = case.base.state(), case.base.log
    step = int(lines[max(k for k, line in enumerate(lines) if line.startswith("ITEM: TIMESTEP")) + 1])
    skip_if(step != log["step"][-1] and not case.scene.relaxes(), "the last frame is before the end")
    rows.sort(key=lambda row: row["id"])
    for k, (row, own) in enumerate(zip(rows, state.rows)):
        for axis, value in zip("xyz", own[1]):
            near(f"{axis} of element {k}", value, row[axis], 1e-5, 1e-4)
    k = log["step"].index(step)
    near("energy of bonds", 2 * sum(r["c_bond_energy_eV"] for r in rows) / 2,
         sum(log[n][k] for n in ("stretch_eV", "shear_eV", "bend_eV", "twist_eV")), 1e-3, 1e-3)
    near("van der Waals energy", sum(r["c_vdw_energy_eV"] for r in rows), log["vdw_eV"][k], 1e-3, 1e-3)


@transformation
def quantities_said_twice(case):
    """Quantities that the log has twice: sums and shares, stress and tension, work and its parts."""
    log = case.double.log
    scale = max(abs(x) for n in log if n.endswith("_eV") for x in log[n])
    parts = ("stretch_eV", "shear_eV", "bend_eV", "twist_eV", "vdw_eV", "tether_eV", "friction_eV", "links_eV",
             "ends_eV")
    mass = mass_of(case, case.double)
    slice_here, masses = "periodic" in case.scene, u_per_nm(case, case.double)
    n = case.scene.tube_count()
    thickness = sum(masses[t] for t in case.scene.get("tube_types", [0] * n)) if len(masses) > 1 else n * masses[0]
    for k, time in enumerate(log["time_ps"]):
        def of(name):
            return 0.0 if name not in log or math.isnan(log[name][k]) else log[name][k]

        at = f" at {time:.4g} ps"
        shares = sum(of(f"stored_{p}_MJ_per_kg") for p in ("stretch", "bend", "twist", "contact"))
        if not case.scene.has_memory() and not case.scene.has_strands():
            near("shares of stored_MJ_per_kg" + at, of("stored_MJ_per_kg"), shares, 1e-6, 1e-9)
        if not slice_here:
            now, first = sum(of(p) for p in parts), sum(0.0 if p not in log or math.isnan(log[p][0]) else log[p][0]
                                                        for p in parts)
            near("stored_MJ_per_kg" + at, of("stored_MJ_per_kg"), (now - first) / mass, 1e-5, 1e-6 * scale / mass)
        if of("tension_upper_nN") or of("tension_lower_nN"):
            tension = 0.5 * (of("tension_upper_nN") + of("tension_lower_nN"))
            near("specific stress" + at, of("specific_stress_N_per_tex"), 602.2 * tension / thickness, 1e-3, 1e-6)
    if all(f"work_{end}_eV" in log for end in ("upper", "lower")) and "grip" in case.scene and "load" not in case.scene:
        grips = case.scene["grip"]
        if all("tubes" not in g for g in grips):
            near("work at both ends", log["work_eV"][-1], log["work_upper_eV"][-1] + log["work_lower_eV"][-1], 1e-6,
                 1e-6 * scale)


U_IN_EV = 0.010364270  # eV ps^2/nm^2
CARBON = 12.011        # u


def u_per_nm(case, run):
    """Of each type of tube, from the atoms of its set."""
    files = sorted(run.path.glob("parameters-*.toml"))
    return [CARBON * tomllib.loads(file.read_text())["tube"]["atoms_per_length"]["value"]
            for file in [run / "parameters.toml", *files]]


def mass_of(case, run):
    """eV ps^2/nm^2, of all elements."""
    state, masses = run.state(), u_per_nm(case, run)
    types = case.scene.get("tube_types", [0] * len(state.rows))
    return U_IN_EV * sum(element_length(case) * masses[types[row[0]] if len(masses) > 1 else 0] for row in state.rows)


@transformation
def python_runs(case):
    """Whether the program runs a scene or Python does."""
    skip_if(not case.bench.has_python(), "the Python package is not built")
    (case.folder / "by-python.toml").write_text(case.scene.text())
    script = ("import ropewalk, sys\nropewalk.set_threads(1)\n"
              "ropewalk.run(ropewalk.Scene('by-python.toml'), 'by-python', force=True)\n")
    said = case.bench.python(script)
    if not (case.folder / "by-python" / "final.csv").exists():
        raise Differs(f"Python: {said.strip()[-300:]}")
    same_files(case.base, case.folder / "by-python", (*EXACT_FILES, "limits.json"))


@transformation
def python_steps(case):
    """Whether a run is made by the program, or step by step in Python, and what Python reads of its files."""
    skip_if(not case.bench.has_python(), "the Python package is not built")
    skip_if(case.scene.relaxes(), "it has no steps")
    skip_if(len(set(case.double.log["time_step_fs"])) > 1, "its steps are divided, which Python leaves to its user")
    (case.folder / "by-python.toml").write_text(case.in_double().text())
    case.double
    script = f"""
import json, math, ropewalk
ropewalk.set_threads(1)
s = ropewalk.Simulation(ropewalk.Scene('by-python.toml'))
run = ropewalk.open({case.double.path.name!r})
steps = int(run.log['step'][-1])
s.step(steps)
means = ('torque_', 'tension_', 'stress', 'specific', 'work_', 'step', 'time_step')
names = [n for n in run.log if not n.startswith(means)]
def measured(n):
    try:
        return float(s.measure(n))
    except Exception as e:
        return str(e)
print(json.dumps(dict(divided=s.divided, log={{n: float(run.log[n][-1]) for n in names}},
                      own={{n: measured(n) for n in names}},
                      position=abs(s.state.flat.position).sum(),
                      energy={{k: getattr(s.energies, k) for k in ('stretch', 'bend', 'twist')}})))
"""
    said = case.bench.python(script)
    if not said.startswith("{"):
        raise Differs(f"Python: {said.strip()[-300:]}")
    found = json.loads(said)
    skip_if(found["divided"], "steps are divided, which a run does")
    log = case.double.log
    for name, value in found["log"].items():
        x = log[name][-1]
        if not (math.isnan(x) and math.isnan(value)) and x != value:
            raise Differs(f"{name} in the file {x!r}, in Python {value!r}")
        own = found["own"][name]
        if isinstance(own, str):
            raise Differs(f"{name}: {own}")
        scale = max((abs(v) for v in log[name] if math.isfinite(v)), default=0)
        if not (math.isnan(own) and math.isnan(x)) and not abs(own - x) <= 1e-6 * scale + 1e-8:
            raise Differs(f"{name}: the run {x!r}, step by step {own!r}")


@transformation
def mdanalysis(case):
    """Masses, lengths and times of the frames for MDAnalysis, and those of the run."""
    skip_if(not case.bench.has_python("MDAnalysis"), "MDAnalysis is not installed")
    script = f"""
import json, ropewalk
run = ropewalk.open({case.base.path.name!r})
u = run.to_mdanalysis()
times = [float(ts.time) for ts in u.trajectory]
print(json.dumps(dict(mass=float(u.atoms.masses.sum()), times=times, own=[float(f.time_ps) for f in run.frames])))
"""
    said = case.bench.python(script)
    if not said.startswith("{"):
        raise Differs(f"Python: {said.strip()[-300:]}")
    found = json.loads(said)
    near("mass", found["mass"], mass_of(case, case.base) / U_IN_EV, 1e-3)
    for x, y in zip(found["times"], found["own"]):
        near("time", x, y, 1e-4, 1e-4)


@transformation
def by_lammps(case):
    """Whether the simulator moves the scene or LAMMPS does."""
    lmp = case.bench.lammps()
    skip_if(not lmp, "lmp-ropewalk is not built")
    scene = case.in_double()
    (case.folder / "there.toml").write_text(scene.text())
    shutil.rmtree(case.folder / "there", ignore_errors=True)
    done = case.bench.call("export", "there.toml", "--lammps", "there")
    skip_if(done.returncode == 2, "refused: " + done.stderr.strip().split(": ", 2)[-1][:120])
    skip_if(len(set(case.double.log["time_step_fs"])) > 1, "its steps are divided, which LAMMPS does not do")
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMP_NUM_THREADS": "1"}
    ran = subprocess.run([str(lmp), "-in", "in.rope"], cwd=case.folder / "there", capture_output=True, text=True,
                         env=environment)
    if ran.returncode != 0:
        raise Differs(f"LAMMPS ended with {ran.returncode}: {(ran.stdout + ran.stderr)[-300:]}")
    back = case.bench.call("import", "there")
    if back.returncode == 4:  # LAMMPS looks at forces alone
        back = case.bench.call("resume", "there", "--quiet", "--threads", 1)
    if back.returncode not in (0, 7):
        raise Differs(f"import ended with {back.returncode}: {back.stderr.strip()[-300:]}")
    mine, theirs = case.double.log, read_log(case.folder / "there" / "log.csv")
    if scene.relaxes():
        same_columns(mine, theirs, 2e-4, 1e-6, only=("stretch_eV", "bend_eV", "twist_eV", "vdw_eV"), last=True)
        return
    near("steps", mine["step"][-1], theirs["step"][-1], 0)
    leave = ("time_step_fs", "torque_upper_nN_nm", "torque_lower_nN_nm", "tension_upper_nN", "tension_lower_nN",
             "work_upper_eV", "work_lower_eV", "stress_GPa", "specific_stress_N_per_tex", *ONE_CLAMP_ONLY)
    within = 1e-6
    same_columns(mine, theirs, within, 0.1 * within, last=True, leave=(*leave, "friction_slips", "slip_nm"))


@transformation
def point_of_a_sweep(case):
    """Whether a scene is run by itself or as the point of a sweep, and what `gather` says of it."""
    scene = case.scene
    (case.folder / "swept.toml").write_text(scene.text())
    if scene.relaxes():
        vary = "run.max_steps = [200000, 200001]"
        scene = scene.with_keys(run={"max_steps": 200000})
    else:
        vary = f"run.duration_ps = [{scene['run']['duration_ps']}, 1]"
    (case.folder / "sweep.toml").write_text(
        f'format = "ropewalk-sweep-1"\nscene = "swept.toml"\n[vary]\n{vary}\n')
    shutil.rmtree(case.folder / "swept", ignore_errors=True)
    done = case.bench.call("sweep", "sweep.toml", "--out", "swept", "--quiet", "-j", 1, "--only", 1)
    if done.returncode != 0:
        raise Differs(f"sweep ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    point = next((case.folder / "swept" / "points").iterdir())
    base = case.base if not case.scene.relaxes() else case.run(scene)
    if scene.is_warm() or "links" in scene or scene.has_strands():
        # Each point has random numbers of its own; the tubes at the start are the same.
        first, second = base.log, read_log(point / "log.csv")
        near("vdw_eV at the start", first["vdw_eV"][0], second["vdw_eV"][0], 1e-9)
    else:
        same_files(base, point, ("final.csv", "log.csv", "limits.json"))
    table = case.bench.call("gather", "swept")
    if table.returncode != 0:
        raise Differs(f"gather ended with {table.returncode}: {table.stderr.strip()[-200:]}")


@transformation
def solver_of_a_relaxation(case):
    """The way to a state of rest: down the forces, or by Newton's method at the end."""
    scene = case.in_double()
    if not scene.relaxes():
        skip_if("periodic" in scene, "a slice moves in time")
        skip_if(any(name in scene for name in ("links", "failure", "friction")),
                "what remembers has many states of rest")
        skip_if(scene.source in ("film", "state") or scene.has_strands(), "loose tubes come to rest in many ways")
        skip_if(scene.source == "plies", "ropes side by side come to rest in many grooves")
        scene = undriven(scene)
        scene["run"] = {"mode": "relax"}
        scene["start"] = {"twist_deg_per_nm": 0.5} if scene.source == "rope" else {}
        scene.pop("thermostat", None)
    skip_if("twist" in scene, "FIRE comes to no rest under a moment")
    skip_if("perturbation_nm" in scene.get("rope", {}), "a perturbed rope has many states of rest near one another")
    # To a state whose energy is known far better than the one that is compared.
    scene = scene.with_keys(run={"energy_tolerance": 1e-4, "solver": None, "max_steps": 6000})
    outs = [case.start(scene.with_keys(run={"solver": solver})) for solver in ("fire", "auto")]
    for out in outs:
        if out.code not in (0, 4):
            raise Differs(f"ended with {out.code}: {out.said.strip()[-200:]}")
    skip_if(any(out.code == 4 for out in outs), "it does not come to rest within the steps")
    same_columns(outs[0].log, outs[1].log, 5e-3, 1e-5, only=("stretch_eV", "bend_eV", "twist_eV", "vdw_eV"), last=True,
                 floor=1e-4)


# Numbers of a scene that may have a standard error.
PROPERTIES = {"damping": ("contact_viscosity_eV_ps_per_nm3", "bond_damping_per_ps"),
              "friction": ("strength_pN_per_nm", "spin_strength_pN_per_nm", "end_strength_pN", "drag_eV_ps_per_nm3"),
              "links": ("stiffness_nN_per_nm", "breaks_at_nN"), "failure": ("strain",),
              "tether": ("stiffness_nN_per_nm",)}


@transformation
def error_by_errors_or_by_hand(case):
    """How a result follows a number that has an error: by `errors`, or by two runs with other numbers."""
    scene = case.scene.with_keys(parameters=exact_sets(case))
    if all("from" in table for table in scene.list("friction")):
        scene["friction"] = [{"strength_pN_per_nm": 4}]
    skip_if(scene.relaxes() and "tether" not in scene, "what takes energy has no part in a relaxation")
    skip_if(scene.get("contact", {}).get("law") == "none", "nothing rubs without contacts")
    if scene.relaxes():
        scene.pop("friction")
    numbers = [(name, k, key) for name, keys in PROPERTIES.items() for key in keys
               for k, table in enumerate(tables_of(scene, name)) if table.get(key, 0) > 0]
    name, k, key = case.random.choice(numbers)
    value = tables_of(scene, name)[k][key]

    def with_value(v):
        out = scene.copy()
        tables_of(out, name)[k][key] = v
        return out

    one = case.run(with_value({"value": value, "standard_error": 0.1 * value}))
    said = case.bench.call("errors", one.path.name, "--json", "--quiet", "-j", 1)
    if said.returncode != 0:
        raise Differs(f"errors of {name}.{key} ended with {said.returncode}: {said.stderr.strip()[-200:]}")
    # The runs of `errors` take the step of the first one.
    run = {} if scene.relaxes() else {"time_step_fs": one.manifest["time_step_fs"]}
    up, down = (case.run(with_value(v).with_keys(run=run)).log for v in (1.1 * value, 0.9 * value))
    log = one.log
    for column, entry in json.loads(said.stdout)["at_the_end"].items():
        if scene.source == "film" and column in OF_A_ROPE:
            continue
        here, plus, minus = (x[column][-1] if column in x else math.nan for x in (log, up, down))
        by_hand, bent = 0.5 * abs(plus - minus), 0.5 * abs(plus + minus - 2 * here)
        if bent > by_hand:  # not linear
            by_hand = math.hypot(by_hand, bent)
        # Unlike tubes have an error of their own besides.
        part = next((v for of, v in entry["parts"].items() if of.endswith("." + key)), None)
        if part is not None and math.isfinite(by_hand):
            near(f"error of {column} by {name}.{key}", abs(part), by_hand, 1e-4, 1e-8 * (1 + abs(here)))


def tables_of(scene, name):
    found = scene.get(name, [])
    return [found] if isinstance(found, dict) else found


def exact_sets(case):
    """The sets of the scene as files whose numbers have no errors."""
    found = []
    for name in case.scene.sets():
        text = (case.bench.data("parameters") / f"{name}.toml").read_text()
        text = re.sub(r'standard_error = ("[^"]*"|[^,} ]+)', "standard_error = 0", text)
        text = re.sub(r"(?m)^(registry +=.*?value = )[^,]+", r"\g<1>0", text)
        (case.folder / f"exact-{name}.toml").write_text(text)
        found.append(f"exact-{name}.toml")
    return found if isinstance(case.scene["parameters"], list) else found[0]


@transformation
def rest_at_any_viscosity(case):
    """Where `rest` says that a rope comes to rest, whatever its viscosity, within the errors that it says."""
    scene = case.scene
    skip_if("twist" not in scene or scene.source != "rope", "it is no rope under a moment")
    skip_if(scene.relaxes() or scene.has_strands() or scene.has_memory() or scene["twist"].get("geometric_only"),
            "what remembers has many states of rest, and a relaxation no time")
    rope = {"tubes": 7, "length_nm": 24}
    (case.folder / "rests.toml").write_text(scene.with_keys(
        rope=None, start=None, damping=None, limits=None, run=None, thermostat=None).with_keys(
        rope=rope, twist={"moment_nN_nm": 15, "rate_nN_nm_per_ps": 2, "hold_ps": 300}).text())
    found = []
    for viscosity in (2.7, 40):
        done = case.bench.call("rest", "rests.toml", "--out", "rests", "--viscosity", viscosity, "--json", "--quiet",
                               "--force", "-j", 1)
        skip_if(done.returncode not in (0, 4), "refused: " + done.stderr.strip()[-120:])
        said = json.loads(done.stdout)
        if said["verdict"] in ("rests", "creeps"):
            found.append(said["estimate"]["geometric_twist"])
    skip_if(len(found) < 2, "it is not said to rest, nor to creep to a rest")
    one, other = found
    near("twist at rest", one["value_deg"], other["value_deg"], 0, 2 * math.hypot(one["error_deg"], other["error_deg"]))
