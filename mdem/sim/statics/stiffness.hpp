// The tangent of a state as blocks, without a difference of two evaluations of all forces:
//
//   f(u) = f - K u,     u = (displacement, rotation vector in the space frame) of every element
//
// Contact by the line law is analytic, from the very polynomials that give the force in double precision; bonds,
// other laws, and the ends of tubes by differences of the fourth order of the pair's own forces; loads by
// differences on the elements that they act on. A force term has its own (ForceTerm::add_tangent). Memories of
// terms stay as they are, and what damps is left out.
//
// The rotation vector of an element is that of one turn from the state (sim/dynamics/tangent.hpp), so that the
// tangent of forces with a potential has half of their torque in its antisymmetric part. Where the state rests,
// that is minus half of the torque of the loads, which is what stands here: K is symmetric where loads have a
// potential, and away from rest it differs from the derivative by half of the torque that is left
// (add_left_torque).
//
// Units nm, eV, rad.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/tangent.hpp"
#include "sim/statics/block_matrix.hpp"
#include "sim/statics/stiffness_loops.hpp"

namespace ropewalk {

class LineLaw;  // sim/contact/line/law.hpp

class StiffnessMaker {
 public:
  // For this scene.
  explicit StiffnessMaker(const Simulation& s);
  // K of the state of the simulation. Throws std::runtime_error for a force term without a tangent, by its name.
  const BlockMatrix& make(const Simulation& s);

 private:
  void find_pattern(const Simulation& s);
  void add_bonds(const Simulation& s);
  void add_line_contact(const Simulation& s, const LineLaw& law);
  void add_contact(const Simulation& s);
  void drop_what_is_not_reached();
  void add_terms(const Simulation& s);

  BlockMatrix k_;
  std::vector<char> touches_, bonded_;  // of each block above the diagonal: the pair is near; has a bond
  std::vector<LineNodePairs> nodes_;    // pairs of tube types i, j at i * types + j
  std::vector<Vector3> axis_;
  std::vector<int> type_;  // type of each element
};

// The name of a force term that has no tangent; empty: all have one.
std::string term_without_tangent(const Simulation& s);

// C: contact viscosity and bond damping, pair by pair. Nothing where a force term or a load has a part in it.
std::optional<BlockMatrix> damping_blocks(const Simulation& s);

// The same as tangent_of(), with K by blocks, where all terms have a tangent; C by blocks where there are such.
Tangent tangent_by_blocks(const Simulation& s);

// Forces and torques of the loads, element by element.
Eigen::VectorXd load_forces(const LoadsAndConstraints& loads, const State& state);

// Adds the tangent of the loads at the time of the state, by differences on their elements.
void add_load_stiffness(const LoadsAndConstraints& loads, const Topology& topology, const State& state,
                        BlockMatrix& k);

// Makes K the derivative of the forces away from rest as well. `force`: all of them, with the loads.
void add_left_torque(const Eigen::VectorXd& force, BlockMatrix& k);

}  // namespace ropewalk
