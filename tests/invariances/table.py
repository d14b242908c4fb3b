"""The transformations: what may be said or computed in another way and must give the same number.

A transformation is a function of a Case (bench.py). Its docstring is one sentence: what must not matter. It runs the
scene in both ways and compares; it raises Skip where it has nothing to say about the scene.
"""
import json
import math
import os
import shutil
import subprocess
import tomllib

from bench import (AXES, EXACT_FILES, Differs, Scene, State, by_time, each_value, near, negative, read_log, same_columns,
                   same_files, skip_if, times, turned)

TRANSFORMATIONS = {}


def transformation(function):
    TRANSFORMATIONS[function.__name__.replace("_", " ")] = function
    return function


def compare_rounding(case, first, second, within=1e-7, **how):
    """Two runs that may differ by the rounding of numbers."""
    if case.scene.relaxes():
        energies = ("stretch_eV", "shear_eV", "bend_eV", "twist_eV", "vdw_eV")
        same_columns(first.log, second.log, 2e-4, 1e-6, only=energies, last=True)
    else:
        same_columns(first.log, second.log, within, rounding=3e-8, **how)


# --- scenes with another drive, for what the scene itself has not ---


def undriven(scene):
    return scene.with_keys(grip=None, load=None, tether=None, twist=None, periodic=None)


def with_twist(case):
    """The scene in double precision, under a moment where it has none."""
    scene = case.in_double()
    if "twist" not in scene:
        skip_if("periodic" in scene or scene.relaxes(), "it has no ends that a moment could turn")
        skip_if(scene.source == "film", "tubes of a film lie across the axis")
        scene = undriven(scene).with_keys(twist={"moment_nN_nm": 4, "rate_nN_nm_per_ps": 2, "hold_ps": 3})
    return scene


def in_a_bath(case):
    """The scene in a bath, without other drives and without losses."""
    scene = case.scene
    if "thermostat" not in scene:
        skip_if(scene.relaxes(), "a relaxation has no heat")
        scene = scene.with_keys(thermostat={"temperature_K": 300, "coupling_per_ps": 1},
                                start={"temperature_K": 300, "may_cool": None} if scene.source != "state" else {})
    periodic = {"twist_deg_per_nm": [[0, 0]]} if "periodic" in scene else None
    return undriven(scene).with_keys(
        periodic=periodic, friction=None, links=None, failure=None,
        damping={"contact_viscosity_eV_ps_per_nm3": 0, "contact_viscosity_eV_ps_per_nm2": None, "bond_damping_per_ps": 0})


def as_slice(case):
    """The interior of the rope of the scene, cold, without what is random."""
    scene = case.in_double()
    skip_if(scene.source != "rope", "a slice is made of a [rope]")
    skip_if(scene.has_strands(), "its tubes are cut at random")
    skip_if("links" in scene or "strain_deviation" in scene.get("failure", {}), "links and strengths are drawn by elements")
    skip_if(any(s.endswith("-paper") for s in scene.sets()), "the published contact turns with the places of elements")
    skip_if(scene.relaxes(), "a relaxation has no time")
    return undriven(scene).with_keys(
        rope={"perturbation_nm": None}, thermostat=None,
        start={k: None for k in ("temperature_K", "may_cool", "wave_nm", "half_waves", "twist_deg_per_nm")},
        periodic={"twist_deg_per_nm": [[0, 0], [3, 0.3], [20, 0.3]], "tension_nN": [[0, 0], [2, 60]]},
        damping={"contact_viscosity_eV_ps_per_nm3": 27, "bond_damping_per_ps": 1}, run={"duration_ps": 4})


# --- the file of the scene -------------------------------------------------------------------------------------------


@transformation
def order_of_tables_and_keys(case):
    """The order of tables and keys in the file of a scene."""
    scene = case.scene
    again = Scene()
    for name in reversed(list(scene)):
        table = scene[name]
        again[name] = dict(reversed(table.items())) if isinstance(table, dict) else (
            [dict(reversed(t.items())) for t in table]
            if isinstance(table, list) and isinstance(table[0], dict) else table)
    same_files(case.base, case.run(again))


@transformation
def parameters_by_path(case):
    """Whether a parameter set is named or given as a file."""
    scene = case.scene
    found = [f"{name}.toml" for name in scene.sets()]
    for name in found:
        # The set as a run keeps it, with the tables that stand beside the shipped one.
        shipped = case.bench.data("parameters")
        for file in shipped.glob(name[:-5] + "*"):
            shutil.copy(file, case.folder / file.name)
    scene["parameters"] = found if isinstance(scene["parameters"], list) else found[0]
    same_files(case.base, case.run(scene))


@transformation
def defaults_typed(case):
    """Whether a key that has a default is typed with it."""
    scene = case.scene
    others = ("solver", "force_tolerance_nN", "energy_tolerance", "max_steps")
    if scene.relaxes():
        others = ("duration_ps", "frames_every_ps", "log_every_ps", "mass_scale", "integrator")
    for table, keys in case.bench.defaults().items():
        mine = scene.get(table) if table else scene
        for entry in mine if isinstance(mine, list) else [mine] if mine is not None else []:
            for key, value in keys.items():
                if table == "friction" and "from" in entry or table == "load":
                    continue  # a key of another kind of load, or of typed friction
                if key not in others and (table, key) not in EXCLUSIVE_DEFAULTS:
                    entry.setdefault(key, value)
    same_files(case.base, case.run(scene))


# Typed, these keys say something that their default does not.
EXCLUSIVE_DEFAULTS = {("rope", "packing"), ("rope", "stagger"), ("tether", "to_tube"), ("load", "axes")}


@transformation
def one_set_as_two_types(case):
    """Whether all tubes are of one type, or of two types with the same set."""
    skip_if(len(case.scene.sets()) > 1, "it has two types already")
    skip_if(case.scene.tube_count() < 2, "it has one tube")
    skip_if(case.scene.has_strands(), "types are those of strands")

    def of_two_types(scene, state):
        scene["parameters"] = 2 * scene.sets()
        scene["tube_types"] = [k % 2 for k in range(case.scene.tube_count())]
        return scene, state

    compare_moved(case, case.run(case.moving(of_two_types)))


