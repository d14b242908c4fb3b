#include "plan/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/dynamics/end_drives.hpp"

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

// Twist phi (rad/nm) of a rope in equilibrium, if `moment` M (eV) acts on each tube, rho being the distance of a
// tube from the axis: M = GJ phi + EA Var(rho^2) phi^3/2, with the mean of rho^4 for the variance where the length
// is held.
double resting_twist(const Prepared& p, double moment, bool relaxes_spins, bool length_held) {
  const BondStiffness& k = p.topology.types[0].bond;
  double mean = 0, mean2 = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    mean += rho2 / p.topology.tubes();
    mean2 += rho2 * rho2 / p.topology.tubes();
  }
  const double cubic = relaxes_spins ? 0 : 0.5 * k.stretch * (mean2 - (length_held ? 0 : mean * mean));
  double low = 0, high = moment / k.twist;
  for (int step = 0; step < 60; ++step) {
    const double phi = 0.5 * (low + high);
    (k.twist * phi + cubic * phi * phi * phi < moment ? low : high) = phi;
  }
  return low;
}

// The longest of several courses tells when a limit is passed.
void add_course(const Schedule& course, SceneFeatures& f) {
  if (course.reaches() > f.course.reaches()) f.course = course;
}

// A load on elements that are no ends.
void add_load(const LoadEffect& load, const Prepared& p, SceneFeatures& f) {
  const BondStiffness& k = p.topology.types[0].bond;
  std::array<double, 6> most{};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const LoadComponent& c = load.axes[axis];
    if (c.is == LoadComponent::Is::free || c.is == LoadComponent::Is::held) continue;
    add_course(c.course, f);
    if (c.is == LoadComponent::Is::loaded) most[axis] = c.course.largest();
    if (c.is == LoadComponent::Is::loaded && c.course.reaches() <= 0) f.sudden = true;
  }
  f.curvature +=
      Vector3(most[0], most[1], most[2]).norm() * f.length / k.bend + std::hypot(most[3], most[4]) / k.bend;
  if (most[LoadEffect::about_z] > 0) add_rope_twist(p, most[LoadEffect::about_z] / k.twist, f);
  if (const LoadComponent& turn = load.axes[LoadEffect::about_z];
      turn.is == LoadComponent::Is::moved && turn.course.largest() > 0)
    add_rope_twist(p, turn.course.largest() / f.length, f);
}

// Tubes of a film lie across z, where a force along z bends them.
bool stand_upright(const State& s) {
  double sum = 0;
  for (std::size_t i = 0; i < s.size(); ++i) sum += std::fabs(axis_of(s.orientation[i]).z());
  return sum > 0.5 * static_cast<double>(s.size());
}

// Forces and couples on each tube of an end. Two ends that are loaded balance one another, and the larger counts.
void add_end_loads(const EndDrives& drives, const Prepared& p, SceneFeatures& f) {
  const BondStiffness& k = p.topology.types[0].bond;
  std::array<double, 6> most{};
  for (std::size_t axis = 0; axis < 6; ++axis)
    for (const End end : {lower_end, upper_end}) {
      const Schedule course = load_of_each(drives, end, axis);
      if (!(course.largest() > 0)) continue;
      most[axis] = std::max(most[axis], course.largest());
      add_course(course, f);
      f.sudden = f.sudden || course.reaches() <= 0;
    }
  if (stand_upright(p.state)) std::swap(f.tension, most[LoadEffect::z]);
  f.curvature +=
      Vector3(most[0], most[1], most[2]).norm() * f.length / k.bend + std::hypot(most[3], most[4]) / k.bend;
  f.strain += f.tension / k.stretch;
  if (!(most[LoadEffect::about_z] > 0)) return;
  const double turn_before = f.turn;
  const std::optional<EndMoment> moment = end_moment(drives);
  add_rope_twist(p, most[LoadEffect::about_z] / k.twist, f);
  f.turn =
      turn_before + resting_twist(p, most[LoadEffect::about_z], moment && moment->relaxes_spins, f.length_held);
}

// Displacements and rotations of one end against the other.
void add_end_motion(const EndDrives& drives, const Prepared& p, SceneFeatures& f) {
  double bent = 0;
  for (const EndDrive& d : drives)
    for (std::size_t axis = 3; axis < LoadEffect::about_z; ++axis)
      if (d.does.axes[axis].is == LoadComponent::Is::moved) {
        bent += d.does.axes[axis].course.largest();
        add_course(d.does.axes[axis].course, f);
      }
  f.curvature += bent / f.length;
  f.strain += rope_radius(p) * bent / f.length;
  const Schedule turned = moved_apart(drives, LoadEffect::about_z), pulled = moved_apart(drives, LoadEffect::z);
  add_course(turned, f);
  add_course(pulled, f);
  f.turned = turned.largest();
  f.turning = turned.fastest();
  const double length = p.topology.groups.images > 0 ? p.topology.groups.period : f.length;
  if (f.turned > 0) add_rope_twist(p, f.turned / length, f);
  if (!is_kept_between(drives, LoadEffect::z)) return;
  // Pressed ends strain a rope until it bends aside. A solid column between two clamps buckles at this strain
  // (Euler), and a rope of tubes that slide buckles earlier.
  const double column = std::pow(units::pi * (rope_radius(p) + p.topology.largest_radius()) / f.length, 2),
               part = pulled.largest() / f.length;
  const bool presses = std::none_of(pulled.points().begin(), pulled.points().end(),
                                    [](const Schedule::Point& point) { return point.value > 0; });
  f.strain += presses ? std::min(part, column) : part;
}

// What a turned rope demands whose length is held, and the bending of tilted tubes where an end keeps them
// straight, over the length sqrt(EI/T), T the tension of a tube.
void add_demands_of_turn(const EndDrives& drives, const Prepared& p, SceneFeatures& f) {
  if (f.tubes < 2 || !(f.turn > 0) || p.topology.groups.images > 0) return;
  const BondStiffness& k = p.topology.types[0].bond;
  const double slope = rope_radius(p) * f.turn;
  double tension = f.tension;
  if (f.length_held) {
    f.strain += std::sqrt(1 + slope * slope) - 1;
    tension = std::max(tension, k.stretch * f.strain);
    if (f.tubes > 6)
      f.pressure = k.stretch / (0.5 * std::sqrt(3.0) * p.spacing * p.spacing) * std::pow(slope, 4) / 8;
  }
  if (std::any_of(drives.begin(), drives.end(), [](const EndDrive& d) { return d.does.keeps_tilt; }))
    f.curvature = std::max(f.curvature, slope * std::sqrt(tension / k.bend));
}

}  // namespace

SceneFeatures features_of(const Scene& scene, const Prepared& p) {
  SceneFeatures f;
  f.tubes = p.topology.tubes();
  f.contact = p.interaction.has_contact() && f.tubes > 1;
  for (int t = 0; t < p.topology.tubes(); ++t) f.length = std::max(f.length, free_length(scene, p.topology, t));
  bond_features(p.topology, p.state, f);
  const EndDrives drives = end_drives(p.loads, p.topology);
  f.turned_between = is_kept_between(drives, LoadEffect::about_z);
  f.length_held = is_kept_between(drives, LoadEffect::z);
  f.prescribes_moment = end_moment(drives).has_value();
  for (const auto& load : p.loads)
    if (const auto effect = load->effect(); effect && end_drives(*load, p.topology).empty())
      add_load(*effect, p, f);
  add_end_motion(drives, p, f);
  add_end_loads(drives, p, f);
  add_demands_of_turn(drives, p, f);
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
