// The tangent of a state: how forces and torques change with small motions of all elements,
//
//   f(u, u') = f - K u - C u',     u = (displacement, rotation vector in the space frame) of every element,
//
// loads included, by central differences. Memories of force terms stay as they are. Elements whose forces reach no
// common element move in one evaluation: some hundred evaluations give all columns. A. R. Curtis, M. J. D. Powell,
// J. K. Reid, IMA J. Appl. Math. 13, 117 (1974), DOI 10.1093/imamat/13.1.117.
//
// The rotation vector of an element is that of one turn from the state, so that K is symmetric where every torque,
// loads included, vanishes and all forces have a potential; otherwise its antisymmetric part is that of half the
// torque.
//
// Units nm, ps, eV, rad. Unknowns stand element by element, six each.
#pragma once

#include <Eigen/SparseCore>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct Tangent {
  using Matrix = Eigen::SparseMatrix<double>;

  Matrix stiffness, damping;  // K, C
  Eigen::VectorXd mass;       // mass or inertia of each unknown
  Eigen::VectorXd force;      // force in the state, its velocities left out
  std::vector<int> order;     // order_along() the state
  long evaluations = 0;
  // The relative error of K and C along one motion of all elements. The error is large where a force term reaches
  // farther than the neighbour list.
  double error = 0;
};

// The state of the simulation, in double precision whatever the scene has. `step`: nm, of the differences; the
// turns are as large at the radius of the tube.
Tangent tangent_of(const Simulation& simulation, double step = 1e-5);

// The same with a K that is known, so that only C is found by differences, and that neither where it is known.
Tangent tangent_with(const Simulation& simulation, const Tangent::Matrix& stiffness,
                     const Tangent::Matrix* damping = nullptr);

// The state with each element moved by u, and turned; with the velocities of u' (null: at rest).
State moved(const State& state, const Eigen::VectorXd& u, const Eigen::VectorXd* velocity = nullptr);

// The elements along the longest extent of a state.
std::vector<int> order_along(const State& state);

}  // namespace ropewalk
