#include "plan/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace ropewalk {
namespace {

// Bends and twists of the bonds at the start, per length.
void bond_features(const Topology& topology, const State& s, SceneFeatures& f) {
  for (int t = 0; t < topology.tubes(); ++t) {
    const double a = topology.type_of(t).element_length;
    for (int e = topology.tube_begin[t]; e + 1 < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Frame fi = frame_of(s.orientation[i]), fj = frame_of(s.orientation[i + 1]);
      f.curvature = std::max(f.curvature, 2 * std::asin(std::min(0.5 * (fi.t - fj.t).norm(), 1.0)) / a);
      f.twist = std::max(f.twist, std::fabs(bond_twist_angle(fi, fj)) / a);
    }
  }
}

// Distance of the farthest tube from the line through the mean of all, at the start.
double rope_radius(const Prepared& p) {
  // At the lower end: the middle of a rope that begins bent aside is not its axis.
  const auto end_of = [&](int tube) -> Vector3 {
    return p.state.position[static_cast<std::size_t>(p.topology.tube_begin[tube])];
  };
  Vector3 mean = Vector3::Zero();
  int strands = 0;
  for (int t = 0; t < p.topology.tubes(); ++t)
    if (p.topology.begins_strand(t)) mean += end_of(t), ++strands;
  double largest = 0;
  for (int t = 0; t < p.topology.tubes(); ++t)
    if (p.topology.begins_strand(t)) largest = std::max(largest, (end_of(t) - mean / strands).head<2>().norm());
  return largest;
}

// The rope as a whole turned by `twist` per length.
void add_rope_twist(const Prepared& p, double twist, SceneFeatures& f) {
  const double radius = p.topology.tubes() > 1 ? rope_radius(p) : 0.0, slope = radius * twist;
  const double bend = slope * twist / (1 + slope * slope);
  f.twist += twist;
  f.turn += twist;
  f.curvature += bend;
}

// Twist phi (rad/nm) of a rope in equilibrium, if `moment` M (eV) acts on each tube and the rope's length is free:
// M = GJ phi + EA Var(rho^2) phi^3/2, rho the distance of a tube from the axis.
double resting_twist(const Prepared& p, double moment, bool geometric_only) {
  const BondStiffness& k = p.topology.types[0].bond;
  double mean = 0, mean2 = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    mean += rho2 / p.topology.tubes();
    mean2 += rho2 * rho2 / p.topology.tubes();
  }
  const double cubic = geometric_only ? 0 : 0.5 * k.stretch * (mean2 - mean * mean);
  double low = 0, high = moment / k.twist;
  for (int step = 0; step < 60; ++step) {
    const double phi = 0.5 * (low + high);
    (k.twist * phi + cubic * phi * phi * phi < moment ? low : high) = phi;
  }
  return low;
}

void add_load(const LoadEffect& load, const Prepared& p, SceneFeatures& f) {
  const BondStiffness& k = p.topology.types[0].bond;
  if (load.force > 0) {
    const double bend = load.force * f.length / k.bend;
    f.curvature += bend;
  }
  if (load.torque != Vector3::Zero()) {
    const double along = std::fabs(load.torque.z()) / k.twist, across = load.torque.head<2>().norm() / k.bend;
    f.curvature += across;
    if (along > 0) add_rope_twist(p, along, f);
  }
  if (load.twist > 0) add_rope_twist(p, load.twist, f);
  const bool loaded = load.force > 0 || load.torque != Vector3::Zero();
  f.sudden = f.sudden || (loaded && load.ramp <= 0);
  f.ramp = std::max(f.ramp, load.ramp);
}

