#include "scene/loads/force.hpp"

#include "scene/loads/load_kind.hpp"

namespace ropewalk {

LoadKind force_kind() {
  return load_kind<ForceLoad>(
      {"force", "", {vector_key("force_nN", unit::nN, &ForceLoad::force, "[0.01, 0, 0]", "on each element")}, {}});
}

void ForceLoad::add_forces(const State&, double, std::vector<PointLoad>& out) const {
  for (const int e : elements) out.push_back({e, force, Vector3::Zero()});
}

}  // namespace ropewalk
