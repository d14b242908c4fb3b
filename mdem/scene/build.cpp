#include "scene/build.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/parameters_toml.hpp"
#include "model/counter_random.hpp"
#include "model/error.hpp"
#include "observe/centre_line.hpp"
#include "scene/maxwell.hpp"
#include "scene/memory_size.hpp"
#include "scene/packing.hpp"
#include "scene/scene_place.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/spacing.hpp"
#include "scene/wound.hpp"

namespace ropewalk {
namespace {

constexpr double viscosity_reach = 1.5;  // spacings

// For each tube the first one that is a piece of the same tube: in a slice a tube and its images are one.
std::vector<int> one_tube(const Topology& topology) {
  std::vector<int> first(static_cast<std::size_t>(topology.tubes()));
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&](int t) {
    while (first[static_cast<std::size_t>(t)] != t) t = first[static_cast<std::size_t>(t)];
    return t;
  };
  for (int e = 0; topology.groups.images > 0 && e < topology.elements(); ++e) {
    const int a = root(topology.tube_of(e)), b = root(topology.tube_of(topology.original_of(e)));
    first[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  for (int t = 0; t < topology.tubes(); ++t) first[static_cast<std::size_t>(t)] = root(t);
  return first;
}

// Each tube by itself: a share is met in the mean.
void draw_tube_types(const Scene& scene, Topology& topology) {
  const std::vector<int> one = one_tube(topology);
  for (int t = 0; t < topology.tubes(); ++t) {
    const auto number = static_cast<std::uint32_t>(one[static_cast<std::size_t>(t)]);
    double left = unit_interval(philox({number, 0, 0, 0}, scene.start.seed)[0]);
    std::size_t type = 0;
    while (type + 1 < scene.type_shares.size() && left > scene.type_shares[type]) left -= scene.type_shares[type++];
    topology.tube_type[static_cast<std::size_t>(t)] = static_cast<int>(type);
  }
}

void set_tube_types(const Scene& scene, Topology& topology) {
  if (!scene.type_shares.empty()) draw_tube_types(scene, topology);
  if (scene.tube_types.empty()) return;
  const int tubes = topology.tubes(), strands = topology.strands(),
            typed = static_cast<int>(scene.tube_types.size());
  if (typed != tubes && typed != strands)
    throw InputError(place_in(scene, "tube_types"),
                     fmt::format("has {} numbers, and the scene has {} tubes{}", typed, tubes,
                                 strands < tubes ? fmt::format(" in {} strands", strands) : ""),
                     strands < tubes ? "write one for each strand or for each tube" : "write one for each tube");
  if (typed == tubes) {
    topology.tube_type = scene.tube_types;
    const std::vector<int> one = one_tube(topology);
    for (std::size_t t = 0; t < one.size(); ++t)
      if (topology.tube_type[t] != topology.tube_type[static_cast<std::size_t>(one[t])])
        throw InputError(
            place_in(scene, "tube_types"),
            fmt::format("gives tubes {} and {} different types, and they are pieces of one tube of the "
                        "slice",
                        one[t], t),
            "write one for each strand, or give both the same type");
    return;
  }
  for (int t = 0, strand = -1; t < tubes; ++t) {
    strand += topology.begins_strand(t);
    topology.tube_type[static_cast<std::size_t>(t)] = scene.tube_types[static_cast<std::size_t>(strand)];
  }
}

// Moves each strand as a whole until strands touch, each as thick as its thickest tube.
void draw_strands_together(const Scene& scene, const ContactLaw* law, double spacing, const Topology& topology,
                           State& state) {
  const auto& types = topology.tube_type;
  const bool unlike = std::any_of(types.begin(), types.end(), [&](int type) { return type != types.front(); });
  if (!scene.source->draws_together(unlike)) return;
  const double typed = spacing / parallel_spacing(scene, law);
  const std::size_t kinds = scene.sets.size();
  std::vector<std::vector<double>> apart(kinds, std::vector<double>(kinds));
  for (std::size_t i = 0; i < kinds; ++i)
    for (std::size_t j = 0; j < kinds; ++j)
      apart[i][j] = typed * pair_spacing(scene, law, {static_cast<int>(i), static_cast<int>(j)});
  std::vector<Disc> discs;
  std::vector<int> strand_of(static_cast<std::size_t>(topology.tubes()));
  for (int t = 0; t < topology.tubes(); ++t) {
    const auto type = static_cast<std::size_t>(types[static_cast<std::size_t>(t)]);
    if (topology.begins_strand(t)) {
      const Vector3 at = state.position[static_cast<std::size_t>(topology.tube_begin[t])];
      discs.push_back({at.x(), at.y(), static_cast<int>(type)});
    }
    Disc& disc = discs.back();
    if (scene.sets[type].radius > scene.sets[static_cast<std::size_t>(disc.type)].radius)
      disc.type = static_cast<int>(type);
    strand_of[static_cast<std::size_t>(t)] = static_cast<int>(discs.size()) - 1;
  }
  const std::vector<Disc> before = discs;
  draw_together(discs, apart);
  for (int e = 0; e < topology.elements(); ++e) {
    const auto s = static_cast<std::size_t>(strand_of[static_cast<std::size_t>(topology.tube_of(e))]);
    state.position.add(static_cast<std::size_t>(e), Vector3(discs[s].x - before[s].x, discs[s].y - before[s].y, 0));
  }
}

// The mean of the first elements, or of the last ones, of all tubes.
Vector3 end_of(const Topology& topology, const State& state, bool last) {
  Vector3 sum = Vector3::Zero();
  for (int t = 0; t < topology.tubes(); ++t)
    sum += state.position[static_cast<std::size_t>(last ? topology.tube_begin[t + 1] - 1 : topology.tube_begin[t])];
  return sum / topology.tubes();
}

// A rope of a state file, wound or not: every section of it is moved and leans as one, across the chord and as near
// to x as that allows.
void add_wave_to_rope(const Scene& scene, const Topology& topology, State& state) {
  const Vector3 from = end_of(topology, state, false), chord = end_of(topology, state, true) - from;
  const double length = chord.norm();
  if (topology.tubes() == 0 || !run_the_same_way(topology, state) || !(length > 0) ||
      !(normal_part(Vector3::UnitX(), chord / length).norm() > 0.1))
    throw InputError(place_in(scene, "start.wave_nm"), "is for tubes that stand upright side by side",
                     "take it away, or bend the tubes of the state file");
  const Vector3 along = chord / length, aside = normal_part(Vector3::UnitX(), along).normalized();
  const double k = scene.start.half_waves * units::pi / length;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const double phase = k * (state.position[i] - from).dot(along);
    state.position.add(i, scene.start.wave * std::sin(phase) * aside);
    const Quaternion lean(
        Eigen::AngleAxisd(std::atan(scene.start.wave * k * std::cos(phase)), along.cross(aside).normalized()));
    state.orientation.set(i, lean * state.orientation[i]);
  }
}

// u = A sin(pi n z/L) along x from the first to the last element, which lean as the line does.
void add_wave(const Scene& scene, const Topology& topology, State& state) {
  if (!(scene.start.wave > 0)) return;
  if (!scene.source->is_parallel()) {
    add_wave_to_rope(scene, topology, state);
    return;
  }
  for (int t = 0; t < topology.tubes(); ++t) {
    const int first = topology.tube_begin[t], last = topology.tube_begin[t + 1] - 1;
    const double z0 = state.position.z[first], length = state.position.z[last] - z0;
    const double k = scene.start.half_waves * units::pi / std::max(length, 1e-9);
    for (int e = first; e <= last; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const double phase = k * (state.position.z[i] - z0);
      state.position.x[i] += scene.start.wave * std::sin(phase);
      const Quaternion lean(Eigen::AngleAxisd(std::atan(scene.start.wave * k * std::cos(phase)), Vector3::UnitY()));
      state.orientation.set(i, lean * state.orientation[i]);
    }
  }
}

// Tubes that begin in helices about the axis of the rope.
void wind(const Scene& scene, State& state) {
  if (scene.start.turn == 0) return;
  if (!scene.source->is_parallel())
    throw InputError(place_in(scene, "start.twist_deg_per_nm"), "is for straight tubes side by side",
                     "take it away, or a [rope]");
  if (scene.start.wave > 0)
    throw InputError(place_in(scene, "start.twist_deg_per_nm"), "and wave_nm do not go together",
                     "bend the rope that this one has become: [state] with wave_nm");
  double rim = 0;
  for (std::size_t i = 0; i < state.size(); ++i)
    rim = std::max(rim, std::hypot(state.position.x[i], state.position.y[i]));
  if (const double slope = rim * std::fabs(scene.start.turn); slope > 1)
    throw InputError(
        place_in(scene, "start.twist_deg_per_nm"),
        fmt::format("lays the outermost tubes at {:.3g} degrees to the axis", std::atan(slope) / units::degree),
        fmt::format("at most 45 degrees, {:.3g} deg/nm, can be built", 1 / rim / units::degree));
  state = wound(state, scene.start.turn);
}

// Filaments that the program places itself are twisted along as they are at rest. A natural curvature starts straight.
void twist_along(const Scene& scene, const Topology& topology, State& state) {
  if (scene.from_file()) return;
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    if (type.bond.natural.z == 0) continue;
    const int first = topology.tube_begin[t];
    for (int e = first; e < topology.tube_begin[t + 1]; ++e) {
      const double angle = (e - first) * type.element_length * type.bond.natural.z;
      const auto i = static_cast<std::size_t>(e);
      state.orientation.set(i, state.orientation[i] * Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitZ())));
    }
  }
}

