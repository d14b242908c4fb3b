// Single tubes as chains of bonds, for the cases of rod theory: chains that come to rest under loads, and their
// tangent stiffness, whose lowest eigenvalue tells buckling without following it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/case.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/loads/torque.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// One tube type, element length and mass as the set says; no tubes yet.
Topology topology_of(const ParameterSet& set);

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
  // At rest within `tolerance` (eV/nm); throws NumericalError where it does not come to rest.
  Simulation relaxed(double tolerance) const;
};

Simulation at_rest(Simulation simulation, double tolerance, long max_steps);

Quaternion turn_about(const Vector3& axis, double angle);
// The rotation of a small vector of angles.
Quaternion small_turn(const Vector3& angles);

// Force and torque on every element of an open chain, six numbers each.
Eigen::VectorXd chain_forces(const BondStiffness& bond, double element_length, const State& state);

// Minus the derivative of these by displacements and rotations (space frame) of the freedoms 6 element + 0 .. 5.
// Loads of constant direction do not enter; not symmetric where a couple follows no potential.
Eigen::MatrixXd tangent_stiffness(const BondStiffness& bond, double element_length, const State& state,
                                  const std::vector<int>& freedoms);

// Smallest real part of the eigenvalues: negative beyond the first buckling load.
double lowest_eigenvalue(const Eigen::MatrixXd& stiffness);

// Where a falling function passes zero.
double zero_between(const std::function<double(double)>& falling, double low, double high);

Check relative_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
Check absolute_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
Check information(Check check);

// A curve of an oracle, and points of the model.
ChartLine theory_curve(std::string name, const std::function<double(double)>& curve, double from, double to,
                       int colour = 0);
ChartLine model_points(std::string name, std::vector<double> x, std::vector<double> y, int colour = 1);

}  // namespace ropewalk
