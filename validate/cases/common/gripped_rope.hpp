// A rope of seven parallel tubes between two grips, with elements in place of a rope of atoms.
//
// A grip holds the positions and orientations of the outermost elements of every tube. The length between the inner
// ones deforms; it is a whole number of bonds. The grips keep their distance along the axis.
#pragma once

#include <memory>
#include <vector>

#include "cases/common/bundle.hpp"

namespace ropewalk::validate {

struct GrippedRope {
  static constexpr int tubes = 7;

  Topology topology;
  Interaction interaction;
  State state;
  Forces forces;                  // result of relax()
  std::vector<int> lower, upper;  // elements of the grips
  int bonds = 0;                  // between the grips, of each tube
  int held = 0;                   // elements of a grip in each tube
  double spacing = 0;             // nm

  GrippedRope(const ParameterSet& set, int bonds, std::shared_ptr<const ContactLaw> law, double spacing, int held);
  int elements_of_tube() const { return bonds + 2 * held - 1; }
  // Part of the way from the lower grip (0) to the upper one (1).
  double fraction_at(int element) const;
  // Turns the upper grip by +angle/2, the lower one by -angle/2, and the elements between them evenly.
  void turn(double angle);
  // To rest between the grips, until the largest force is below `tolerance` (eV/nm).
  void relax(double tolerance);
  double moment() const;  // moment on the upper grip, eV
};

}  // namespace ropewalk::validate
