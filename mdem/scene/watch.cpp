#include "scene/watch.hpp"

#include <algorithm>

#include "scene/scene_to_model.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

double twist_energy_of(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads) {
  if (topology.tubes() < 2 || scene.start.temperature > 0 || scene.bath()) return 0;
  const std::optional<EndMoment> load = end_moment(end_drives(loads, topology));
  if (!load || !load->twists() || load->relaxes_spins) return 0;
  const double moment = load->of_each(topology.strands());
  double energy = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    energy += moment * moment * topology.length_of(t) * type.element_length / (2 * type.bond.twist);
  }
  return energy;
}

std::vector<Held> held_by(const LoadsAndConstraints& loads, const Topology& topology) {
  std::vector<Held> out;
  if (!loads.empty()) out.assign(static_cast<std::size_t>(topology.elements()), Held::free);
  for (const auto& load : loads)
    for (const int e : load->elements) {
      Held& held = out[static_cast<std::size_t>(e)];
      held = std::max(held, load->order() == Load::Order::force ? Held::loaded : Held::clamped);
    }
  return out;
}

Watched watched_of(const Scene& scene, const Topology& topology, const LoadsAndConstraints& loads,
                   const ContactLaw* law) {
  Watched out;
  const auto types = static_cast<int>(scene.sets.size());
  for (int i = 0; law && i < types; ++i)
    for (int j = 0; j < types; ++j) out.rest.push_back(law->parallel_distance({i, j}, scene.element_length));
  out.twist_energy = twist_energy_of(scene, topology, loads);
  out.held = held_by(loads, topology);
  const std::vector<Validity> validity = validities(scene, topology);
  for (std::size_t type = 0; type < scene.sets.size(); ++type) {
    Limits limits = default_limits(topology.types[type], validity[type]);
    const auto own = static_cast<int>(type);
    limits.overlap = law ? out.rest[type * scene.sets.size() + type] - law->core_distance({own, own}) : 0;
    if (scene.contact.legacy_torque) limits.energy_drift = 0;  // it gains energy, and is there to show it
    for (std::size_t k = 0; k < limit_count; ++k)
      if (scene.limits[k]) limits.*limit_kinds()[k].limit = *scene.limits[k];
    for (std::size_t k = 0; k < limit_count; ++k)
      if (scene.limits[k] && limit_kinds()[k].limit == &Limits::strain) limits.compression = limits.strain;
    if (scene.run.mode == RunOptions::Mode::relax) limits.speed = limits.shock = 0;  // no motion of tubes
    out.limits.push_back(limits);
  }
  return out;
}

}  // namespace ropewalk
