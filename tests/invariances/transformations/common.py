"""What transformations share: their table, other forms of a scene, comparisons."""
from bench import Differs, near, same_columns, skip_if


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
        leave = (*how.pop("leave", ()), *(OF_A_ROPE if case.scene.source == "film" else ()))
        same_columns(first.log, second.log, within, rounding=3e-8, leave=leave, floor=1e-9, **how)


# What these columns say of a film has no meaning, and rounding decides some of them.
OF_A_ROPE = ("beta_deg", "geometric_twist_deg", "physical_twist_deg", "ply_angle_deg", "Q", "Q_delaunay", "contacts",
             "voids", "void_area_nm2", "radius_mid_nm", "radius_end_nm", "length_nm", "amplitude_nm", "windings",
             "helix_radius_nm", "pitch_nm", "middle_amplitude_nm", "writhe", "turned_back", "slip_nm",
             "core_pressure_GPa", "rotation_deg", "ends_apart_nm", "ends_strain")


def compare_moved(case, moved, within=1e-7, **how):
    compare_rounding(case, case.moved, moved, within, **how)


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
        damping={"contact_viscosity_eV_ps_per_nm3": 0, "contact_viscosity_eV_ps_per_nm2": None,
                 "bond_damping_per_ps": 0})


def as_slice(case):
    """The interior of the rope of the scene, cold, without what is random."""
    scene = case.in_double()
    skip_if(scene.source != "rope", "a slice is made of a [rope]")
    skip_if(scene.has_strands(), "its tubes are cut at random")
    skip_if("links" in scene or "strain_deviation" in scene.get("failure", {}),
            "links and strengths are drawn by elements")
    skip_if(any(s.endswith("-paper") for s in scene.sets()), "the published contact turns with the places of elements")
    skip_if(scene.relaxes(), "a relaxation has no time")
    return undriven(scene).with_keys(
        rope={"perturbation_nm": None}, thermostat=None,
        start={k: None for k in ("temperature_K", "may_cool", "wave_nm", "half_waves", "twist_deg_per_nm")},
        periodic={"twist_deg_per_nm": [[0, 0], [20, 1]], "tension_nN": [[0, 0], [2, 60]]},
        damping={"contact_viscosity_eV_ps_per_nm3": 27, "bond_damping_per_ps": 1}, run={"duration_ps": 4})


def element_length(case):
    state = case.base.state()
    note = state.note("element_length_nm")
    return float(note.split(":")[1])


ONE_CLAMP_ONLY = ("torque_upper_nN_nm", "torque_lower_nN_nm", "torque_upper_x_nN_nm", "torque_upper_y_nN_nm",
                  "torque_lower_x_nN_nm", "torque_lower_y_nN_nm")


# These begin at zero and are differences of large numbers, or jump where a pair comes within a radius.
WITHOUT_SCALE = ("balance_eV", "least_tension_nN", "void_area_nm2", "Q", "contacts", "voids", "Q_delaunay",
                 "core_pressure_GPa", "cohesion_lost", "time_step_fs")


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
