// The incremental parallel bond of particle codes, for comparison; the simulator does not use it. Each step adds to
// the force and moment of the bond by its relative motion, and turns both with the bond.
//
// Source: D. O. Potyondy, P. A. Cundall, Int. J. Rock Mech. Min. Sci. 41, 1329 (2004),
// DOI 10.1016/j.ijrmms.2004.09.011.
#pragma once

#include "model/parameters.hpp"

namespace ropewalk::validate {

// Motion of one element in one step.
struct ElementMove {
  Vector3 shift = Vector3::Zero();  // nm
  Vector3 turn = Vector3::Zero();   // rad
};

class ParallelBond {
 public:
  ParallelBond(const BondStiffness& bond, double element_length);

  // separation = x_j - x_i before and after the moves.
  void advance(const Vector3& before, const Vector3& after, const ElementMove& i, const ElementMove& j);
  double energy(const Vector3& separation) const;  // energy of the accumulated force and moment, eV
  const Vector3& force() const {
    return force_;
  }  // acts on element j at the middle of the bond; i feels the opposite
  const Vector3& moment() const { return moment_; }

 private:
  double normal_, shear_, bend_, twist_;  // stiffnesses
  Vector3 force_ = Vector3::Zero(), moment_ = Vector3::Zero();
};

// Deflection (nm) of the end of a cantilever of such bonds under a force (eV/nm) across it, after damped motion.
double parallel_bond_deflection(const ParameterSet& set, int bonds, double force);

}  // namespace ropewalk::validate
