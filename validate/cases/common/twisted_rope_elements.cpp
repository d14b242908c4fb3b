// The twisted rope of elements: grips, increments and what is measured.
#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/twisted_rope.hpp"
#include "scene/lattice.hpp"
#include "scene/loads/fix.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk {
namespace {

constexpr int tubes = 7;
constexpr double force_tolerance = 5e-3;  // eV/nm
constexpr double pull_tolerance = 0.2;    // eV/nm of the whole grip: worth less than 1e-5 eV
constexpr long max_steps = 100000;
constexpr double step_fraction = 0.9;  // of the stability limit: nothing has to be conserved

// Chains from one clamp to the other and, beyond the clamps, elements in place of the bands of atoms.
class ClampedRope {
 public:
  ClampedRope(const TwistedRope& rope, const ParameterSet& set);

  // Turns the upper grip by +angle/2 and the lower grip by -angle/2, the interior evenly; then relaxes.
  void turn(double angle);
  // Moves the upper grip along the axis until no force acts on it.
  void release();
  TwistedState measure() const;

 private:
  void relax();
  void lift(double distance);
  // Along the axis, on the upper grip.
  double grip_force() const;
  // -1/2 at the lower clamp, 1/2 at the upper one.
  double fraction_at(int element) const;

  Topology topology_;
  Interaction interaction_;
  LoadsAndConstraints loads_;
  State state_;
  Forces forces_;
  double time_step_ = 0, length_ = 0, axial_stiffness_ = 0, rise_ = 0;
  int bonds_ = 0, beyond_ = 0;  // between the clamps; elements of a grip beyond the clamped one
  std::vector<int> upper_;
};

ClampedRope::ClampedRope(const TwistedRope& rope, const ParameterSet& set)
    : length_(clamped_length(rope, set)), bonds_(rope.bonds) {
  const double a = length_ / bonds_;
  ParameterSet divided = set;
  divided.element_length = a;
  // A grip ends half an element beyond its last centre. Beyond the clamped length a band is longer by half of what
  // this exceeds the free rows by.
  const double band = rope.band_rows * row_distance(set) - 0.5 * (length_ - rope.free_rows * row_distance(set));
  beyond_ = std::max(1, static_cast<int>(std::lround(band / a - 0.5)));
  topology_ = topology_of(divided);
  topology_.types.front().bond = set.anharmonic_bond(length_);
  const int elements = bonds_ + 1 + 2 * beyond_;
  state_ = State(static_cast<std::size_t>(tubes * elements));
  for (const auto& [x, y] : hexagonal_lattice(tubes, set.line->pair_spacing)) {
    const int first = topology_.elements();
    topology_.add_tube(elements);
    for (int e = 0; e < elements; ++e) {
      state_.position.set(static_cast<std::size_t>(first + e), {x, y, (e - 0.5 * (elements - 1)) * a});
      const bool above = e >= bonds_ + beyond_;
      if (above) upper_.push_back(first + e);
      if (above || e <= beyond_) loads_.add(FixLoad({first + e}));
    }
  }
  interaction_.law = line_law({line_contact_of(divided)});
  time_step_ = step_fraction * time_step_limit(topology_, interaction_, set.line->pair_spacing).limit;
  axial_stiffness_ = tubes * set.bond.stretch / length_;
  relax();
}

double ClampedRope::fraction_at(int element) const {
  const int along = element % (bonds_ + 1 + 2 * beyond_) - beyond_;
  return std::clamp(static_cast<double>(along) / bonds_, 0.0, 1.0) - 0.5;
}

void ClampedRope::turn(double angle) {
  for (int e = 0; e < topology_.elements(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Quaternion by = turn_about(Vector3::UnitZ(), angle * fraction_at(e));
    state_.position.set(i, by * state_.position[i]);
    state_.orientation.set(i, (by * state_.orientation[i]).normalized());
  }
  relax();
}

void ClampedRope::lift(double distance) {
  for (int e = 0; e < topology_.elements(); ++e)
    state_.position.z[static_cast<std::size_t>(e)] += distance * (fraction_at(e) + 0.5);
  rise_ += distance;
  relax();
}

void ClampedRope::release() {
  // Newton steps with the stiffness of straight tubes; that of a twisted rope is close to it and not larger.
  for (int k = 0; k < 8 && std::fabs(grip_force()) > pull_tolerance; ++k) lift(grip_force() / axial_stiffness_);
}

void ClampedRope::relax() {
  const Simulation simulation =
      at_rest(Simulation(topology_, interaction_, loads_, state_, time_step_), force_tolerance, max_steps);
  state_ = simulation.state();
  forces_ = simulation.forces();
}

double ClampedRope::grip_force() const {
  double sum = 0;
  for (int e : upper_) sum += forces_.force.z[static_cast<std::size_t>(e)];
  return sum;
}

TwistedState ClampedRope::measure() const {
  TwistedState now;
  now.total = forces_.energy.potential();
  now.tubes = forces_.energy.bonds();
  now.vdw = forces_.energy.vdw;
  now.bending = forces_.energy.bend + forces_.energy.shear;
  now.moment = resisting_moment(upper_, state_.position, forces_.force, forces_.torque);
  now.force = -grip_force();
  now.rise = rise_;
  return now;
}

}  // namespace

std::vector<TwistedState> twist_elements(const TwistedRope& rope, const ParameterSet& set,
                                         const std::vector<double>& angles, bool axial_free) {
  ClampedRope chains(rope, set);
  std::vector<TwistedState> states;
  for (const double angle : angles) {
    if (!states.empty()) chains.turn(angle - states.back().angle);
    if (axial_free) chains.release();
    states.push_back(chains.measure());
    states.back().angle = angle;
  }
  return states;
}

}  // namespace ropewalk
