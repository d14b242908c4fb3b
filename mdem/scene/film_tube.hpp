// A straight tube of a film: where it lies, and how it comes to rest on others.
#pragma once

#include <cmath>
#include <vector>

#include "model/bond.hpp"  // Vector3

namespace ropewalk {

struct FilmTube {
  double x = 0, y = 0, z = 0;  // nm, of its middle
  double angle = 0;            // rad, of its projection on the plane of the film, from the x axis
  double tilt = 0;             // rad, out of this plane

  Vector3 middle() const { return {x, y, z}; }
  Vector3 axis() const {  // a unit vector
    return {std::cos(tilt) * std::cos(angle), std::cos(tilt) * std::sin(angle), std::sin(tilt)};
  }
};

// The squared distance (nm^2) of two tubes of one length (nm) in projection on the plane of the film, as if both
// lay level: 0 where they cross.
double projected_distance2(const FilmTube& a, const FilmTube& b, double length);

// Gives a tube the height and the tilt at which its middle is as low as it can be on top of the others: no axis of
// one of them is closer to its own than the spacing (nm), and both its ends are at z = 0 or above. It then rests on
// two supports, one on either side of its middle: axes at the spacing, or the plane under an end. There are two
// exceptions, both rare among long tubes. On a tube that runs nearly along it, it may rest on one support, under
// its middle; and an end that has slipped past the side of another tube stays beside it, at the spacing in
// projection. Tubes are rigid, of one length (nm) and round at their ends; place and angle stay as they are.
void let_down(FilmTube& tube, const std::vector<FilmTube>& others, double length, double spacing);

}  // namespace ropewalk
