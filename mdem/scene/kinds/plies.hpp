// [plies] equal ropes side by side, or wound round one another about z.
//
// The centre line of each rope is a helix of the radius R about z with the winding T (rad per nm of z), at the
// angle theta to z: tan theta = R T. Tubes lie in the plane across it, on the places of a [rope]. The section turns
// along the rope by the rope's own twist, against a section that is carried along without a turn. Ropes that are
// wound as one body have the twist of the helix, T cos^2 theta per length of rope, and the same tubes touch all
// along. R is the least at which no tube of a rope is nearer to one of another than two tubes bind best. No bond is
// stretched.
#pragma once

#include <optional>

#include "model/error.hpp"
#include "scene/kinds/rope.hpp"

namespace ropewalk {

class PliesSource : public Source {
 public:
  int ropes = 2;
  RopeSource rope;     // each of them
  double winding = 0;  // by how much the ropes turn about z, rad per nm of z; a right-handed turn is positive
  std::optional<double> own_twist;  // by how much each rope turns about its own middle, rad per nm of its length;
                                    // none: like one body that is wound
  InputError::Place typed;          // where the winding stands, for messages

  Sizes sizes(double element_length) const override;
  void place(const Scene&, double spacing_of_tubes, Random&, Topology&, State&) const override;
  double typed_spacing() const override { return rope.spacing; }
  std::string description(const Topology&, const State&, double spacing_of_tubes) const override;
};

}  // namespace ropewalk
