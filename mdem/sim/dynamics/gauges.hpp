// Gauges at both ends of the rope: what loads and constraints give to the end elements, whatever drives them.
//
//   impulse of the force      sum of F dt + J
//   impulse of the torque     sum of M dt + K + (x - c) x (F dt + J)     about the end's centre of mass c
//   work                      sum of (F v + M w) dt + (J v + K w)
//
// with the loads F, M and the impulses J, K of the constraints on each element, and the velocities in the middle of
// a kick. The sums run over every kick, so that mean forces and torques are exact and their work closes the account
// of energy.
//
// The rotation of an end about z is the best fit, weighted by mass, of the elements' positions at the start to
// their present positions. For a single element it is the rotation of its body axis e1. Whole turns are counted.
#pragma once

#include <array>
#include <vector>

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

// First and last element of every tube.
EndElements tube_ends(const Topology& topology);
Vector3 centre_of(const Topology& topology, const State& state, const std::vector<int>& elements);

// On the rope, at one end.
struct EndReading {
  Vector3 force = Vector3::Zero();   // eV/nm
  Vector3 torque = Vector3::Zero();  // eV, about the end's centre
  double turned = 0;                 // rad about z since the start, not reduced to one turn
  double work = 0;                   // eV since the start
};
using EndReadings = std::array<EndReading, 2>;

class Gauges {
 public:
  // The sums: all that the future of a gauge depends on.
  struct Sum {
    forms::Vec force_time{}, torque_time{};  // since the last reading
    double turned = 0, work = 0;             // since the start
  };
  struct Sums {
    std::array<Sum, 2> of;
    double since = 0;  // time of the last reading, ps
  };

  Gauges() = default;
  // `start`: what turns are counted from.
  Gauges(const Topology& topology, EndElements ends, const State& start);

  const EndElements& ends() const { return ends_; }
  void add_loads(const State& state, const std::vector<PointLoad>& loads, double dt);
  void add_constraints(const State& state, const std::vector<ConstraintImpulse>& impulses);
  // Counts the turn, which must have changed by less than half a turn since it was called last.
  void follow(const State& state);
  // Sets the work to unknown, after another program has moved the elements.
  void forget_work();

  // What acts at this time is read as of a state at rest: forces on the way to it have no part in a mean.
  void stand_at(double time) {
    for (Sum& sum : sums.of) sum.force_time = sum.torque_time = {};
    sums.since = time;
  }

  // Means since the last reading, which must be earlier.
  EndReadings read(const State& state);
  // The same by the forces of this moment, if no time has passed.
  EndReadings read_still(const State& state, const std::vector<ConstraintImpulse>& reactions,
                         const std::vector<PointLoad>& loads);

  Sums sums;

 private:
  void add(const State& state, int element, const Vector3& force, const Vector3& torque, double work);
  void locate(const State& state);
  Vector3 arm_now(const State& state, std::size_t end, std::size_t k) const;

  EndElements ends_;
  std::vector<signed char> end_of_;          // end of every element; -1: neither
  std::array<std::vector<double>, 2> mass_;  // of the elements at each end
  std::array<std::vector<Vector3>, 2> arm_;  // of the start
  std::array<Vector3, 2> centre_{Vector3::Zero(), Vector3::Zero()};
};

}  // namespace ropewalk
