#include "scene/loads/torque.hpp"

#include "scene/loads/load_kind.hpp"

namespace ropewalk {

LoadKind torque_kind() {
  return load_kind<TorqueLoad>(
      {"torque",
       "",
       {vector_key("torque_nN_nm", unit::nN_nm, &TorqueLoad::torque, "[0, 0, 1]", "on each element")},
       {}});
}

void TorqueLoad::add_forces(const State&, double, std::vector<PointLoad>& out) const {
  for (const int e : elements) out.push_back({e, Vector3::Zero(), torque});
}

}  // namespace ropewalk
