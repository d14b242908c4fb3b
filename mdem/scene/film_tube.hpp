// A straight tube of a film: where it lies, and how it comes to rest on others.
#pragma once

#include <cmath>
#include <vector>

#include "model/bond.hpp"  // Vector3

namespace ropewalk {

struct FilmTube {
  double x = 0, y = 0, z = 0;  // its middle, nm
  double angle = 0;            // angle of its projection on the plane of the film to the x axis, rad
  double tilt = 0;             // rad, out of this plane

  Vector3 middle() const { return {x, y, z}; }
  Vector3 axis() const {  // a unit vector
    return {std::cos(tilt) * std::cos(angle), std::cos(tilt) * std::sin(angle), std::sin(tilt)};
  }
};

// The squared distance (nm^2) of two tubes of one length (nm) in projection on the plane of the film, as if both
// lay level: 0 where they cross.
double projected_distance2(const FilmTube& a, const FilmTube& b, double length);

// Lets a tube down on the others: sets its height and its tilt so that its middle is as low as possible. The axis
// of the tube stays at least a spacing (nm) away from the axes of the others, and both ends of the tube stay at z =
// 0 or above. The tube then rests on two supports, one on either side of its middle. A support is another tube at
// the spacing, or the plane under an end. Among short tubes there are two exceptions: a tube may balance on one
// tube that is nearly parallel to it, and an end may hang beside the side of another tube. Tubes are rigid, of one
// length (nm), with round ends. Place and angle of the tube do not change.
void let_down(FilmTube& tube, const std::vector<FilmTube>& others, double length, double spacing);

}  // namespace ropewalk
