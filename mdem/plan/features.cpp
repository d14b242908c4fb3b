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
      const Frame<double> fi = frame_of(s.orientation[i]), fj = frame_of(s.orientation[i + 1]);
      f.curvature = std::max(f.curvature, 2 * std::asin(std::min(0.5 * (fi.t - fj.t).norm(), 1.0)) / a);
      f.twist = std::max(f.twist, std::fabs(bond_twist_angle(fi, fj)) / a);
    }
  }
}

// Distance of the farthest tube from the line through the mean of all, at the start.
double rope_radius(const Prepared& p) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t i = 0; i < p.state.size(); ++i)
    mean += p.state.position[i] / static_cast<double>(p.state.size());
  double largest = 0;
  for (std::size_t i = 0; i < p.state.size(); ++i)
    largest = std::max(largest, (Vector3(p.state.position[i]) - mean).head<2>().norm());
  return largest;
}

double longest_tube(const Topology& t) {
  double longest = 0;
  for (int k = 0; k < t.tubes(); ++k) longest = std::max(longest, t.length_of(k) * t.type_of(k).element_length);
  return longest;
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
    const double bend = load.force * longest_tube(p.topology) / k.bend;
    f.curvature += bend;
  }
  if (load.torque != Vector3::Zero()) {
    const double along = std::fabs(load.torque.z()) / k.twist, across = load.torque.head<2>().norm() / k.bend;
    f.curvature += across;
    if (along > 0) add_rope_twist(p, along, f);
  }
  const bool loaded = load.force > 0 || load.torque != Vector3::Zero();
  f.sudden = f.sudden || (loaded && load.ramp <= 0);
  f.ramp = std::max(f.ramp, load.ramp);
}

// Tubes that clamps hold at both ends.
bool any_tube_between_grips(const Prepared& p) {
  std::array<std::set<int>, 2> tubes;
  for (const GripLoad* grip : p.loads.of<GripLoad>())
    for (const int e : grip->elements) tubes[grip->end].insert(p.topology.tube_of(e));
  return std::any_of(tubes[0].begin(), tubes[0].end(), [&](int t) { return tubes[1].count(t) > 0; });
}

// Adds the demands of clamps: pulling, bending, stretching where the rope is turned at a length that is held, and the
// bending of tilted tubes where a clamp keeps them straight, over the length sqrt(EI/T), T the tension of a tube.
void grip_features(const Prepared& p, SceneFeatures& f) {
  const BondStiffness& k = p.topology.types[0].bond;
  const bool between = any_tube_between_grips(p);
  double pulled = 0, bent = 0, tension = 0;
  bool held = between, straight = false;
  for (const GripLoad* grip : p.loads.of<GripLoad>()) {
    const GripAxis::Is z = grip->axes[GripLoad::z].is;
    const double shared = grip->each ? 1 : static_cast<double>(grip->elements.size()) / grip->depth;
    if (z == GripAxis::Is::moved && between) pulled += grip->schedule(GripLoad::z).largest();
    if (z == GripAxis::Is::loaded) tension = std::max(tension, grip->schedule(GripLoad::z).largest() / shared);
    held = held && z != GripAxis::Is::free && z != GripAxis::Is::loaded && !grip->slide_free;
    straight = straight || !grip->tilt_free;
    for (const std::size_t about : {std::size_t{3}, std::size_t{4}})
      if (grip->axes[about].is == GripAxis::Is::moved) bent += grip->schedule(about).largest();
  }
  f.strain += pulled / f.length + tension / k.stretch;
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
  f.length = longest_tube(p.topology);
  bond_features(p.topology, p.state, f);
  double turned = 0;
  for (const SceneLoad& load : scene.loads) {
    const std::optional<LoadEffect> effect = load.load->effect();
    if (!effect) continue;
    add_load(*effect, p, f);
    turned += effect->angle;
  }
  for (const GripLoad* grip : p.loads.of<GripLoad>()) {
    const LoadEffect effect = *grip->effect();
    add_load(effect, p, f);
    turned += effect.angle;
  }
  if (turned > 0) add_rope_twist(p, turned / f.length, f);
  for (const PeriodicLoad* slice : p.loads.of<PeriodicLoad>()) {
    add_rope_twist(p, slice->schedule().largest(), f);
    f.ramp = std::max(f.ramp, slice->schedule().ends());
  }
  grip_features(p, f);
  if (scene.twist) {
    const TwistLoad& w = *scene.twist;
    const double each = w.reading == TwistLoad::Reading::per_tube ? w.moment : w.moment / f.tubes;
    const double alone = each / p.topology.types[0].bond.twist, turn_before = f.turn;
    add_rope_twist(p, alone, f);
    f.turn = turn_before + resting_twist(p, each, w.geometric_only);
    f.sudden = f.sudden || w.rate <= 0;
    f.ramp = w.ramp_time();
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