void refuse_natural_shape(const Scene& scene) {
  for (const ParameterSet& set : scene.sets) {
    if (const std::string turned = too_turned(set.bond, scene.element_length); !turned.empty())
      throw InputError(place_in(scene, "element_length_nm"), turned, longest_for(set.bond));
    if (scene.has_ends(Drive::Ends::endless) && vector(set.bond.natural).norm() > 0)
      throw InputError(place_in(scene, "periodic"),
                       fmt::format("needs tubes that are straight at rest, and {} has a natural shape", set.name),
                       "take a rope with ends, or leave the natural shape out of the set");
  }
}

// Refuses state files that lack what the rest of the scene needs.
void check_state(const Scene& scene, const BuiltScene& built) {
  if (scene.start.temperature > 0 && built.state.size() < 2)
    throw InputError(place_in(scene, "start.temperature_K"),
                     "one element alone has no thermal motion about its centre", "take 0");
  const auto moves = [](const Vec3Array& v, std::size_t i) { return !v[i].isZero(0); };
  for (std::size_t i = 0; scene.start.temperature > 0 && i < built.state.size(); ++i)
    if (moves(built.state.velocity, i) || moves(built.state.angular_velocity, i))
      throw InputError(place_in(scene, "start.temperature_K"),
                       fmt::format("would replace the velocities of {}", scene.source->file()),
                       "take it away, or the last six columns of the file");
}

