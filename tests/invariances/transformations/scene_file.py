"""What a scene file says in another way."""
import json
import shutil

from bench import AXES, Differs, Scene, each_value, negative, same_columns, same_files, skip_if
from transformations.common import ONE_CLAMP_ONLY, compare_moved, compare_rounding, transformation, with_twist


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
    skip_if(any(s.endswith("-paper") for s in case.scene.sets()), "the published contact is that of one set")

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
        parts = [{**upper, "z": half}, {**lower, "end": "lower", "z": half}]  # at either end it draws the rope out
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
    skip_if(scene.relaxes() and "perturbation_nm" in scene.get("rope", {}),
            "a perturbed rope has many states of rest near one another")
    halves = [list(range(n // 2)), list(range(n // 2, n))]
    if scene.list("load"):
        parts = [[[t for t in half if t in load.get("tubes", half)] for half in halves] for load in scene["load"]]
        loads = [{**load, "tubes": part} for load, both in zip(scene["load"], parts) for part in both if part]
        one, two = scene, scene.with_keys(load=loads)
    else:
        skip_if(scene.has_strands(), "its tubes are cut at random")
        skip_if("twist" in scene, "[twist] stands once")
        each = [{"end": "lower", "as": "each"},
                {"end": "upper", "as": "each", "z": {"force_nN": [[0, 0], [3, 2]]}, "x": "free", "y": "free"}]
        one = scene.with_keys(grip=each, run={"duration_ps": 4} if not scene.relaxes() else {})
        two = one.with_keys(grip=[{**grip, "tubes": half} for grip in each for half in halves])
    compare_rounding(case, case.run(one), case.run(two), leave=ONE_CLAMP_ONLY)


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
    skip_if("solver" in scene.get("run", {}), "Newton's method takes no friction")
    if len(scene.sets()) == 1:
        scene["parameters"] = 2 * scene.sets()
        scene["tube_types"] = [k % 2 for k in range(scene.tube_count())]
    table = {k: v for k, v in scene.list("friction")[0].items() if k != "types"} if "friction" in scene else {
        "strength_pN_per_nm": 4, "spin_strength_pN_per_nm": 2, "elastic_slip_nm": 0.03}
    one = scene.with_keys(links=None, friction=[table])
    if not scene.relaxes():  # three tables are taken for three times as stiff, which shortens the step
        one["run"]["time_step_fs"] = float(f"{0.6 * case.double.manifest['time_step_fs']:.3g}")
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
    skip_if(scene.is_warm() or scene.relaxes(), "damping would take its heat, or it has none")
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
                          start={k: None for k in (
                              "temperature_K", "may_cool", "twist_deg_per_nm", "wave_nm", "half_waves")})
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
    notes = [[line for line in case.check(s).splitlines() if "may bring" in line or "begins with" in line]
             for s in (one, two)]
    if notes[0] != notes[1]:
        raise Differs(f"check: {notes[0]} / {notes[1]}")
    compare_rounding(case, case.run(one), case.run(two), leave=("friction_slips",))