@transformation
def schedule_in_two_pieces(case):
    """Whether a line of a schedule is one piece or two."""
    def split(points):
        if not (isinstance(points, list) and len(points) > 1 and isinstance(points[0], list)):
            return points
        out = [points[0]]
        for (t, v), (u, w) in zip(points, points[1:]):
            part = case.random.choice([0.25, 0.5])
            out += [[t + part * (u - t), v + part * (w - v)], [u, w]]
        return out

    one, two, found = case.in_double(), case.in_double(), False
    for a, b in zip(one.list("grip"), two.list("grip")):
        for axis in AXES:
            if not isinstance(a.get(axis), dict):
                continue
            for key, value in a[axis].items():
                found = found or split(value) != value
                b[axis][key] = split(value)
        a["smooth_ps"] = b["smooth_ps"] = 0
    if "tension_nN" in two.get("periodic", {}):
        one["periodic"]["tension_nN"] = [[0, 0], [2, 30]]
        two["periodic"]["tension_nN"] = split([[0, 0], [2, 30]])
        found = True
    if "thermostat" in one:
        one["thermostat"]["temperature_K"] = [[0, 300], [4, 200]]
        two["thermostat"]["temperature_K"] = split([[0, 300], [4, 200]])
        found = True
    skip_if(not found, "it has no schedule of points whose corners are sharp")
    same_columns(case.run(one).log, case.run(two).log, 1e-7)


@transformation
def schedule_by_rate(case):
    """Whether a component of a grip is given by points or by values and a rate."""
    rates = {"rotation_deg": "rate_deg_per_ps", "rotation_turns": "rate_turns_per_ps",
             "displacement_nm": "rate_nm_per_ps", "force_nN": "rate_nN_per_ps", "strain": "rate_per_ps",
             "torque_nN_nm": "rate_nN_nm_per_ps"}
    one, two, found = case.in_double(), case.in_double(), False
    for a, b in zip(one.list("grip"), two.list("grip")):
        for axis in AXES:
            spec = a.get(axis)
            if not isinstance(spec, dict):
                continue
            kind = next(k for k in spec if k in rates)
            if rates[kind] in spec and not isinstance(spec[kind], list):
                end = spec[kind]
                b[axis] = {kind: [[0, 0], [abs(end) / spec[rates[kind]], end]]}
                found = True
            elif rates[kind] not in spec and len(spec[kind]) > 1 and spec[kind][0] == [0, 0] and spec[kind][1][1] != 0:
                time, value = spec[kind][1]
                a[axis] = {kind: [[0, 0], [time, value]]}
                b[axis] = {kind: value, rates[kind]: abs(value) / time}
                found = True
    skip_if(not found, "no grip follows a line that begins at zero")
    same_columns(case.run(one).log, case.run(two).log, 1e-7)


@transformation
def both_ends_as_two_grips(case):
    """Whether both ends are said in one grip or in two."""
    grips = case.scene.list("grip")
    skip_if(len(grips) != 2 or {g["end"] for g in grips} != {"lower", "upper"}, "it has not one grip at each end")
    skip_if(any("tubes" in g for g in grips), "its grips hold other tubes")
    upper = next(g for g in grips if g["end"] == "upper")
    lower = {k: negative(v) if k in AXES and not (k == "z" and isinstance(v, dict) and "strain" in v) else v
             for k, v in upper.items()}
    if isinstance(upper.get("z"), dict) and "strain" in upper["z"]:
        both = {**upper, "end": "both"}
        half = {k: v / 2 if k.startswith("rate_") else v for k, v in each_value(upper["z"], lambda v: v / 2).items()}
        parts = [{**upper, "z": half}, {**lower, "end": "lower", "z": negative(half)}]
    else:
        both, parts = {**upper, "end": "both"}, [upper, {**lower, "end": "lower"}]
    one = case.run(case.in_double().with_keys(grip=[both]))
    two = case.run(case.in_double().with_keys(grip=parts))
    same_columns(one.log, two.log, 1e-7)


@transformation
def ends_by_grip_load_or_twist(case):
    """Whether what acts at the ends is said by [twist], by grips for each tube or by loads."""
    scene = case.in_double()
    free = {axis: "free" for axis in AXES}
    if not any(name in scene for name in ("twist", "grip", "load", "periodic")):
        scene = with_twist(case)
    if "twist" in scene:
        twist = scene["twist"]
        skip_if(twist.get("geometric_only"), "spins are relaxed, which grips do not do")
        moment, rate = twist["moment_nN_nm"], twist["rate_nN_nm_per_ps"]
        points, at = [[0, 0], [moment / rate, moment]], moment / rate
        if twist.get("unload_rate_nN_nm_per_ps"):
            at += twist.get("hold_ps", 0)
            points += [[at, moment], [at + moment / twist["unload_rate_nN_nm_per_ps"], 0]]
        grips = [{"end": end, "as": "each", **free, "smooth_ps": 0,
                  "about_z": {"torque_nN_nm": [[t, sign * m] for t, m in points]}}
                 for end, sign in (("lower", -1), ("upper", 1))]
        other = scene.with_keys(twist=None, grip=grips)
        forecasts = [sorted(line for line in case.check(s).splitlines() if "may bring" in line or "theory" in line)
                     for s in (scene, other)]
        if forecasts[0] != forecasts[1]:
            raise Differs(f"check: {forecasts[0]} / {forecasts[1]}")
        compare_rounding(case, case.run(scene), case.run(other))
        return
    loads = scene.list("load")
    if any(load["kind"] == "force" for load in loads) and scene.source == "chain":
        held = [{"end": "lower", "as": "each"}] if any(load["kind"] == "fix" for load in loads) else []
        force = next(load["force_nN"] for load in loads if load["kind"] == "force")
        pulls = {axis: {"force_nN": value} if value else "free" for axis, value in zip("xyz", force)}
        other = scene.with_keys(load=None, grip=[*held, {"end": "upper", **free, **pulls}])
        same_columns(case.double.log, case.run(other).log, 1e-5, last=True,
                     only=("stretch_eV", "shear_eV", "bend_eV", "twist_eV", "most_curvature_per_nm"))
        return
    still = [g for g in scene.list("grip") if not any(isinstance(g.get(axis), dict) or g.get(axis) == "free"
                                                      for axis in AXES)]
    skip_if(not still, "its ends are driven in ways that only a grip has")
    rest = [g for g in scene["grip"] if g not in still]
    fixes = [{"kind": "fix", "elements": [0 if g["end"] == "lower" else -1],
              **({"tubes": g["tubes"]} if "tubes" in g else {})} for g in still]
    other = scene.with_keys(grip=rest or None, load=[*loads, *fixes])
    skip_if(scene.has_strands(), "a load counts elements of tubes, a grip those of strands")
    # A run without two clamps has no torque and tension of the ends to say.
    energies = [n for n in case.double.log if n.endswith("_eV") and not n.startswith("work_")]
    second = case.run(other)
    same_columns(case.double.log, second.log, 1e-7, only=energies)
    limits = [{entry["key"]: entry["limit"] for entry in json.loads((run / "limits.json").read_text())["limits"]}
              for run in (case.double, second)]
    if limits[0] != limits[1]:
        raise Differs(f"limits: {limits[0]} / {limits[1]}")


