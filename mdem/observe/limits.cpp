#include "observe/limits.hpp"

#include <algorithm>
#include <cmath>

#include "model/segments.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {
namespace {

constexpr double stopped = 0.1;  // strain

enum Kind : std::size_t { bend, twist, kink_curvature, wall_twist, strain, overlap, speed };

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
  Peak pressed = out[strain];
  if (limits.compression > 0) pressed.limit = limits.compression;
  const int from = topology.tube_begin[tube], to = topology.tube_begin[tube + 1];
  Frame frame = frame_of(state.orientation[static_cast<std::size_t>(from)]);
  for (int e = from; e < to; ++e) {
    const auto i = static_cast<std::size_t>(e);
    raise(out[speed], state.velocity[i].norm(), e);
    if (e + 1 == to) break;
    const Frame next = frame_of(state.orientation[i + 1]);
    const BondEnds ends = bond_ends(type.bond, a, frame, next);
    const double bent = std::atan2(ends.i.t.cross(ends.j.t).norm(), ends.i.t.dot(ends.j.t));
    const double twisted = std::fabs(bond_twist_angle(ends.i, ends.j));
    raise(out[bend], bent, e);
    raise(out[twist], twisted, e);
    raise(out[kink_curvature], bent / a, e);
    raise(out[wall_twist], type.radius * twisted / a, e);
    const double stretched = (state.position[i + 1] - state.position[i]).norm() / a - 1;
    raise(stretched < 0 ? pressed : out[strain], std::fabs(stretched), e);
    frame = next;
  }
  if (out[strain].element < 0 || pressed.is_beyond(out[strain]))
    out[strain] = pressed, out[strain].pressed = true;
  return out;
}

bool ends_tube(const Topology& topology, int element) {
  const auto& begin = topology.tube_begin;
  return std::binary_search(begin.begin(), begin.end(), element) ||
         std::binary_search(begin.begin(), begin.end(), element + 1);
}
// Whether two elements are the ends of tubes in line: these rest nearer to each other than tubes side by side.
bool are_in_line(const Topology& topology, int i, int j, const Vector3& separation, const Vector3& axis,
                 double halves) {
  return std::fabs(separation.dot(axis)) > halves && ends_tube(topology, i) && ends_tube(topology, j);
}

// The pairs of each element that come nearer than they rest. Most are seen not to be the deepest by far.
void overlap_of_tube(const Topology& topology, const State& state, const Vec3Array& axes, const NeighbourList& list,
                     const Watched& watched, int tube, Peak& peak) {
  const TubeType& type = topology.type_of(tube);
  const auto types = topology.types.size(), row = static_cast<std::size_t>(topology.tube_type[tube]) * types;
  const double reach = *std::max_element(watched.rest.begin(), watched.rest.end()) + topology.longest_element();
  for (int i = topology.tube_begin[tube]; i < topology.tube_begin[tube + 1]; ++i) {
    const Vector3 centre = state.position[static_cast<std::size_t>(i)];
    const Vector3 axis = axes[static_cast<std::size_t>(i)];
    double deepest = peak.element >= 0 ? peak.value : 0;
    list.for_neighbours(i, [&](int element) {
      const auto j = static_cast<std::size_t>(element);
      const Vector3 separation = state.position[j] - centre;
      if (separation.squaredNorm() > reach * reach) return;
      const TubeType& other = types == 1 ? type : topology.type_of_element(element);
      const double rest = watched.rest[row + static_cast<std::size_t>(&other - topology.types.data())];
      const double half_i = 0.5 * type.element_length, half_j = 0.5 * other.element_length;
      const double wanted = rest - deepest;
      if (min_squared_distance(separation, axis, axes[j], half_i + half_j, 2 * half_j) > wanted * wanted) return;
      const double distance2 = squared_segment_distance(separation, axis, axes[j], half_i, half_j);
      if (distance2 < rest * rest && !are_in_line(topology, i, element, separation, axis, half_i + half_j))
        deepest = std::max(deepest, rest - std::sqrt(distance2));
    });
    raise(peak, deepest, i);
  }
}

}  // namespace

