#include "observe/limits.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

constexpr double shock = 0.1;  // strain

enum Kind : std::size_t { bend, twist, kink_curvature, wall_twist, strain, speed };

void raise(Peak& peak, double value, int element) {
  if (peak.element >= 0 && !(value > peak.value)) return;
  peak.value = value;
  peak.element = element;
}

Peaks peaks_of_tube(const Topology& topology, const State& state, int tube, const Limits& limits) {
  const TubeType& type = topology.type_of(tube);
  const double a = type.element_length;
  Peaks out;
  for (std::size_t k = 0; k < limit_count; ++k) out[k].limit = limits.*limit_kinds()[k].limit;
  const int from = topology.tube_begin[tube], to = topology.tube_begin[tube + 1];
  Frame<double> frame = frame_of(state.orientation[static_cast<std::size_t>(from)]);
  for (int e = from; e < to; ++e) {
    const auto i = static_cast<std::size_t>(e);
    raise(out[speed], state.velocity[i].norm(), e);
    if (e + 1 == to) break;
    const Frame<double> next = frame_of(state.orientation[i + 1]);
    const double bent = std::atan2(frame.t.cross(next.t).norm(), frame.t.dot(next.t));
    const double twisted = std::fabs(bond_twist_angle(frame, next));
    raise(out[bend], bent, e);
    raise(out[twist], twisted, e);
    raise(out[kink_curvature], bent / a, e);
    raise(out[wall_twist], type.radius * twisted / a, e);
    raise(out[strain], std::fabs((state.position[i + 1] - state.position[i]).norm() / a - 1), e);
    frame = next;
  }
  return out;
}

}  // namespace

const std::array<LimitKind, limit_count>& limit_kinds() {
  constexpr const char* finer = "take a shorter element_length_nm, or --on-limit refine";
  static const std::array<LimitKind, limit_count> kinds = {{
      {"bend_deg", "deg", units::degree, &Limits::bend, "the bond to the next element is bent by",
       "the chain is no longer the rod", finer, true},
      {"twist_deg", "deg", units::degree, &Limits::twist, "the bond to the next element is twisted by",
       "the chain is no longer the rod, and at 90 deg the bond slips", finer, true},
      {"kink_curvature_per_nm", "1/nm", 1, &Limits::kink_curvature, "the tube is curved by",
       "a real tube kinks there", "bend it less, or do not trust what it does from now on", false},
      {"wall_twist", "", 1, &Limits::wall_twist, "radius times twist per length is",
       "the wall of a real tube collapses there", "twist it less, or do not trust its torsion from now on", false},
      {"strain", "", 1, &Limits::strain, "the bond to the next element is strained by",
       "the linear law of the bond ends there", "pull or press it less, or do not trust its force from now on",
       false},
      {"speed_nm_per_ps", "nm/ps", 1, &Limits::speed, "the element moves with",
       "stopping it would strain the tube by 10 % or more", "load it more gently, or damp more", false},
  }};
  return kinds;
}

Limits default_limits(const TubeType& type, const Validity& validity) {
  Limits limits;
  limits.kink_curvature = validity.kink_curvature;
  limits.wall_twist = validity.twist_collapse;
  limits.strain = validity.stretch;
  limits.speed = shock * std::sqrt(type.bond.stretch * type.element_length / type.mass);
  return limits;
}

Peaks peaks(const Topology& topology, const State& state, const std::vector<Limits>& limits) {
  std::vector<Peaks> tubes(static_cast<std::size_t>(topology.tubes()));
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (int t = 0; t < topology.tubes(); ++t)
    tubes[static_cast<std::size_t>(t)] =
        peaks_of_tube(topology, state, t, limits[static_cast<std::size_t>(topology.tube_type[t])]);
  Peaks out;
  for (const Peaks& tube : tubes)
    for (std::size_t k = 0; k < limit_count; ++k) {
      const bool watched = tube[k].limit > 0 && out[k].limit > 0;
      const bool more = watched ? tube[k].ratio() > out[k].ratio() : tube[k].value > out[k].value;
      if (tube[k].element >= 0 && (out[k].element < 0 || more)) out[k] = tube[k];
    }
  return out;
}

}  // namespace ropewalk
