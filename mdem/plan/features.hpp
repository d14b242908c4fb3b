// What a scene asks of a model, estimated before it is run: how far its tubes will bend and twist, and at which
// angles they cross.
#pragma once

#include <string>
#include <vector>

#include "plan/chart.hpp"
#include "scene/prepare.hpp"

namespace ropewalk {

struct SceneFeatures {
  bool contact = false;  // tubes that can touch one another
  int tubes = 0;
  double radius = 0;                          // nm, of the first tube type
  double curvature = 0, twist = 0;            // 1/nm, rad/nm, the largest expected
  double crossing_from = 0, crossing_to = 0;  // deg, of tubes in reach of one another
  double length = 0;                          // nm, of the longest tube
  double duration = 0;                        // ps
  bool sudden = false;                        // a force or a moment acts at once
  DrivenBy driven_by = DrivenBy::nothing;                 // by loads, where there are rotations as well
  double strain = 0;                          // of a tube, the largest expected
  double pressure = 0;                        // eV/nm^3, on the innermost tube
  double turn = 0;                            // rad/nm, of a rope as a whole at the end; part of `twist`
  double ramp = 0;                            // ps, in which it is turned
  std::vector<std::string> why;               // how the figures come about
  std::string not_estimable;                         // what cannot be estimated; empty: nothing
};

// Upper estimates: a twisting moment twists each tube as if no other held it, M/GJ; a force bends a tube that is
// clamped at its far end, F L/EI.
SceneFeatures features_of(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
