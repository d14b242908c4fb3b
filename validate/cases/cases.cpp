#include "cases/cases.hpp"

namespace ropewalk {

// In the order of the report.
const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = {
      stretch_and_cantilever_case(),
      euler_buckling_case(),
      greenhill_case(),
      michell_ring_case(),
      ring_energy_case(),
      wave_speeds_case(),
      crossing_torque_case(),
      peeling_force_case(),
      hexagonal_cohesion_case(),
      adhesive_ring_case(),
      racket_case(),
      helix_threshold_case(),
      packing_charge_case(),
      tube_stretch_case(),
      tube_twist_case(),
      tube_bend_case(),
      pair_distance_case(),
      pair_sliding_case(),
      crossed_tubes_case(),
      rope_7_5_5_short_case(),
      rope_7_5_5_long_case(),
      rope_7_10_10_case(),
      bent_bundle_case(),
      warm_bundle_case(),
      isotropic_contact_case(),
      legacy_torque_case(),
      parallel_bond_case(),
      rope_bead_spring_case(),
      rope_parallel_bond_case(),
      rope_legacy_torque_case(),
      limit_chain_step_case(),
      limit_contact_step_case(),
      limit_tunnelling_case(),
      limit_bond_slip_case(),
      limit_contact_stiffness_case(),
      limit_element_length_case(),
      limit_crossing_case(),
      limit_list_skin_case(),
      limit_fire_case(),
      limit_nan_case(),
  };
  return cases;
}

}  // namespace ropewalk
