// The contact of bead-and-spring tubes as in stock molecular dynamics codes, for comparison; the simulator does not
// use it. A bead acts in all directions alike.
//
// Source: M. J. Buehler, J. Mater. Res. 21, 2855 (2006), DOI 10.1557/jmr.2006.0347.
#pragma once

#include <cmath>

#include "model/units.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk::validate {

// 12-6 law between beads. Two long parallel rows have the given spacing (nm) and mean energy per length (eV/nm).
class BeadLaw : public ContactLaw {
 public:
  BeadLaw(double spacing, double energy, double element_length) {
    // int (R^2 + z^2)^-3 dz = 3 pi/8 R^-5 and int (R^2 + z^2)^-6 dz = 63 pi/256 R^-11.
    const double attraction = 3 * units::pi / 8, repulsion = 63 * units::pi / 256;
    const double x = 5 * attraction / (11 * repulsion);  // (sigma/R)^6 at the minimum
    sigma_ = spacing * std::pow(x, 1.0 / 6);
    epsilon_ = energy * element_length * element_length / (4 * spacing * (x * x * repulsion - x * attraction));
  }
  std::string name() const override { return "beads of another code"; }
  double cutoff() const override { return 40 * sigma_; }  // as good as no cutoff
  PairForce force(TypePair, const Vector3& separation, const Vector3&, const Vector3&) const override {
    PairForce f;
    const double r2 = separation.squaredNorm(), y = std::pow(sigma_ * sigma_ / r2, 3);
    if (r2 >= cutoff() * cutoff()) return f;
    f.energy = well(r2) - well(cutoff() * cutoff());
    f.force_j = 24 * epsilon_ * (2 * y * y - y) / r2 * separation;
    return f;
  }

 private:
  double well(double distance2) const {
    const double y = std::pow(sigma_ * sigma_ / distance2, 3);
    return 4 * epsilon_ * (y * y - y);
  }

  double epsilon_ = 0, sigma_ = 0;  // eV, nm
};

}  // namespace ropewalk::validate
