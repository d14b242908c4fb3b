// Loads and constraints, resolved to elements. Forces and couples are added to the model's; constraints act
// on the velocities after each kick, so that a constrained component never moves off its path.
#pragma once

#include <vector>

#include "sim/forces/forces.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct PointLoad {
  int element = 0;
  Vector3 force = Vector3::Zero();   // eV/nm
  Vector3 torque = Vector3::Zero();  // eV
};

struct Fixed {
  int element = 0;
  bool x = true, y = true, z = true, rotation = true;
};

// The elements turn as one body about a line along z through `centre`: angle(t) = rate t, up to `angle`.
struct Turned {
  std::vector<int> elements;
  double rate = 0;   // rad/ps
  double angle = 0;  // rad, where it stops; same sign as rate
  Vector3 centre = Vector3::Zero();
  bool axial_free = true;
  bool spin_free = false;  // the spin about the tube's own axis is left free

  double speed(double time) const { return std::fabs(rate * time) < std::fabs(angle) ? rate : 0.0; }
};

// Two-stage twisting: + moment on the upper grip, - on the lower, ramped and then held.
struct TwistDrive {
  std::vector<int> upper, lower;
  double moment = 0;     // eV, in its reading
  double rate = 0;       // eV/ps
  bool per_tube = true;  // moment of each grip element, or of the whole grip
  bool tangential = false;
  bool lateral_free = true, axial_free = true;
  bool geometric_only = false;
  double increment = 1;  // ps

  double moment_at(double time) const {
    const double ramped = rate > 0 ? rate * time : moment;
    return ramped < moment ? ramped : moment;
  }
};

struct Drive {
  std::vector<PointLoad> loads;
  std::vector<Fixed> fixed;
  std::vector<Turned> turned;
  std::vector<TwistDrive> twist;  // none or one
};

// Every element that it names, some more than once; const or not, as the drive is.
template <class D, class F>
void visit_elements(D& drive, const F& f) {
  for (auto& load : drive.loads) f(load.element);
  for (auto& fixed : drive.fixed) f(fixed.element);
  for (auto& turned : drive.turned)
    for (auto& e : turned.elements) f(e);
  for (auto& twist : drive.twist) {
    for (auto& e : twist.upper) f(e);
    for (auto& e : twist.lower) f(e);
  }
}

// The elements that any of it acts on, in rising order.
std::vector<int> driven_elements(const Drive& drive);

// The loads at this time, element by element; an element may appear more than once.
void point_loads(const Drive& drive, const State& state, double time, std::vector<PointLoad>& out);

// Work per time of these loads at the present velocities, eV/ps.
double load_power(const std::vector<PointLoad>& loads, const State& state);

// Sets the constrained velocity components after a kick of duration `kick` by the forces `total`. Returns the
// work that the constraints did on the elements (eV): zero for fixed ones.
double constrain(const Topology& topology, const Drive& drive, double time, const Forces& total, double kick,
                 State& state);

// Turns every element about its own axis such that no bond is twisted, keeping the middle element of each
// tube and all tube axes, and takes away the spin velocities: the exact minimum of the twist energy over the
// spins. Geometric twist (the shape of the centre line) is untouched.
void relax_spins(const Topology& topology, State& state);

}  // namespace ropewalk
