// Bead-and-spring tubes as in stock molecular dynamics codes, for comparison; the simulator does not use them.
// Beads have no orientation; bonds stretch, hinges bend, and beads of two tubes interact by a Lennard-Jones law.
//
// Source: M. J. Buehler, J. Mater. Res. 21, 2855 (2006), DOI 10.1557/jmr.2006.0347.
#pragma once

#include <cmath>
#include <vector>

#include "cases/common/gripped_rope.hpp"

namespace ropewalk::validate {

// 12-6 law between beads. Two long parallel rows have the given spacing (nm) and mean energy per length (eV/nm).
struct BeadLaw {
  double epsilon = 0, sigma = 0;  // eV, nm

  BeadLaw(double spacing, double energy, double element_length) {
    // int (R^2 + z^2)^-3 dz = 3 pi/8 R^-5 and int (R^2 + z^2)^-6 dz = 63 pi/256 R^-11.
    const double attraction = 3 * units::pi / 8, repulsion = 63 * units::pi / 256;
    const double x = 5 * attraction / (11 * repulsion);  // (sigma/R)^6 at the minimum
    sigma = spacing * std::pow(x, 1.0 / 6);
    epsilon = energy * element_length * element_length / (4 * spacing * (x * x * repulsion - x * attraction));
  }
  double energy(double distance2) const {
    const double y = std::pow(sigma * sigma / distance2, 3);
    return 4 * epsilon * (y * y - y);
  }
  double energy(const Vector3& separation, const Vector3&, const Vector3&) const {
    return energy(separation.squaredNorm());
  }
  // -dU/dR over R, eV/nm^2.
  double force_over_distance(double distance2) const {
    const double y = std::pow(sigma * sigma / distance2, 3);
    return 24 * epsilon * (2 * y * y - y) / distance2;
  }
};

// The rope of `gripped` with a bead in place of every element.
class BeadRope {
 public:
  BeadRope(const GrippedRope& gripped, const BeadLaw& law);

  void turn(double angle);
  void relax();  // throws NumericalError where the rope does not come to rest
  double stretch() const { return stretch_; }
  double bend() const { return bend_; }
  double contact() const { return contact_; }
  double total() const { return stretch_ + bend_ + contact_; }
  double moment() const;  // eV, on the upper grip
  const Vec3Array& position() const { return position_; }

 private:
  void compute();
  void bonds(std::size_t first);
  double largest_force() const;

  GrippedRope rope_;  // for its geometry
  BeadLaw law_;
  Vec3Array position_, velocity_, force_;
  double stretch_ = 0, bend_ = 0, contact_ = 0;
};

}  // namespace ropewalk::validate
