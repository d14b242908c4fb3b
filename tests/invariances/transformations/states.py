"""How a state lies in space, and how its tubes are counted."""
import math

from bench import Differs, Scene, negative, same_columns, skip_if, times, turned
from transformations.common import compare_moved, element_length, evaluated, same_energies, transformation


@transformation
def shift(case):
    """Where the scene lies: all of it shifted, beyond 128 nm also, where coordinates of single precision wrap."""
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

    here, there = case.moving(), case.moving(shifted)
    compare_moved(case, case.run(there))
    single = {"precision": "mixed"}
    if case.scene.relaxes():
        return
    first, second = (case.run(scene.with_keys(contact=single)) for scene in (here, there))
    names = ("stretch_eV", "bend_eV", "twist_eV", "vdw_eV", "kinetic_eV", "dissipated_eV")
    same_columns(first.log, second.log, 1e-4, 1e-5, only=names, floor=1e-5)


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
        # Thousands of nm away the last bit of a position is a force of some 1e-8 eV/nm.
        if max(abs(x - y) for x, y in zip(turned(f, turn), g)) > 1e-7 * scale + 1e-7:
            raise Differs(f"force on element {k}")
    state.each(lambda r, q, v, w: ((-r[0], r[1], r[2]), (q[0], q[1], -q[2], -q[3]), v, w))
    same_energies(first, case.energy(state, scene))


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