const std::array<LimitKind, limit_count>& limit_kinds() {
  constexpr const char* finer = "take a shorter element_length_nm";
  static const std::array<LimitKind, limit_count> kinds = {{
      {"bend_deg", "deg", units::degree, &Limits::bend, "the bond to the next element is bent by",
       "the chain is no longer the rod", finer, true},
      {"twist_deg", "deg", units::degree, &Limits::twist, "the bond to the next element is twisted by",
       "the chain is no longer the rod, and at 90 deg the bond slips", finer, true},
      {"kink_curvature_per_nm", "1/nm", 1, &Limits::kink_curvature, "the tube is curved by",
       "a real tube or filament kinks there", "bend it less, or do not trust what it does from now on", false},
      {"wall_twist", "", 1, &Limits::wall_twist, "radius times twist per length is",
       "the wall of a real tube, or a filament, collapses there", "twist it less, or do not trust its torsion from now on", false},
      {"strain", "", 1, &Limits::strain, "the bond to the next element is strained by",
       "the law of the bond ends there", "pull or press it less, or do not trust its force from now on", false},
      {"press_nm", "nm", 1, &Limits::overlap, "the tube is pressed into another one by",
       "the contact law is only continued there", "load it more gently, or start it without overlaps", false},
      {"speed_nm_per_ps", "nm/ps", 1, &Limits::speed, "the element moves with",
       "stopping it would strain the tube by 10 % or more", "load it more gently, or damp more", false},
      {"pressure_GPa", "GPa", units::nN_nm, &Limits::pressure, "the tube is pressed from all sides by",  // nN/nm^2
       "a real tube or filament flattens there", "load it less, or do not trust its shape from now on", false},
      {"energy_drift", "", 1, &Limits::energy_drift,
       "the error of the energy balance, over the energy that was converted, is",
       "the steps themselves give or take energy", "take a shorter run.time_step_fs, or leave this key out", false,
       true},
      {"shock", "", 1, &Limits::shock, "the kinetic energy, over the energy of twist under the whole moment, is",
       "the load sets in like a shock, and the final state depends on that", "ramp the moment more slowly", false,
       true},
  }};
  return kinds;
}

std::string holder_in_words(const Topology& topology, const std::vector<Held>& held, int element) {
  if (held.empty() || element < 0) return "";
  const int tube = topology.tube_of(element), from = topology.tube_begin[tube], to = topology.tube_begin[tube + 1];
  const Held own = held[static_cast<std::size_t>(element)],
             next = element + 1 < to ? held[static_cast<std::size_t>(element + 1)] : Held::free;
  const Held by = std::max(own, next);
  if (by == Held::free) return "";
  const bool lower = element == from && topology.begins_strand(tube),
             upper = element + 2 >= to && topology.ends_strand(tube) && !(lower && own != Held::free);
  if (!lower && !upper) return by == Held::clamped ? "a clamp" : "a loaded place";
  const char* end = upper ? "upper" : "lower";
  return by == Held::clamped ? std::string("the ") + end + " clamp" : std::string("the loaded ") + end + " end";
}

std::string place_in_words(const Topology& topology, const std::vector<Held>& held, int element) {
  const int tube = topology.tube_of(element);
  const std::string holder = holder_in_words(topology, held, element);
  return "tube " + std::to_string(tube) + ", element " + std::to_string(element - topology.tube_begin[tube]) +
         (holder.empty() ? "" : ", at " + holder);
}

double collapse_pressure(double radius) {
  constexpr double bending = 1.7, b = 0.44;  // eV, nm
  const double d = 2 * radius;
  return d > b ? 24 * bending * (1 - b * b / (d * d)) / (d * d * d) : 0;
}

Peak pressure_peak(const Topology& topology, const State& state, const Watched& watched) {
  Peak out;
  if (!watched.pressures) return out;
  const std::vector<double> all = watched.pressures(state);
  for (int t = 0; t < topology.tubes(); ++t) {
    const double limit = watched.limits[static_cast<std::size_t>(topology.tube_type[t])].pressure;
    const Peak here{all[static_cast<std::size_t>(t)], limit, topology.tube_begin[t] + topology.length_of(t) / 2};
    if (out.element < 0 || here.is_beyond(out)) out = here;
  }
  return out;
}

Limits default_limits(const TubeType& type, const Validity& validity) {
  Limits limits;
  limits.kink_curvature = validity.kink_curvature;
  limits.wall_twist = validity.twist_collapse;
  limits.strain = validity.largest_tension();
  limits.compression = validity.stretch;
  limits.pressure = collapse_pressure(type.radius);
  limits.speed = stopped * std::sqrt(type.bond.stretch * type.element_length / type.mass);
  return limits;
}

Peaks peaks(const Topology& topology, const State& state, const NeighbourList& list, const Watched& watched) {
  std::vector<Peaks> tubes(static_cast<std::size_t>(topology.tubes()));
  const bool watch_overlap = list.pairs() > 0 && !watched.rest.empty();
  Vec3Array axes(watch_overlap ? state.size() : 0);
  const bool parallel = state.size() > parallel_from;
  for_each(axes.size(), parallel, [&](std::size_t i) { axes.set(i, axis_of(state.orientation[i])); });
  for_each(topology.tubes(), parallel, [&](int t) {
    Peaks& own = tubes[static_cast<std::size_t>(t)];
    own = peaks_of_tube(topology, state, t, watched.limits[static_cast<std::size_t>(topology.tube_type[t])]);
    if (watch_overlap) overlap_of_tube(topology, state, axes, list, watched, t, own[overlap]);
  });
  Peaks out;
  for (const Peaks& tube : tubes)
    for (std::size_t k = 0; k < limit_count; ++k) {
      if (tube[k].element >= 0 && (out[k].element < 0 || tube[k].is_beyond(out[k]))) out[k] = tube[k];
    }
  return out;
}

}  // namespace ropewalk
