// The bonds of the tubes: forces, torques, energies and damping, part by part, in loops that the compiler
// vectorises. The form is that of model/bond.hpp.
#pragma once

#include "sim/forces/forces.hpp"

namespace ropewalk {

// The input of the bonds.
struct BondInput {
  const Topology& topology;
  const BondDamping& damping;
  const State& state;
  const std::vector<char>* broken = nullptr;  // ForceTerm::broken_bonds
};

// Adds the sums of other bonds; the first slipping bond stays.
void add(const BondSum& of, BondSum& sum);

// The bond from element i of the tube to the next.
Joint joint_behind(const BondInput& in, int tube, int i);

// Sets forces and torques of a part of a tube to those of its bonds. `before` and `behind` are the bonds to the
// parts on both sides; null: none. The sums leave out the former: those of the part before have it.
BondSum compute_bonds(const BondInput& in, const Segment& of, const Joint* before, const Joint* behind,
                      const ForceRows& out);

// Adds what a bond does to the element behind it.
void add_behind(const Joint& bond, int element, const ForceRows& out);

}  // namespace ropewalk
