// The cases, each defined in the file of its name.
#pragma once

#include "core/case.hpp"

namespace ropewalk {

Case stretch_and_cantilever_case();
Case euler_buckling_case();
Case greenhill_case();
Case michell_ring_case();
Case ring_energy_case();
Case wave_speeds_case();
Case crossing_torque_case();
Case peeling_force_case();
Case hexagonal_cohesion_case();
Case adhesive_ring_case();
Case racket_case();
Case helix_threshold_case();
Case packing_charge_case();
Case tube_stretch_case();
Case tube_twist_case();
Case tube_bend_case();
Case pair_distance_case();
Case pair_sliding_case();
Case crossed_tubes_case();
Case rope_7_5_5_short_case();
Case rope_7_5_5_long_case();
Case rope_7_10_10_case();
Case bent_bundle_case();
Case warm_bundle_case();
Case isotropic_contact_case();
Case legacy_torque_case();
Case parallel_bond_case();
Case rope_bead_spring_case();
Case rope_parallel_bond_case();
Case rope_legacy_torque_case();
Case limit_chain_step_case();
Case limit_contact_step_case();
Case limit_tunnelling_case();
Case limit_bond_slip_case();
Case limit_contact_stiffness_case();
Case limit_element_length_case();
Case limit_crossing_case();
Case limit_list_skin_case();
Case limit_fire_case();
Case limit_nan_case();

}  // namespace ropewalk