@transformation
def moment_of_each_or_in_total(case):
    """Whether the moment of [twist] is that of each tube or of all."""
    scene = with_twist(case)
    first = case.run(scene)
    n = len(first.state().tubes()) if not scene.has_strands() else scene.tube_count()
    skip_if("failure" in scene, "where it breaks it has more tubes")
    twist = {k: n * v if k in ("moment_nN_nm", "rate_nN_nm_per_ps", "unload_rate_nN_nm_per_ps") else v
             for k, v in scene["twist"].items()}
    other = case.run(scene.with_keys(twist={**twist, "reading": "total"}))
    same_columns(first.log, other.log, 1e-7, leave=("moment_nN_nm",))


@transformation
def tables_split_by_tubes(case):
    """Whether a load or a grip of single tubes is one table for all tubes or one for each half of them."""
    scene = case.in_double()
    n = scene.tube_count()
    skip_if(n < 2, "it has one tube")
    skip_if("periodic" in scene, "a slice has no ends")
    halves = [list(range(n // 2)), list(range(n // 2, n))]
    if scene.list("load"):
        loads = [{**load, "tubes": half} for load in scene["load"] for half in halves]
        one, two = scene, scene.with_keys(load=loads)
    else:
        skip_if(scene.has_strands(), "its tubes are cut at random")
        skip_if("twist" in scene, "[twist] stands once")
        each = [{"end": "lower", "as": "each"},
                {"end": "upper", "as": "each", "z": {"force_nN": [[0, 0], [3, 2]]}, "x": "free", "y": "free"}]
        one = scene.with_keys(grip=each, run={"duration_ps": 4} if not scene.relaxes() else {})
        two = one.with_keys(grip=[{**grip, "tubes": half} for grip in each for half in halves])
    a, b = case.run(one), case.run(two)
    same_columns(a.log, b.log, 1e-7, leave=ONE_CLAMP_ONLY)


ONE_CLAMP_ONLY = ("torque_upper_nN_nm", "torque_lower_nN_nm", "torque_upper_x_nN_nm", "torque_upper_y_nN_nm",
                  "torque_lower_x_nN_nm", "torque_lower_y_nN_nm")


@transformation
def one_table_twice(case):
    """A table of links or friction that is written twice is refused, and does not act twice."""
    scene = case.scene
    skip_if(scene.get("contact", {}).get("law") == "none", "it has no contacts")
    for name, table in (("friction", {"strength_pN_per_nm": 3}), ("links", {"per_nm": 0.1, "stiffness_nN_per_nm": 50})):
        once = scene.list(name)[:1] or [table]
        out = case.start(scene.with_keys(**{name: 2 * once}))
        if out.code != 2:
            raise Differs(f"two equal [[{name}]] ended with {out.code}")


@transformation
def tables_by_types(case):
    """Whether links and friction of all pairs stand in one table, or each pair of types has its own."""
    scene = case.in_double()
    skip_if(scene.get("contact", {}).get("law") == "none", "it has no contacts")
    skip_if(scene.has_strands(), "types are those of strands, drawn together with the cuts")
    skip_if(scene.tube_count() < 2, "it has one tube")
    skip_if(any(s.endswith("-paper") for s in scene.sets()), "the published contact is that of one set")
    skip_if("thermostat" in scene, "friction in a bath is another question")
    if len(scene.sets()) == 1:
        scene["parameters"] = 2 * scene.sets()
        scene["tube_types"] = [k % 2 for k in range(scene.tube_count())]
    table = {k: v for k, v in scene.list("friction")[0].items() if k != "types"} if "friction" in scene else {
        "strength_pN_per_nm": 4, "spin_strength_pN_per_nm": 2, "elastic_slip_nm": 0.03}
    one = scene.with_keys(links=None, friction=[table])
    two = one.with_keys(friction=[{**table, "types": pair} for pair in ([0, 0], [0, 1], [1, 1])])
    first, second = case.run(one), case.run(two)
    counts = ("friction_slips", "slip_nm")  # a contact slides or not, by the last bit
    compare_rounding(case, first, second, 1e-6, leave=counts)
    if scene.relaxes() or scene.source in ("film", "state"):
        return
    links = {"per_nm": 0.6, "stiffness_nN_per_nm": 50, "forming_per_nm_ps": 0.5, "most_per_nm": 0.6}
    several = scene.with_keys(links=[{**links, "types": [0, 1]}, links])
    single = scene.with_keys(links=[links])
    most, both = (case.run(s).log["links_formed"][-1] for s in (single, several))
    if both > 1.3 * most:
        raise Differs(f"{most:.0f} links in one table, {both:.0f} in two")


@transformation
def viscosity_per_length_or_per_element(case):
    """Whether the contact viscosity is typed per length of contact or for pairs of elements, as before."""
    scene = case.in_double()
    skip_if("thermostat" in scene or scene.relaxes(), "it has no damping")
    skip_if(scene.get("contact", {}).get("law") == "none", "it has no contacts")
    old = scene.with_keys(damping={"contact_viscosity_eV_ps_per_nm3": None, "contact_viscosity_eV_ps_per_nm2": 4})
    said = case.check(old)
    value = float(said.split("contact_viscosity_eV_ps_per_nm3 = ")[1].split()[0])
    new = scene.with_keys(damping={"contact_viscosity_eV_ps_per_nm3": value})
    names = ("stretch_eV", "bend_eV", "twist_eV", "vdw_eV", "dissipated_eV", "damping_eV", "kinetic_eV")
    same_columns(case.run(old).log, case.run(new).log, 1e-4, 1e-5, only=names)


@transformation
def order_of_types(case):
    """The order in which the types of tubes are listed."""
    skip_if(case.scene.tube_count() < 2, "it has one tube")
    skip_if(case.scene.has_strands(), "types are those of strands")
    skip_if(any(s.endswith("-paper") for s in case.scene.sets()), "the published contact is that of one tube")
    skip_if("failure" in case.scene, "its strength is that of the first type")
    skip_if("periodic" in case.scene, "a slice begins as a [rope], drawn together by types")
    n = case.scene.tube_count()
    types = [(k + case.random.randrange(2)) % 2 for k in range(n)]
    sets = ["cnt-10-10-tersoff", "cnt-8-8-tersoff"]
    # Both start from one file, made with the first order.
    first = case.in_double().with_keys(parameters=sets, tube_types=types, element_length_nm=1.2)
    if "tube_types" in case.scene:
        first["parameters"] = [*case.scene["parameters"]]
        first["tube_types"] = types = case.scene["tube_types"]
        sets = first["parameters"]
    first.get("rope", {}).pop("spacing_nm", None)
    skip_if(case.scene.source == "state", "it begins from a file of one type")
    made = case.run(first, "--steps", 10)
    state = made.state().without_memory()
    one = first.with_keys(**{first.source: None}, state={"file": "types-1.csv"},
                          start={k: None for k in ("temperature_K", "may_cool", "wave_nm", "half_waves")})
    if not one.relaxes():
        one = one.with_keys(run={"duration_ps": 3, "time_step_fs": float(f"{0.7 * made.manifest['time_step_fs']:.3g}")})
    two = one.with_keys(parameters=sets[::-1], tube_types=[1 - t for t in types], state={"file": "types-2.csv"})
    for table in ("friction", "links"):
        for entry in two.list(table):
            if "types" in entry:
                entry["types"] = [1 - t for t in entry["types"]]
    state.write(case.folder / "types-1.csv")
    state.notes = [f"# tube_types: {','.join(str(1 - t) for t in types)}" if x.startswith("# tube_types") else x
                   for x in state.notes]
    state.write(case.folder / "types-2.csv")
    compare_rounding(case, case.run(one), case.run(two))


def element_length(case):
    state = case.base.state()
    note = state.note("element_length_nm")
    return float(note.split(":")[1])


# --- the state -------------------------------------------------------------------------------------------------------


@transformation
def shift(case):
    """Where the scene lies: all of it shifted, beyond 128 nm also."""
    without_noise(case)
    away = [case.random.uniform(150, 2000) * case.random.choice([-1, 1]) for _ in range(3)]

    def shifted(scene, state):
        for tether in scene.list("tether"):
            if "to_point_nm" in tether:
                tether["to_point_nm"] = [p + a for p, a in zip(tether["to_point_nm"], away)]
        for load in scene.list("load"):
            if load["kind"] == "rotate":
                load["centre_nm"] = [p + a for p, a in zip(load.get("centre_nm", [0, 0]), away)]
        return scene, state.each(lambda r, q, v, w: (tuple(x + a for x, a in zip(r, away)), q, v, w))

    scene = case.moving(shifted)
    compare_moved(case, case.run(scene))


def compare_moved(case, moved, within=1e-7, **how):
    compare_rounding(case, case.moved, moved, within, **how)


def without_noise(case):
    skip_if("thermostat" in case.scene, "the noise of the bath has directions and elements of its own")


def turned_about_z(angle):
    half = 0.5 * angle
    turn = (math.cos(half), 0.0, 0.0, math.sin(half))

    def change(r, q, v, w):
        return turned(r, turn), times(turn, q), turned(v, turn), turned(w, turn)

    return turn, change


@transformation
def turn_about_the_axis(case):
    """The direction in which the scene lies about z, the axis of its drives."""
    without_noise(case)
    turn, change = turned_about_z(case.random.uniform(-3, 3))

    def turned_scene(scene, state):
        for tether in scene.list("tether"):
            if "to_point_nm" in tether:
                tether["to_point_nm"] = list(turned(tether["to_point_nm"], turn))
        for load in scene.list("load"):
            for key in ("force_nN", "torque_nN_nm"):
                if key in load:
                    load[key] = list(turned(load[key], turn))
            if load["kind"] == "rotate":
                load["centre_nm"] = list(turned([*load.get("centre_nm", [0, 0]), 0.0], turn)[:2])
        for grip in scene.list("grip"):
            skip_if(any(grip.get(axis, "held") != grip.get("y" if axis == "x" else "about_y", "held")
                        for axis in ("x", "about_x")), "a grip acts along x or y")
        return scene, state.each(change)

    directed = [n for n in case.base.log if n.startswith("torque_") and n[-8] in "xy" or "_x_" in n or "_y_" in n]
    compare_moved(case, case.run(case.moving(turned_scene)), leave=directed)


@transformation
def mirror(case):
    """Which hand the scene has: its mirror image, with twists the other way."""
    without_noise(case)

    def mirrored(scene, state):
        for tether in scene.list("tether"):
            if "to_point_nm" in tether:
                tether["to_point_nm"][0] *= -1
        for load in scene.list("load"):
            if "force_nN" in load:
                load["force_nN"][0] *= -1
            if "torque_nN_nm" in load:
                load["torque_nN_nm"] = [load["torque_nN_nm"][0], *(-m for m in load["torque_nN_nm"][1:])]
            if load["kind"] == "rotate":
                load["rate_deg_per_ps"] *= -1
                load["angle_deg"] = load["angle_deg"]
                load["centre_nm"] = [-load.get("centre_nm", [0, 0])[0], load.get("centre_nm", [0, 0])[1]]
        for grip in scene.list("grip"):
            for axis in ("x", "about_y", "about_z"):
                if axis in grip:
                    grip[axis] = negative(grip[axis])
        if "twist" in scene:
            scene["twist"]["hand"] = "left"
        return scene, state.each(lambda r, q, v, w: ((-r[0], r[1], r[2]), (q[0], q[1], -q[2], -q[3]),
                                                     (-v[0], v[1], v[2]), (w[0], -w[1], -w[2])))

    odd = ("moment_nN_nm", "torque_upper_nN_nm", "torque_lower_nN_nm", "torque_upper_y_nN_nm", "torque_lower_y_nN_nm",
           "rotation_deg", "physical_twist_deg", "geometric_twist_deg", "ply_angle_deg", "windings", "writhe")
    compare_moved(case, case.run(case.moving(mirrored)), sign=lambda name: -1 if name in odd else 1)


@transformation
def upside_down(case):
    """Which end is the lower one: the scene turned over, its tubes counted from the other end."""
    without_noise(case)
    skip_if(case.scene.has_strands(), "the strands of a state file are counted upwards")
    over = (0.0, 1.0, 0.0, 0.0)  # half a turn about x

    def end(elements):
        return [-1 - e for e in elements] if isinstance(elements, list) else elements

    def overturned(scene, state):
        skip_if(state.note("broken_behind_elements"), "tubes are broken at the start")
        for tether in scene.list("tether"):
            if "to_point_nm" in tether:
                tether["to_point_nm"] = list(turned(tether["to_point_nm"], over))
            for key in ("elements", "to_elements"):
                if key in tether:
                    tether[key] = end(tether[key])
        skip_if("failure" in scene, "the strength of a bond belongs to its number")
        skip_if(any(load.get("elements") == "opposite-ends" for load in scene.list("load")), "its loads are by ends")
        for load in scene.list("load"):
            for key in ("force_nN", "torque_nN_nm"):
                if key in load:
                    load[key] = list(turned(load[key], over))
            if load["kind"] == "rotate":
                load["rate_deg_per_ps"] *= -1
                load["centre_nm"] = [load.get("centre_nm", [0, 0])[0], -load.get("centre_nm", [0, 0])[1]]
            if "elements" in load:
                load["elements"] = end(load["elements"])
        for grip in scene.list("grip"):
            if grip["end"] == "both":
                continue
            grip["end"] = "lower" if grip["end"] == "upper" else "upper"
            for axis in ("y", "z", "about_y", "about_z"):
                if axis in grip and not (isinstance(grip[axis], dict) and "strain" in grip[axis]):
                    grip[axis] = negative(grip[axis])
        rows = []
        for tube in state.tubes():
            rows += reversed(tube)
        state.rows = rows
        # Turned over, an element points down; half a turn about its own x lets it point up again.
        state.each(lambda r, q, v, w: (turned(r, over), times(times(over, q), over), turned(v, over), turned(w, over)))
        return scene, state

    swapped = {"upper": "lower", "lower": "upper"}

    def other(name):
        for word, instead in swapped.items():
            if f"_{word}_" in name:
                return name.replace(word, instead)
        return name

    compare_moved(case, case.run(case.moving(overturned)), other=other, leave=("radius_mid_nm", "radius_end_nm"),
                  sign=lambda name: -1 if name.endswith(("_y_nN_nm",)) else 1)


@transformation
def order_of_tubes(case):
    """The numbers of the tubes."""
    without_noise(case)
    scene = case.scene
    n = scene.tube_count()
    skip_if(scene.has_strands() or scene.source == "plies", "tubes of strands and ropes are numbered together")
    new = list(range(n))  # the old number of each new tube
    case.random.shuffle(new)
    place = {old: k for k, old in enumerate(new)}

    def renumbered(scene, state):
        tubes = state.tubes()
        skip_if(len(tubes) < 2, "it has one tube")
        skip_if(len(tubes) != n, "tubes are broken at the start")
        skip_if("links" in scene or "failure" in scene, "places and strengths are drawn by the numbers of elements")
        state.rows = [(k, *row[1:]) for k, old in enumerate(new) for row in tubes[old]]
        for note in [x for x in state.notes if x.startswith("# tube_types")]:
            types = note.split(":")[1].strip().split(",")
            state.notes[state.notes.index(note)] = "# tube_types: " + ",".join(types[old] for old in new)
        if "tube_types" in scene:
            scene["tube_types"] = [scene["tube_types"][old] for old in new]
        for name in ("grip", "load"):
            for table in scene.list(name):
                if isinstance(table.get("tubes"), list):
                    table["tubes"] = sorted(place[t] for t in table["tubes"])
        for tether in scene.list("tether"):
            for key in ("tube", "to_tube"):
                if key in tether:
                    tether[key] = place[tether[key]]
        return scene, state

    compare_moved(case, case.run(case.moving(renumbered)))


@transformation
def energy_of_a_turned_state(case):
    """How a state lies in space, or which hand it has, for `ropewalk energy`."""
    state = evaluated(case)
    scene = case.scene
    first = case.energy(state, scene)
    axis = [case.random.gauss(0, 1) for _ in range(4)]
    size = math.sqrt(sum(x * x for x in axis))
    turn, away = tuple(x / size for x in axis), [case.random.uniform(-3000, 3000) for _ in range(3)]
    state.each(lambda r, q, v, w: (tuple(x + a for x, a in zip(turned(r, turn), away)), times(turn, q), v, w))
    other = case.energy(state, scene)
    same_energies(first, other)
    scale = max(max(map(abs, f)) for f in first["force_eV_per_nm"])
    for k, (f, g) in enumerate(zip(first["force_eV_per_nm"], other["force_eV_per_nm"])):
        if max(abs(x - y) for x, y in zip(turned(f, turn), g)) > 1e-7 * scale + 1e-9:
            raise Differs(f"force on element {k}")
    state.each(lambda r, q, v, w: ((-r[0], r[1], r[2]), (q[0], q[1], -q[2], -q[3]), v, w))
    same_energies(first, case.energy(state, scene))


def evaluated(case):
    """The last state of the scene, which `ropewalk energy` can take."""
    state = case.double.state().without_memory()
    skip_if("periodic" in case.scene, "a slice has images, of which a state file does not know")
    if case.energy(state, case.scene) is None:
        raise Differs("ropewalk energy refuses the last state of the run")
    return state


def same_energies(a, b, by=1.0, within=1e-8):
    floor = within * sum(abs(x) for x in a["energy_eV"].values())
    for part, value in a["energy_eV"].items():
        near(f"energy, {part}", by * value, b["energy_eV"][part], within, by * floor)


@transformation
def two_halves_far_apart(case):
    """Whether two ropes that do not reach one another stand in one state or in two."""
    state, scene = evaluated(case), case.scene
    skip_if(state.note("broken_behind_elements") or state.note("strands_begin_with_tubes"),
            "its notes number the tubes")
    first = case.energy(state, scene)
    count = len(state.tubes())
    rows = state.rows
    state.rows = rows + [(row[0] + count, (row[1][0] + 500.0, row[1][1] - 800.0, row[1][2] + 300.0), *row[2:])
                         for row in rows]
    state.notes = [n for n in state.notes if not n.startswith(("# ropes", "# tube_types"))]
    if "tube_types" in scene:
        scene["tube_types"] = 2 * scene["tube_types"]
    same_energies(first, case.energy(state, scene), by=2)


@transformation
def tubes_in_line(case):
    """What a state is allowed to be: `energy` and `run` refuse the same ones."""
    state, scene = evaluated(case), case.moving()
    rows, count = state.rows, len(state.tubes())
    state.notes = [n for n in state.notes if n.startswith("# element_length")]
    skip_if(len(scene.sets()) > 1, "its copies would need types")
    first = state.tubes()[0]
    span = [b - a for a, b in zip(first[0][1], first[-1][1])]
    length = math.sqrt(sum(x * x for x in span))
    per = [(1 + element_length(case) / length) * x for x in span]
    state.rows = [(0, *row[1:]) for row in first]
    state.rows += [(1, tuple(x + d for x, d in zip(row[1], per)), *row[2:]) for row in first]
    skip_if(scene.get("contact", {}).get("law") == "none", "without a contact law nothing is refused")
    state.write(case.folder / "in-line.csv")
    plain = Scene({"format": scene["format"], "parameters": scene["parameters"], "state": {"file": "in-line.csv"},
                   "run": {"duration_ps": 0.1}})
    for table in ("contact", "bond"):
        if table in scene:
            plain[table] = scene[table]
    ran, evaluates = case.start(plain).code == 0, case.energy(state, scene) is not None
    checks = case.bench.call("check", f"other-{case.count}.toml").returncode == 0
    if len({ran, evaluates, checks}) > 1:
        raise Differs(f"run takes it: {ran}, energy: {evaluates}, check: {checks}")


# --- another way of computing ------------------------------------------------------------------------------------------


@transformation
def fast_path_or_reference(case):
    """Whether forces are summed by the fast path or by the plain one over all pairs."""
    state, scene = evaluated(case), case.scene
    fast, plain = case.energy(state, scene), case.energy(state, scene, "--reference")
    same_energies(fast, plain, within=1e-9)
    for key in ("force_eV_per_nm", "torque_eV"):
        scale = max(max(map(abs, f)) for f in fast[key])
        for k, (f, g) in enumerate(zip(fast[key], plain[key])):
            if max(abs(x - y) for x, y in zip(f, g)) > 1e-9 * scale + 1e-10:
                raise Differs(f"{key} of element {k}: {f} / {g}")


@transformation
def threads(case):
    """The number of threads."""
    skip_if(case.scene.source == "state", "two tubes are too few to share")
    scene = case.scene.bigger(1.5)
    if scene.relaxes():
        scene = scene.with_keys(run={"max_steps": 150})
    one = case.run(scene)
    same_files(one, case.run(scene, "--threads", case.random.choice([2, 3])))


@transformation
def instructions(case):
    """The instruction set of the processor that is used."""
    sets = case.bench.instruction_sets()
    skip_if(len(sets) < 2, "this processor has one instruction set")
    other = case.run(case.in_double(), "--instructions", case.random.choice(sets[1:]))
    compare_rounding(case, case.double, other)


@transformation
def device(case):
    """Whether the processor moves the elements or the kernels of a device do."""
    scene = case.scene
    out = case.start(scene, "--device", "c++")
    skip_if(out.code == 2, "refused: " + out.said.strip().split(": ", 2)[-1][:120])
    if out.code not in (0, 7):
        raise Differs(f"ended with {out.code}: {out.said[-200:]}")
    same_columns(case.base.log, out.log, 1e-4, rounding=1e-5, leave=WITHOUT_SCALE, floor=3e-6)


# These begin at zero and are differences of large numbers, or jump where a pair comes within a radius.
WITHOUT_SCALE = ("balance_eV", "least_tension_nN", "void_area_nm2", "Q", "contacts", "voids", "Q_delaunay",
                 "core_pressure_GPa", "cohesion_lost", "time_step_fs")


@transformation
def neighbour_list(case):
    """The margin of the neighbour list."""
    scene = case.in_double()
    skip_if(scene.get("contact", {}).get("law") == "none", "it has no contacts")
    other = case.run(scene.with_keys(contact={"skin_nm": case.random.choice([0.05, 0.4, 0.9])}))
    compare_rounding(case, case.double, other, leave=("friction_slips",))


@transformation
def precision(case):
    """Whether pairs are summed in single or in double precision."""
    skip_if(case.scene.relaxes(), "it is in double precision already")
    skip_if(case.scene.is_warm(), "hot tubes part from one another by rounding")
    same_columns(case.base.log, case.double.log, 1e-4, rounding=1e-5, leave=WITHOUT_SCALE, floor=3e-6)


@transformation
def rows_and_frames(case):
    """How often rows, frames and checkpoints are written, and in which format."""
    scene = case.scene
    if scene.relaxes():
        other = case.run(scene.with_keys(run={"checkpoint_every_s": 0.01}))
        same_files(case.base, other, ("final.csv", "log.csv"))
        return
    every = scene["run"]["log_every_ps"]
    run = {"log_every_ps": every / 5, "frames_every_ps": 0.7, "frames_format": "lammpstrj", "checkpoint_every_s": 0.02}
    other = case.run(scene.with_keys(run=run))
    same_files(case.base, other, ("final.csv", "final-memory.csv", "events.csv"))
    ours, more = case.base.log, other.log
    at = {step: k for k, step in enumerate(more["step"])}
    means = ("torque_", "tension_", "stress_", "specific_stress_")
    for k, step in enumerate(ours["step"]):
        if step not in at:
            continue
        for name, values in ours.items():
            if name.startswith(means):
                continue  # means since the row before
            x, y = values[k], more[name][at[step]]
            if x != y and not (math.isnan(x) and math.isnan(y)) and abs(x - y) > 1e-9 * abs(x) + 1e-12:
                raise Differs(f"{name} {x!r} / {y!r} at {ours['time_ps'][k]:.4g} ps")


@transformation
def element_length_halved(case):
    """The length of the elements, within some per cent."""
    scene = case.scene
    skip_if(scene.is_warm(), "with other elements heat is another motion")
    skip_if(scene.has_strands(), "tubes are cut at whole elements")
    skip_if(any(s.endswith("-paper") for s in scene.sets()), "the published contact holds for its own elements")
    skip_if(scene.source in ("film", "state"), "its tubes are at random, or from a file")
    skip_if("links" in scene, "links are drawn by elements")
    skip_if("tether" in scene, "a tether holds the centre of an element")
    whole = element_length(case)
    fine = scene.with_keys(element_length_nm=whole / 2)
    if "periodic" in scene:
        scene["periodic"]["images"] = 5
        fine["periodic"]["images"] = 10
    elif scene.source == "chain":
        fine["chain"]["elements"] = 2 * scene["chain"]["elements"] - 1
    else:
        n = round(scene[scene.source]["length_nm"] / whole)
        fine[scene.source]["length_nm"] = (2 * n - 1) * whole / 2
    a, b = (case.run(s).log for s in (scene, fine))
    if scene.relaxes():
        same_columns(a, b, 0.06, only=("bend_eV", "most_curvature_per_nm"), last=True)
        return
    names = ("tension_upper_nN", "torque_upper_nN_nm", "geometric_twist_deg", "physical_twist_deg", "ends_apart_nm",
             "stretch_eV", "twist_eV", "dissipated_eV", "friction_slip_eV")
    # At the start a clamp of another length has another part of the forces on the end of the rope.
    for log in (a, b):
        for name in names:
            log[name] = [x - log[name][0] for x in log[name]]
    same_columns(a, by_time(b, a["time_ps"]), 0.25, 1e-3, only=names, floor=1e-3)


@transformation
def time_step_halved(case):
    """The time step, within its error."""
    scene = case.in_double()
    skip_if(scene.relaxes(), "it has no time")
    skip_if("thermostat" in scene, "another step has other noise")
    skip_if(scene.get("twist", {}).get("geometric_only"), "spins jump back at every increment")
    skip_if(scene.has_memory() and ("links" in scene or "failure" in scene), "what forms and breaks does so at steps")
    step = case.double.manifest["time_step_fs"]
    fine = case.run(scene.with_keys(run={"time_step_fs": 0.5 * step})).log
    names = ("stretch_eV", "bend_eV", "twist_eV", "vdw_eV", "work_eV", "dissipated_eV", "ends_apart_nm", "rotation_deg",
             "geometric_twist_deg", "physical_twist_deg", "friction_eV", "friction_slip_eV", "tether_eV")
    same_columns(case.double.log, by_time(fine, case.double.log["time_ps"]), 0.05, 1e-3, only=names, floor=1e-3)


@transformation
def time_step_typed(case):
    """Whether the program chooses the time step or the same one is typed."""
    scene = case.scene
    skip_if(scene.relaxes(), "it has no time")
    step = case.base.manifest["time_step_fs"]
    a, b = case.base, case.run(scene.with_keys(run={"time_step_fs": step}))
    same_columns(a.log, b.log, 1e-6, rounding=1e-7)


@transformation
def images_of_a_slice(case):
    """How many images a slice has."""
    scene = as_slice(case)
    logs = []
    for images in (4, 8):
        length = (12 + 2 * images) * element_length(case)
        logs.append(case.run(scene.with_keys(periodic={"images": images}, rope={"length_nm": length})).log)
    names = ("ends_apart_nm", "ends_strain", "tension_upper_nN", "stress_GPa", "specific_stress_N_per_tex",
             "stored_MJ_per_kg", "stored_twist_MJ_per_kg", "stored_stretch_MJ_per_kg", "stored_contact_MJ_per_kg")
    same_columns(logs[0], logs[1], 1e-4, only=names)


@transformation
def period_of_a_slice_doubled(case):
    """How long the slice is that stands for an endless rope."""
    scene = as_slice(case).with_keys(periodic={"images": 5, "tension_nN": [[0, 60]]})
    a, columns = element_length(case), ("stress_GPa", "specific_stress_N_per_tex")
    logs = [case.run(scene.with_keys(rope={"length_nm": (own + 10) * a})).log for own in (12, 24)]
    for name in columns:  # a longer one follows the tension more slowly
        one, two = ([x / t for x, t in zip(log[name], log["tension_upper_nN"]) if t > 1] for log in logs)
        near(f"{name} over the tension", one[-1], two[-1], 1e-6)
    # What a homogeneous stretch stores in each kilogram, whatever the length.
    held = as_slice(case)
    held["periodic"] = {"images": 5, "twist_deg_per_nm": [[0, 0]], "strain": [[0, 0], [1.5, 0.01]]}
    stored = [case.run(held.with_keys(rope={"length_nm": (own + 10) * a}, run={"duration_ps": 30})).log
              for own in (8, 16)]
    near("stored_MJ_per_kg", stored[0]["stored_MJ_per_kg"][-1], stored[1]["stored_MJ_per_kg"][-1], 0.03)


# --- stopped, gone on, handed over -----------------------------------------------------------------------------------


@transformation
def stopped_and_resumed(case):
    """Whether a run was stopped on the way, and with how many threads it went on."""
    scene, steps = case.scene, int(case.base.log["step"][-1])
    at = case.random.randrange(0, max(2, steps))
    out = case.run(scene, "--steps", at)
    done = case.bench.call("resume", out.path.name, "--quiet", "--threads", case.random.choice([1, 2]))
    if done.returncode not in (0, 4, 7):
        raise Differs(f"resume ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    try:
        same_files(case.base, out, (*EXACT_FILES, "limits.json"))
    except Differs as e:
        raise Differs(f"stopped at step {at} of {steps}: {e}") from None


@transformation
def longer_run_or_one_that_goes_on(case):
    """Whether a time is reached in one run, or by --until of a shorter one."""
    scene = case.scene
    skip_if(scene.relaxes(), "it has no time")
    duration = scene["run"]["duration_ps"]
    short = case.run(scene.with_keys(run={"duration_ps": duration * case.random.uniform(0.3, 0.7)}))
    done = case.bench.call("resume", short.path.name, "--quiet", "--threads", 1, "--until", duration)
    if done.returncode not in (0, 7):
        raise Differs(f"resume ended with {done.returncode}: {done.stderr.strip()[-200:]}")
    # The log has a row more, that of the end of the shorter one.
    same_files(case.base, short, ("final.csv", "final-memory.csv"))


@transformation
def state_handed_over(case):
    """Whether a state is the last one of a run or the first one of a scene."""
    scene = case.in_double()
    skip_if("periodic" in scene, "a slice begins as a [rope], not from a state file")
    last = {name: values[-1] for name, values in case.double.log.items()}
    shutil.copy(case.double / "final.csv", case.folder / "final.csv")
    if (case.double / "final-memory.csv").exists():
        shutil.copy(case.double / "final-memory.csv", case.folder / "final-memory.csv")
    gone_on = scene.with_keys(**{scene.source: None}).with_keys(state={"file": "final.csv"}, start={k: None for k in (
        "temperature_K", "may_cool", "twist_deg_per_nm", "wave_nm", "half_waves")})
    if not scene.relaxes():
        gone_on["run"]["duration_ps"] = 0.3
    first = {name: values[0] for name, values in case.run(gone_on).log.items()}
    kept = ["stretch_eV", "shear_eV", "bend_eV", "twist_eV", "vdw_eV", "kinetic_eV", "friction_eV", "links_eV",
            "tether_eV", "ends_eV", "beta_deg", "geometric_twist_deg", "physical_twist_deg", "Q", "contacts",
            "radius_mid_nm", "length_nm", "amplitude_nm", "most_curvature_per_nm", "ply_angle_deg", "ends_apart_nm",
            "most_tension_nN", "core_pressure_GPa", "writhe", "windings"]
    if any(name in scene for name in ("grip", "load")) or scene.relaxes():
        kept.remove("kinetic_eV")  # motions begin anew, and what is held moves with them
    same_columns({n: [v] for n, v in last.items()}, {n: [v] for n, v in first.items()}, 1e-7, rounding=1e-8, only=kept)
    for name in ("links_formed", "links_broken"):
        held = last["links_formed"] - last["links_broken"]
        if first["links_formed"] - first["links_broken"] != held:
            raise Differs(f"{held:.0f} links / {first['links_formed'] - first['links_broken']:.0f}")


@transformation
def noise_of_another_run(case):
    """Random numbers: a run that goes on from a state, another seed and another stream have noise of their own."""
    strong = in_a_bath(case).with_keys(thermostat={"coupling_per_ps": 20, "temperature_K": 300}, run={"duration_ps": 1.5})
    first = case.run(strong)
    others = {"the same again": strong, "another seed of the bath": strong.with_keys(thermostat={"seed": 77}),
              "another stream": strong.with_keys(start={"stream": 5})}
    if "periodic" not in strong:
        shutil.copy(first / "final.csv", case.folder / "final.csv")
        others["going on"] = strong.with_keys(**{strong.source: None}).with_keys(
            state={"file": "final.csv"}, start={"temperature_K": None, "may_cool": None},
            run={"time_step_fs": first.manifest["time_step_fs"]})
    for name, other in others.items():
        out = case.run(other)
        if out.manifest["steps"] != first.manifest["steps"]:
            continue
        like = correlation([x for row in first.state().rows for x in row[3] + row[4]],
                           [x for row in out.state().rows for x in row[3] + row[4]])
        if name == "the same again" and like < 0.99:
            raise Differs(f"the same scene twice: velocities correlate by {like:.2f}")
        if name != "the same again" and abs(like) > 0.35:
            raise Differs(f"{name}: velocities correlate by {like:.2f}")


@transformation
def seed_where_nothing_is_random(case):
    """The seed of a scene that draws nothing."""
    scene = case.scene
    random = (scene.is_warm() or scene.has_strands() or scene.source == "film" or "links" in scene or
              "perturbation_nm" in scene.get("rope", {}) or "failure" in scene and
              "strain_deviation" in scene["failure"])
    skip_if(random, "it draws random numbers")
    same_files(case.base, case.run(scene.with_keys(start={"seed": case.random.randrange(2, 10**6)})))


@transformation
def bath_beside_losses(case):
    """A bath keeps its temperature or is refused, whatever else takes energy away."""
    scene = in_a_bath(case)
    skip_if(scene.get("contact", {}).get("law") == "none", "nothing rubs without contacts")
    skip_if(scene.source in ("film", "state", "chain"), "its tubes hardly touch")
    skip_if(case.start(scene).code != 0, "it does not go into a bath")
    for name, keys in (("drag of friction", {"friction": [{"drag_eV_ps_per_nm3": 40}]}),
                       ("contact viscosity", {"damping": {"contact_viscosity_eV_ps_per_nm3": 40}}),
                       ("bond damping", {"damping": {"bond_damping_per_ps": 3}})):
        out = case.start(scene.with_keys(**keys))
        if out.code != 2:
            raise Differs(f"{name} in a bath ended with {out.code}, and is not refused")


# --- other verbs, Python, LAMMPS -------------------------------------------------------------------------------------


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
    scene = scene.with_keys(limits={"twist_deg": 0.6, "strain": 0.002, "wall_twist": 0.005})
    notes = [line for line in case.check(scene).splitlines() if "may bring" in line or "begins with" in line]
    found = {entry["key"]: entry
             for entry in json.loads((case.run(scene) / "limits.json").read_text())["limits"]}
    for line in notes:
        words = line.split()
        key = words[words.index("bring" if "bring" in words else "with") + 1]
        if key not in ("twist_deg", "strain", "wall_twist") or "begins" in words:
            continue
        value, entry = float(words[words.index("to") + 1].rstrip(",")), found[key]
        at = float(words[words.index("about") + 1]) if "about" in words else 0
        # A rope that moves overshoots, and one that follows slowly comes later or not at all within its time.
        if value > 8 * entry["largest"] + 8 * entry["limit"]:
            raise Differs(f"{key}: check foresees {value:.3g}, the run has at most {entry['largest']:.3g}")
        if entry["passed"] and entry["passed_at_ps"] < 0.25 * at - 0.2:
            raise Differs(f"{key}: check foresees it from {at:.3g} ps on, the run passes at {entry['passed_at_ps']:.3g} ps")
    for key in ("twist_deg", "strain", "wall_twist"):
        if found[key]["largest"] > 5 * found[key]["limit"] and not any(key in line for line in notes):
            raise Differs(f"{key}: check foresees nothing, the run has {found[key]['largest']:.3g}")


@transformation
def energy_of_the_last_state(case):
    """Energies by the log of a run and by `ropewalk energy` of its last state."""
    state, last = evaluated(case), {n: v[-1] for n, v in case.double.log.items()}
    length = case.check(case.in_double()).split("free length ")
    options = ["--free-length-nm", length[1].split(" nm")[0].split()[-1]] if len(length) > 1 else []
    found = case.energy(state, case.scene, *options)["energy_eV"]
    scale = sum(abs(x) for x in found.values())
    for part in ("stretch", "shear", "bend", "twist", "vdw"):
        near(f"{part}_eV", last[f"{part}_eV"], found[part], 1e-5 if options else 1e-7, 1e-8 * scale + 1e-9)
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
            if name not in log or name in ("Q", "Q_delaunay", "contacts", "voids", "void_area_nm2"):
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
    parts = ("stretch_eV", "shear_eV", "bend_eV", "twist_eV", "vdw_eV", "tether_eV", "friction_eV", "links_eV", "ends_eV")
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
    (case.folder / "by-python.toml").write_text(case.in_double().text())
    case.double
    script = f"""
import json, math, ropewalk
ropewalk.set_threads(1)
s = ropewalk.Simulation(ropewalk.Scene('by-python.toml'))
run = ropewalk.open({case.double.path.name!r})
steps = int(run.log['step'][-1])
s.step(steps)
names = [n for n in run.log.names if not n.startswith(('torque_', 'tension_', 'stress', 'specific', 'work_', 'step', 'time_step'))]
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
    skip_if("would divide" in done.stderr + done.stdout or case.kind == "collided", "LAMMPS does not divide steps")
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                   "OMP_NUM_THREADS": "1"}
    ran = subprocess.run([str(lmp), "-in", "in.rope"], cwd=case.folder / "there", capture_output=True, text=True,
                         env=environment)
    if ran.returncode != 0:
        raise Differs(f"LAMMPS ended with {ran.returncode}: {(ran.stdout + ran.stderr)[-300:]}")
    back = case.bench.call("import", "there")
    if back.returncode not in (0, 7):
        raise Differs(f"import ended with {back.returncode}: {back.stderr.strip()[-300:]}")
    mine, theirs = case.double.log, read_log(case.folder / "there" / "log.csv")
    if scene.relaxes():
        same_columns(mine, theirs, 2e-4, 1e-6, only=("stretch_eV", "bend_eV", "twist_eV", "vdw_eV"), last=True)
        return
    near("steps", mine["step"][-1], theirs["step"][-1], 0)
    leave = ("time_step_fs", "torque_upper_nN_nm", "torque_lower_nN_nm", "tension_upper_nN", "tension_lower_nN",
             "work_upper_eV", "work_lower_eV", "stress_GPa", "specific_stress_N_per_tex", *ONE_CLAMP_ONLY)
    same_columns(mine, theirs, 1e-6, 1e-7, last=True, leave=leave)


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
        skip_if(any(name in scene for name in ("links", "failure", "friction")), "what remembers has many states of rest")
        skip_if(scene.source in ("film", "state") or scene.has_strands(), "loose tubes come to rest in many ways")
        scene = undriven(scene)
        scene["run"] = {"mode": "relax"}
        scene["start"] = {"twist_deg_per_nm": 0.5} if scene.source == "rope" else {}
        scene.pop("thermostat", None)
    skip_if("twist" in scene, "FIRE comes to no rest under a moment")
    # To a state whose energy is known far better than the one that is compared.
    scene = scene.with_keys(run={"energy_tolerance": 1e-5, "solver": None})
    outs = [case.start(scene.with_keys(run={"solver": solver})) for solver in ("fire", "auto")]
    for out in outs:
        if out.code not in (0, 4):
            raise Differs(f"ended with {out.code}: {out.said.strip()[-200:]}")
    skip_if(any(out.code == 4 for out in outs), "it does not come to rest within the steps")
    same_columns(outs[0].log, outs[1].log, 5e-3, 1e-5, only=("stretch_eV", "bend_eV", "twist_eV", "vdw_eV"), last=True,
                 floor=1e-4)

