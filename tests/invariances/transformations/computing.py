"""The same calculation done in another way, or more finely."""
import math

from bench import Differs, State, by_time, near, same_columns, same_files, skip_if
from transformations.common import (WITHOUT_SCALE, as_slice, compare_rounding, element_length, evaluated,
                                    same_energies, transformation)


@transformation
def fast_path_or_reference(case):
    """Whether forces are summed by the fast path or by the plain one over all pairs."""
    state, scene = evaluated(case), case.scene
    fast, plain = case.energy(state, scene), case.energy(state, scene, "--reference")
    same_energies(fast, plain, within=1e-9)
    for key in ("force_eV_per_nm", "torque_eV"):
        scale = max(max(map(abs, f)) for f in fast[key])
        for k, (f, g) in enumerate(zip(fast[key], plain[key])):
            if max(abs(x - y) for x, y in zip(f, g)) > 1e-9 * scale + 1e-9:
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
    if len(set(case.base.log["time_step_fs"])) == 1 or scene.source != "state":
        return
    # Tubes that swing for some 300 steps and collide, without rows on the way: both must go back to the same step to
    # divide those that follow.
    state = State(case.folder / scene["state"]["file"])
    state.each(lambda r, q, v, w: ((4 * r[0], *r[1:]), q, tuple(x + case.random.gauss(0, 0.1) for x in v), w)).write(
        case.folder / "swinging.csv")
    scene = scene.with_keys(state={"file": "swinging.csv"}, run={"duration_ps": 20, "log_every_ps": 20})
    logs = [case.run(scene, *options).log for options in ((), ("--device", "c++"))]
    # Rounding of the contact grows as they part.
    same_columns(*logs, 1e-2, only=("stretch_eV", "bend_eV", "twist_eV", "kinetic_eV"), last=True)


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
        same_columns(a, b, 0.2, only=("twist_eV", "bend_eV", "most_curvature_per_nm"), last=True, floor=1e-3)
        return
    names = ("torque_upper_nN_nm", "geometric_twist_deg", "physical_twist_deg", "ends_apart_nm",
             "stretch_eV", "twist_eV", "dissipated_eV", "friction_slip_eV")
    # About its axis a rope that bends has no torque but that of the first instant, by the corners of its clamps.
    largest = {name: max(map(abs, a[name])) for name in ("torque_upper_nN_nm", "torque_upper_y_nN_nm")}
    if largest["torque_upper_nN_nm"] < 0.05 * largest["torque_upper_y_nN_nm"]:
        names = names[1:]
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
    skip_if(any("breaks_at_nm" in tether for tether in scene.list("tether")), "what breaks does so at a step")
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
    # Torque and tension contain the inertia of the images while these move.
    names = ("ends_apart_nm", "ends_strain", "stored_MJ_per_kg", "stored_twist_MJ_per_kg",
             "stored_stretch_MJ_per_kg", "stored_contact_MJ_per_kg")
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
