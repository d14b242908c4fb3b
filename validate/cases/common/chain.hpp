// One tube as a chain of bonds: its state at rest under loads, and its tangent stiffness, whose lowest eigenvalue
// passes zero at the buckling load.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/case.hpp"
#include "core/checks.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk::validate {

// One straight tube along z with its first element at the origin.
struct Chain {
  Topology topology;
  Interaction interaction;
  LoadsAndConstraints loads;
  State state;
  int last = 0;

  Chain(const ParameterSet& set, int bonds);
  double length() const { return last * topology.types[0].element_length; }
  Simulation make(double step_fraction = default_step_fraction) const;
  // At rest: the largest force is below `tolerance` (eV/nm). Throws NumericalError where that takes too many steps.
  Simulation relaxed(double tolerance) const;
};

// Relaxes until the largest force is below `tolerance` (eV/nm). Throws NumericalError after `max_steps`.
Simulation at_rest(Simulation simulation, double tolerance, long max_steps);

Quaternion turn_about(const Vector3& axis, double angle);
// The rotation by |angles| (rad) about the direction of `angles`.
Quaternion small_turn(const Vector3& angles);

// Force and torque on every element of an open chain, six numbers each.
Eigen::VectorXd chain_forces(const BondStiffness& bond, double element_length, const State& state);

// Minus the derivative of these forces by the displacements and rotations (space frame) of the freedoms
// 6 element + 0 .. 5. Loads of constant direction do not enter. Not symmetric where a couple has no potential.
Eigen::MatrixXd tangent_stiffness(const BondStiffness& bond, double element_length, const State& state,
                                  const std::vector<int>& freedoms);

// Smallest real part of the eigenvalues: negative above the first buckling load.
double lowest_eigenvalue(const Eigen::MatrixXd& stiffness);

// The zero of a falling function, by bisection.
double zero_between(const std::function<double(double)>& falling, double low, double high);

// Throws NotApplicable where the bonds of the set slip near this moment (eV), so that no chain of them buckles by
// it.
void refuse_slip(const ParameterSet& set, double moment);

// The load (eV/nm) under which a straight chain of so many bonds buckles, its ends on the axis and free to turn;
// sought from half of `expected` to 2.5 times it.
double buckling_load(const ParameterSet& set, int bonds, double expected);

}  // namespace ropewalk::validate
