#include "cases/cases.hpp"

namespace ropewalk {

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases = {
      stretch_and_cantilever_case(), euler_buckling_case(), greenhill_case(),
      michell_ring_case(),           ring_energy_case(),    wave_speeds_case(),
  };
  return cases;
}

}  // namespace ropewalk
