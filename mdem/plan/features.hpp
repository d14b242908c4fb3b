// The demands of a scene on a model, estimated before it is run: how far its tubes will bend and twist.
#pragma once

#include "scene/prepare.hpp"

namespace ropewalk {

struct SceneFeatures {
  bool contact = false;  // tubes that can touch one another
  int tubes = 0;
  double curvature = 0, twist = 0;  // 1/nm, rad/nm, the largest expected
  double length = 0;                // nm, the longest free length of a tube
  bool sudden = false;              // a force or a moment acts at once
  double strain = 0;                // largest expected strain of a tube
  double pressure = 0;              // pressure on the innermost tube, eV/nm^3
  double turn = 0;                  // turn of the rope as a whole by loads and motions, from its start, rad/nm
  Schedule course;                  // schedule of the load or motion that takes longest to become whole
  double turned = 0, turning = 0;   // rad and rad/ps, prescribed to an end against the other
  // Whether both ends of some tube have a prescribed rotation, or a prescribed distance.
  bool turned_between = false, length_held = false;
  bool prescribes_moment = false;  // about the axis, at an end

  double ramp() const { return course.reaches(); }  // ps
};

// Upper estimates, see plan/demands.hpp: a twisting moment twists each tube as if no other held it; a force bends a
// tube that is clamped at its far end, with the moment F L.
SceneFeatures features_of(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
