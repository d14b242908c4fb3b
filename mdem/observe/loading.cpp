#include "observe/loading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "observe/centre_line.hpp"
#include "observe/rope_size.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {
namespace {

// How far element k of tube b lies ahead of element k of tube a, along their mean direction.
double ahead(const Topology& topology, const State& state, int a, int b, int k) {
  const auto i = static_cast<std::size_t>(topology.tube_begin[a] + k),
             j = static_cast<std::size_t>(topology.tube_begin[b] + k);
  const Vector3 along = (axis_of(state.orientation[i]) + axis_of(state.orientation[j])).normalized();
  return (state.position[j] - state.position[i]).dot(along);
}

// The largest slip of each pair of neighbours.
std::vector<double> slips(const Topology& topology, const State& state, const LoadingReference& reference) {
  std::vector<double> out;
  std::size_t at = 0;
  for (const auto& [a, b] : reference.neighbours) {
    double most = 0;
    for (int k = 0; k < topology.length_of(a); ++k, ++at)
      most = std::max(most, std::fabs(ahead(topology, state, a, b, k) - reference.offset[at]));
    out.push_back(most);
  }
  return out;
}

double mean_of_middle(const std::vector<double>& all) {
  const std::size_t from = all.size() / 3, to = all.size() - from;
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += all[k];
  return to > from ? sum / static_cast<double>(to - from) : 0;
}

double largest_curvature(const Topology& topology, const State& state, int tube) {
  double most = 0;
  for (int e = topology.tube_begin[tube]; e + 1 < topology.tube_begin[tube + 1]; ++e) {
    if (has_parted(topology.type_of(tube),
                   state.position[static_cast<std::size_t>(e) + 1] - state.position[static_cast<std::size_t>(e)]))
      continue;
    const Vector3 a = axis_of(state.orientation[static_cast<std::size_t>(e)]),
                  b = axis_of(state.orientation[static_cast<std::size_t>(e) + 1]);
    most = std::max(most, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return most / topology.type_of(tube).element_length;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Whether slip has a value: only between strands of one length that run the same way at the start.
bool knows_slip(const Topology& topology, const LoadingReference& reference) {
  return topology.tubes() < 2 || !reference.radius.empty();
}

// Distance from the centre of an end to that of its innermost elements, nm: they are held as one.
double within(const Topology& topology, const std::vector<int>& end) {
  std::set<int> tubes;
  for (const int e : end) tubes.insert(topology.tube_of(e));
  if (tubes.empty()) return 0;
  const double each = static_cast<double>(end.size()) / static_cast<double>(tubes.size());
  return 0.5 * (each - 1) * topology.type_of_element(end.front()).element_length;
}

double twist_of(const Topology& topology, const State& state, int tube) {
  double sum = 0;
  int bonds = 0;
  for (int e = topology.tube_begin[tube]; e + 1 < topology.tube_begin[tube + 1]; ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (has_parted(topology.type_of(tube), state.position[i + 1] - state.position[i])) continue;
    const TubeType& type = topology.type_of(tube);
    sum += bond_twist_angle(type.bond, type.element_length, frame_of(state.orientation[i]),
                            frame_of(state.orientation[i + 1]));
    ++bonds;
  }
  return bonds > 0 ? sum / (bonds * topology.type_of(tube).element_length) : 0;
}

}  // namespace

double slice_length(const Topology& topology, const State& state) {
  double sum = 0;
  int images = 0;
  for (int e = 0; e < topology.elements(); ++e)
    if (const int image = topology.image_above(e); image >= 0) {
      sum += state.position.z[static_cast<std::size_t>(image)] - state.position.z[static_cast<std::size_t>(e)];
      ++images;
    }
  return sum / images;
}

LoadingReference loading_reference(const Topology& tubes, const State& start, const RopeShells& shells,
                                   EndElements ends, double spacing, double neighbour_radius,
                                   std::shared_ptr<const ContactLaw> law) {
  LoadingReference out;
  const Topology topology = strands_of(tubes);
  out.ends_apart = (centre_of(tubes, start, ends[upper_end]) - centre_of(tubes, start, ends[lower_end])).norm();
  out.ends = std::move(ends);
  out.law = std::move(law);
  out.cells = packing_cells(tubes, spacing, out.law.get());
  const int n = common_length(topology);
  if (n == 0 || !run_the_same_way(tubes, start)) return out;
  const Vector3 axis = centre_line(topology, start).tangents[static_cast<std::size_t>(n / 2)];
  const Vector3 centre = centre_line(topology, start).points[static_cast<std::size_t>(n / 2)];
  const auto middle = [&](int t) -> Vector3 {
    const Vector3 arm = start.position[static_cast<std::size_t>(topology.tube_begin[t] + n / 2)] - centre;
    return arm - arm.dot(axis) * axis;
  };
  std::vector<double> radii;  // radii of the strands
  for (int a = 0; a < topology.tubes(); ++a) {
    const double radius = middle(a).norm();
    radii.push_back(radius);
    for (int e = topology.tube_begin[a]; e < topology.tube_begin[a + 1]; e = tubes.tube_begin[tubes.tube_of(e) + 1])
      out.radius.push_back(radius);
    for (int b = a + 1; b < topology.tubes(); ++b) {
      if ((middle(b) - middle(a)).norm() > neighbour_radius) continue;
      out.neighbours.emplace_back(a, b);
      for (int k = 0; k < n; ++k) out.offset.push_back(ahead(topology, start, a, b, k));
    }
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < topology.tubes(); ++t)
    if (shells.internal[static_cast<std::size_t>(t)])
      nearest = std::min(nearest, radii[static_cast<std::size_t>(t)]);
  for (int t = 0; t < topology.tubes(); ++t)
    if (shells.internal[static_cast<std::size_t>(t)] &&
        radii[static_cast<std::size_t>(t)] < nearest + 0.1 * spacing)
      out.core.push_back(t);
  return out;
}

LoadingReference of_parts(LoadingReference reference, const Topology& whole, const Topology& parts) {
  if (reference.radius.empty()) return reference;
  std::vector<double> radius;
  for (int t = 0; t < parts.tubes(); ++t)
    radius.push_back(reference.radius[static_cast<std::size_t>(whole.tube_of(parts.tube_begin[t]))]);
  reference.radius = std::move(radius);
  return reference;
}

std::vector<double> tensions(const Topology& topology, const State& state, int tube) {
  std::vector<double> out;
  const TubeType& type = topology.type_of(tube);
  for (int e = topology.tube_begin[tube]; e + 1 < topology.tube_begin[tube + 1]; ++e) {
    const auto i = static_cast<std::size_t>(e), j = i + 1;
    const Vector3 d = state.position[j] - state.position[i];
    if (has_parted(type, d)) {
      out.push_back(0);
      continue;
    }
    const BondForce f = bond_energy_and_gradient(type.bond, type.element_length, d, frame_of(state.orientation[i]),
                                                 frame_of(state.orientation[j]));
    out.push_back(-f.force_j.dot(d.normalized()));
  }
  return out;
}

TubePressures::TubePressures(const Topology& topology, const State& state, const ContactLaw& law,
                             std::vector<double> cells)
    : topology_(topology),
      state_(state),
      law_(law),
      cells_(std::move(cells)),
      grid_(state.position, law.cutoff()) {}

double TubePressures::of(int tube) const {
  constexpr int most = 8;  // elements
  const int n = topology_.length_of(tube), count = std::min(most, n - 2 * (n / 3)), from = (n - count) / 2;
  // Tubes in line with it do not touch its side.
  const auto [first, last] = topology_.strand_of(tube);
  const int in_line_from = topology_.tube_begin[static_cast<std::size_t>(first)],
            in_line_to = topology_.tube_begin[static_cast<std::size_t>(last) + 1];
  double virial = 0;
  std::vector<int> near;
  for (int i = topology_.tube_begin[static_cast<std::size_t>(tube)] + from, to = i + count; i < to; ++i) {
    const std::size_t found = grid_.find(i, -1, near);
    std::sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(found));
    const Vector3 x = state_.position[static_cast<std::size_t>(i)],
                  t = axis_of(state_.orientation[static_cast<std::size_t>(i)]);
    for (std::size_t k = 0; k < found; ++k) {
      if (in_line_from <= near[k] && near[k] < in_line_to) continue;
      const auto j = static_cast<std::size_t>(near[k]);
      const TypePair types{topology_.tube_type[static_cast<std::size_t>(tube)],
                           topology_.tube_type[static_cast<std::size_t>(topology_.tube_of(near[k]))]};
      const Vector3 d = state_.position[j] - x,
                    force = law_.force(types, d, t, axis_of(state_.orientation[j])).force_j;
      virial += force.dot(d) - force.dot(t) * d.dot(t);
    }
  }
  const double cell = cells_[static_cast<std::size_t>(topology_.tube_type[static_cast<std::size_t>(tube)])];
  return virial / (4 * cell * count * topology_.type_of(tube).element_length);
}

std::vector<double> tube_pressures(const Topology& topology, const State& state,
                                   const LoadingReference& reference) {
  std::vector<double> out(static_cast<std::size_t>(topology.tubes()));
  const TubePressures pressures(topology, state, *reference.law, reference.cells);
  for_each_uneven(topology.tubes(), 1, true, [&](int t) { out[static_cast<std::size_t>(t)] = pressures.of(t); });
  return out;
}

std::vector<TubeLoading> tube_loadings(const Topology& topology, const State& state,
                                       const LoadingReference& reference) {
  std::vector<TubeLoading> out(static_cast<std::size_t>(topology.tubes()));
  const std::vector<double> pressures =
      reference.knows_pressures() ? tube_pressures(topology, state, reference) : std::vector<double>();
  for_each_uneven(topology.tubes(), 1, true, [&](int t) {
    TubeLoading& tube = out[static_cast<std::size_t>(t)];
    const std::vector<double> pulls = tensions(topology, state, t);
    tube.tension = mean_of_middle(pulls);
    for (const double pull : pulls)
      if (std::fabs(pull) > std::fabs(tube.most_tension)) tube.most_tension = pull;
    tube.twist = twist_of(topology, state, t);
    tube.curvature = largest_curvature(topology, state, t);
    if (!pressures.empty()) tube.pressure = pressures[static_cast<std::size_t>(t)];
  });
  if (!knows_slip(topology, reference))
    for (TubeLoading& tube : out) tube.slip = none;
  const Topology strands = strands_of(topology);
  const std::vector<double> slipped = slips(strands, state, reference);
  for (std::size_t k = 0; k < slipped.size(); ++k)
    for (const int s : {reference.neighbours[k].first, reference.neighbours[k].second})
      for (int e = strands.tube_begin[s]; e < strands.tube_begin[s + 1];) {
        const int t = topology.tube_of(e);
        out[static_cast<std::size_t>(t)].slip = std::max(out[static_cast<std::size_t>(t)].slip, slipped[k]);
        e = topology.tube_begin[t + 1];
      }
  return out;
}

Loading loading(const Topology& topology, const State& state, const LoadingReference& reference) {
  Loading out;
  out.ends_apart = (centre_of(topology, state, reference.ends[upper_end]) -
                    centre_of(topology, state, reference.ends[lower_end]))
                       .norm();
  const double free = reference.ends_apart - within(topology, reference.ends[lower_end]) -
                      within(topology, reference.ends[upper_end]);
  out.strain = free > 0 ? (out.ends_apart - reference.ends_apart) / free : 0;
  if (topology.groups.images > 0) {
    out.ends_apart = slice_length(topology, state);
    out.strain = out.ends_apart / topology.groups.period - 1;
  }
  for (int t = 0; t < topology.tubes(); ++t) {
    const double tension = mean_of_middle(tensions(topology, state, t));
    out.least_tension = t == 0 ? tension : std::min(out.least_tension, tension);
    out.most_tension = t == 0 ? tension : std::max(out.most_tension, tension);
    out.curvature = std::max(out.curvature, largest_curvature(topology, state, t));
  }
  const Topology strands = strands_of(topology);
  for (const double slip : slips(strands, state, reference)) out.slip = std::max(out.slip, slip);
  if (!knows_slip(topology, reference)) out.slip = none;
  out.core_pressure = none;
  if (reference.knows_pressures() && !reference.core.empty()) {
    out.core_pressure = 0;
    const TubePressures pressures(topology, state, *reference.law, reference.cells);
    // Mean over the tubes in the middle of these strands.
    for (const int s : reference.core)
      out.core_pressure += pressures.of(topology.tube_of(strands.tube_begin[s] + strands.length_of(s) / 2)) /
                           static_cast<double>(reference.core.size());
  }
  return out;
}

}  // namespace ropewalk
