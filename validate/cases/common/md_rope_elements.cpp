#include <algorithm>
#include <cmath>

#include "cases/common/md_rope.hpp"
#include "model/error.hpp"
#include "scene/build.hpp"
#include "scene/loads/fix.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {
namespace {

constexpr int tubes = 7;
constexpr double force_tolerance = 5e-3;  // eV/nm
constexpr double pull_tolerance = 0.2;    // eV/nm of the whole grip: worth less than 1e-5 eV
constexpr long most_steps = 100000;
constexpr double step_fraction = 0.9;  // of the stability limit: nothing has to be conserved

// The chain from one clamp to the other and, outside of it, what the band of atoms holds.
class ClampedRope {
 public:
  ClampedRope(const TwistedRope& rope, const ParameterSet& set);

  // Upper grip by +angle/2, lower grip by -angle/2; the interior follows evenly, is then relaxed.
  void turn(double angle);
  // Moves the upper grip along the axis to where nothing pulls at it.
  void release();
  TwistedState measure() const;

 private:
  void relax();
  void lift(double distance);
  // Of the model on the upper grip.
  double grip_force() const;
  double grip_moment() const;
  // -1/2 at the lower clamp, 1/2 at the upper one.
  double place(int element) const;

  Topology topology_;
  Interaction interaction_;
  LoadsAndConstraints loads_;
  State state_;
  Forces forces_;
  double time_step_ = 0, length_ = 0, axial_stiffness_ = 0, rise_ = 0;
  int bonds_ = 0, beyond_ = 0;  // between the clamps; elements of a grip beyond the clamped one
  std::vector<int> upper_;
};

LineContact contact_of(const ParameterSet& set, double element_length) {
  const int nodes = line_nodes(element_length, set.line->pair_spacing, set.line->density.contact);
  return line_pair(set.line->density, element_length, element_length, nodes, nodes);
}

ClampedRope::ClampedRope(const TwistedRope& rope, const ParameterSet& set)
    : length_(clamped_length(rope, set)), bonds_(rope.bonds) {
  const double a = length_ / bonds_;
  // The band ends half a row beyond its last row, a grip half an element beyond its last centre.
  beyond_ = std::max(1, static_cast<int>(std::lround((rope.band_rows - 0.5) * row_distance(set) / a - 0.5)));
  topology_.types = {{a, set.radius, set.element_mass(a), set.element_inertia(a), set.bond}};
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
  interaction_.line = {contact_of(set, a)};
  time_step_ = step_fraction * time_step_limit(topology_, interaction_, set.line->pair_spacing).limit;
  axial_stiffness_ = tubes * set.bond.stretch / length_;
  relax();
}

double ClampedRope::place(int element) const {
  const int along = element % (bonds_ + 1 + 2 * beyond_) - beyond_;
  return std::clamp(static_cast<double>(along) / bonds_, 0.0, 1.0) - 0.5;
}

void ClampedRope::turn(double angle) {
  for (int e = 0; e < topology_.elements(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Quaternion by(Eigen::AngleAxisd(angle * place(e), Vector3::UnitZ()));
    state_.position.set(i, by * state_.position[i]);
    state_.orientation.set(i, (by * state_.orientation[i]).normalized());
  }
  relax();
}

void ClampedRope::lift(double distance) {
  for (int e = 0; e < topology_.elements(); ++e)
    state_.position.z[static_cast<std::size_t>(e)] += distance * (place(e) + 0.5);
  rise_ += distance;
  relax();
}

void ClampedRope::release() {
  // Newton steps with the stiffness of straight tubes, which a twisted rope's is close to and not above.
  for (int k = 0; k < 8 && std::fabs(grip_force()) > pull_tolerance; ++k) lift(grip_force() / axial_stiffness_);
}

void ClampedRope::relax() {
  Simulation simulation(topology_, interaction_, loads_, state_, time_step_);
  if (!simulation.relax(force_tolerance, most_steps, [](long) { return true; }))
    throw NumericalError(most_steps, -1, "the twisted rope did not come to rest", "take a smaller increment");
  state_ = simulation.state();
  forces_ = simulation.forces();
}

double ClampedRope::grip_force() const {
  double sum = 0;
  for (int e : upper_) sum += forces_.force.z[static_cast<std::size_t>(e)];
  return sum;
}

double ClampedRope::grip_moment() const {
  double sum = 0;
  for (int e : upper_) {
    const auto i = static_cast<std::size_t>(e);
    sum +=
        forces_.torque.z[i] + state_.position.x[i] * forces_.force.y[i] - state_.position.y[i] * forces_.force.x[i];
  }
  return sum;
}

TwistedState ClampedRope::measure() const {
  TwistedState now;
  now.total = forces_.energy.potential();
  now.tubes = forces_.energy.bonds();
  now.vdw = forces_.energy.vdw;
  now.bending = forces_.energy.bend + forces_.energy.shear;
  now.moment = -grip_moment();
  now.force = -grip_force();
  now.rise = rise_;
  return now;
}

}  // namespace

std::vector<TwistedState> twist_elements(const TwistedRope& rope, const ParameterSet& set, bool axial_free) {
  ClampedRope chains(rope, set);
  std::vector<TwistedState> states;
  for (int k = 0; k <= rope.increments; ++k) {
    if (k > 0) chains.turn(rope.step);
    if (axial_free) chains.release();
    states.push_back(chains.measure());
    states.back().angle = k * rope.step;
  }
  return states;
}

}  // namespace ropewalk
