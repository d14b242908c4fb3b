// One tube of the model under a tension, a torque and a bending moment, by the energy of its own bonds
// (model/bond.hpp): with anharmonic bonds it softens, and beyond their window it does what the bonds do there.
//
// A bond of an even arc with the strain e, twist per length tau and curvature kappa has an energy per length
// W(e, tau, kappa). The derivatives of W are the tension (eV/nm), the torque and the moment (eV).
#pragma once

#include "sim/state/state.hpp"

namespace ropewalk {

class TubeLaw {
 public:
  // Strain, twist and curvature count from the natural shape; of two stiffnesses of bending the smaller one counts.
  explicit TubeLaw(const TubeType& type) : bond_(straightened(type.bond)), length_(type.element_length) {
    bond_.bend -= std::fabs(type.bond.bend_difference);
  }

  double energy(double strain, double twist, double curvature) const;  // eV/nm
  double tension(double strain, double twist) const;
  double torque(double strain, double twist) const;
  double moment(double curvature) const;

  // Where the tube bears this load, the other one given: the state that a load which grows from zero comes to
  // first. Without the load that is where the other one leaves the tube. Where the tube does not bear it at all,
  // the largest value that is looked at: a strain of 1, or a bond that is twisted or bent by 90 degrees.
  double strain_under(double tension, double twist) const;
  double twist_under(double torque, double strain) const;
  double curvature_under(double moment) const;  // never negative
  double largest_twist() const { return 0.5 * units::pi / length_; }

 private:
  BondStiffness bond_;
  double length_;
};

}  // namespace ropewalk