// Adds the demands of clamps: pulling, bending, stretching where the rope is turned at a length that is held, and
// the bending of tilted tubes where a clamp keeps them straight, over the length sqrt(EI/T), T the tension of a
// tube.
void add_clamps(const Prepared& p, SceneFeatures& f) {
  const BondStiffness& k = p.topology.types[0].bond;
  EndElements clamped;
  for (const auto& load : p.loads)
    if (const auto effect = load->effect(); effect && effect->clamp) load->add_ends(clamped);
  std::array<std::set<int>, 2> tubes;
  for (const End end : {lower_end, upper_end})
    for (const int e : clamped[end]) tubes[end].insert(p.topology.tube_of(e));
  const bool between = std::any_of(tubes[lower_end].begin(), tubes[lower_end].end(),
                                   [&](int t) { return tubes[upper_end].count(t) > 0; });
  double pulled = 0, bent = 0, tension = 0;
  bool held = between, straight = false;
  for (const auto& load : p.loads) {
    const std::optional<LoadEffect> effect = load->effect();
    if (!effect || !effect->clamp) continue;
    if (between) pulled += effect->clamp->pull;
    bent += effect->clamp->bend;
    tension = std::max(tension, effect->clamp->tension);
    held = held && effect->clamp->keeps_length;
    straight = straight || effect->clamp->keeps_tilt;
  }
  f.between_clamps = between;
  f.length_held = held;
  // Pressed ends strain a rope until it bends aside. A solid column between two clamps buckles at this strain
  // (Euler), and a rope of tubes that slide buckles earlier.
  const double column = std::pow(units::pi * (rope_radius(p) + p.topology.largest_radius()) / f.length, 2);
  f.strain +=
      std::max(pulled, 0.0) / f.length + std::min(std::max(-pulled, 0.0) / f.length, column) + tension / k.stretch;
  f.curvature += bent / f.length;
  if (bent > 0) {
    f.strain += rope_radius(p) * bent / f.length;
  }
  if (f.tubes > 1 && f.turn > 0) {
    const double slope = rope_radius(p) * f.turn;
    if (held) {
      f.strain += std::sqrt(1 + slope * slope) - 1;
      tension = std::max(tension, k.stretch * f.strain);
      if (f.tubes > 6)
        f.pressure = k.stretch / (0.5 * std::sqrt(3.0) * p.spacing * p.spacing) * std::pow(slope, 4) / 8;
    }
    if (straight) {
      const double bend = slope * std::sqrt(tension / k.bend);
      f.curvature = std::max(f.curvature, bend);
    }
  }
}

}  // namespace

SceneFeatures features_of(const Scene& scene, const Prepared& p) {
  SceneFeatures f;
  f.tubes = p.topology.tubes();
  f.contact = p.interaction.has_contact() && f.tubes > 1;
  for (int t = 0; t < p.topology.tubes(); ++t) f.length = std::max(f.length, free_length(scene, p.topology, t));
  bond_features(p.topology, p.state, f);
  for (const auto& load : p.loads) {
    const std::optional<LoadEffect> effect = load->effect();
    if (!effect) continue;
    add_load(*effect, p, f);
    f.turned += effect->angle;
    f.turning += effect->turning;
  }
  if (f.turned > 0) add_rope_twist(p, f.turned / f.length, f);
  add_clamps(p, f);
  if (const MomentRamp* ramp = scene.moment_ramp()) {
    const double each = ramp->of_each(f.tubes), turn_before = f.turn;
    add_rope_twist(p, each / p.topology.types[0].bond.twist, f);
    f.turn = turn_before + resting_twist(p, each, ramp->geometric_only);
    f.sudden = f.sudden || ramp->rate <= 0;
    f.ramp = ramp->ramp_time();
  }
  if (scene.start.temperature > 0) {
    const TubeType& t = p.topology.types[0];
    const double kt = units::boltzmann * scene.start.temperature;
    const double bend = std::sqrt(kt / (t.bond.bend * t.element_length)),
                 twist = std::sqrt(kt / (t.bond.twist * t.element_length));
    f.curvature += bend;
    f.twist += twist;
  }
  return f;
}

}  // namespace ropewalk