// As of so many elements of each strand as the contact reaches.
void set_period_inertia(double reach, Topology& topology) {
  const Topology strands = strands_of(topology);
  for (int s = 0; topology.groups.images > 0 && s < strands.tubes(); ++s) {
    const TubeType& type = strands.type_of(s);
    topology.groups.period_inertia += std::max(1, type.elements_within(reach)) * type.mass;
  }
}

}  // namespace

BuiltScene build(Scene& scene) {
  BuiltScene out;
  refuse_natural_shape(scene);
  out.topology = empty_topology(scene);
  out.law = contact_law(scene);
  out.spacing =
      scene.source->typed_spacing() > 0 ? scene.source->typed_spacing() : parallel_spacing(scene, out.law.get());
  scene.damping.contact.inner = out.spacing;
  scene.damping.contact.outer = viscosity_reach * out.spacing;
  if (scene.has_ends(Drive::Ends::endless)) {
    const double reach = interaction_of(scene, out.law).cutoff() + scene.source->slides();
    for (const auto& drive : scene.drives)
      out.topology.groups.images =
          std::max(out.topology.groups.images, drive->images(reach / scene.element_length));
  }
  Random random(scene.start.seed);
  scene.source->place(scene, out.spacing, random, out.topology, out.state);
  scene.memory = scene.source->memory();
  scene.lineage = lineage_key(scene.start.stream, scene.memory.lineage);
  if (const std::string memory = beyond_memory(out.topology.elements()); !memory.empty())
    throw InputError(place_in(scene, scene.kind),
                     fmt::format("holds {} elements, {}", out.topology.elements(), memory),
                     "take fewer elements, or another machine");
  set_tube_types(scene, out.topology);
  set_period_inertia(interaction_of(scene, out.law).cutoff(), out.topology);
  draw_strands_together(scene, out.law.get(), out.spacing, out.topology, out.state);
  twist_along(scene, out.topology, out.state);
  wind(scene, out.state);
  add_wave(scene, out.topology, out.state);
  out.topology.groups.ends_meet = ends_meet(scene, out.topology);
  set_collapse(scene, out.topology);
  check_state(scene, out);
  if (scene.lineage != 0) random = Random(lineage_key(scene.start.seed, scene.lineage));
  if (scene.start.temperature > 0) set_thermal_velocities(out.topology, scene.start.temperature, random, out.state);
  return out;
}

}  // namespace ropewalk
