// A rope of seven parallel tubes between two grips: the scene in which the cases of other codes compare methods.
//
// A grip holds the positions and orientations of the two outermost elements of every tube. The length between the
// inner ones deforms; it is a whole number of bonds. The grips keep their distance along the axis.
#pragma once

#include <vector>

#include "cases/common/bundle.hpp"
#include "scene/scene.hpp"

namespace ropewalk::validate {

struct GrippedRope {
  static constexpr int tubes = 7, held = 2;  // elements of a grip in each tube

  Topology topology;
  Interaction interaction;
  LoadsAndConstraints loads;  // empty until hold_grips()
  State state;
  std::vector<int> lower, upper;  // elements of the grips
  int bonds = 0;                  // between the grips, of each tube
  double spacing = 0;             // nm, of two long parallel rows at rest

  GrippedRope(const ParameterSet& set, int bonds, const std::string& law);
  double length() const { return bonds * topology.types[0].element_length; }
  int elements_of_tube() const { return bonds + 2 * held - 1; }
  // Part of the way from the lower grip (0) to the upper one (1).
  double fraction_at(int element) const;
  double turn_of(int element, double angle) const { return (fraction_at(element) - 0.5) * angle; }
  void hold_grips();
  // Turns the upper grip by +angle/2, the lower one by -angle/2, and the elements between them evenly.
  void turn(double angle);
};

// Torsion energy (eV) of seven tubes wound around each other by `angle` (rad). A tube on a helix of angle beta
// twists by angle cos(beta); the rest is writhe.
//   E = GJ angle^2 (1 + 6 cos^2 beta)/2L,   tan(beta) = spacing angle/L
double torsion_energy(const BondStiffness& bond, double spacing, double length, double angle);

// Integral of an odd number of values at even distances, by Simpson's rule.
double simpson_sum(const std::vector<double>& values, double distance);

}  // namespace ropewalk::validate
