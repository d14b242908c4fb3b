"""Runs that stop and go on, states that are handed over, random numbers."""
import math
import shutil

from bench import EXACT_FILES, Differs, same_columns, same_files, skip_if
from transformations.common import in_a_bath, transformation


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
    # Where steps are divided the account is judged at the end of each. The log has a row more, that of the shorter end.
    skip_if(len(set(case.base.log["time_step_fs"])) > 1 or len(set(short.log["time_step_fs"])) > 1,
            "its steps are divided, also at the end of the shorter scene")
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
    strong = in_a_bath(case).with_keys(thermostat={"coupling_per_ps": 20, "temperature_K": 300},
                                       run={"duration_ps": 1.5})
    first = case.run(strong)
    others = {"the same again": strong, "another seed of the bath": strong.with_keys(thermostat={"seed": 77}),
              "another stream": strong.with_keys(start={"stream": 5})}
    if "periodic" not in strong:
        shutil.copy(first / "final.csv", case.folder / "final.csv")
        others["going on"] = strong.with_keys(**{strong.source: None}).with_keys(
            state={"file": "final.csv"}, start={k: None for k in (
                "temperature_K", "may_cool", "twist_deg_per_nm", "wave_nm", "half_waves")},
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


def correlation(a, b):
    x, y = sum(a) / len(a), sum(b) / len(b)
    both = sum((p - x) * (q - y) for p, q in zip(a, b))
    return both / math.sqrt(sum((p - x)**2 for p in a) * sum((q - y)**2 for q in b))


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
