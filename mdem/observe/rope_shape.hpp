// The shape that a twisted rope has taken, by name.
//
//   straight   none of the others
//   spindle    the middle is wider than at the start by more than a tenth of the radius, and closed: its voids are
//              less than a twentieth of the section at the start
//   cage       the middle is as wide as that of a spindle, and its tubes have parted: the voids are larger
//   helix      the centre line, without a tenth at either end, leaves its chord by more than half of the radius of
//              the rope, at the start or now, the larger of both; voids and open ends move the line of a straight
//              rope by less
//   brush      the ends are open: more than 1.5 times as wide as the middle and as at the start. The centre line
//              of such an end is a mean over tubes in all directions
//   snarl      a loop: more than a fiftieth of the centre line runs against its chord, and the writhe is more than
//              half a turn, of either sign
//
// If several fit, the first of: snarl, brush, helix, cage, spindle.
#pragma once

#include <array>
#include <string>

namespace ropewalk {

enum class RopeShape { straight, spindle, helix, brush, cage, snarl };

const char* name_of(RopeShape shape);
inline constexpr std::array<RopeShape, 6> rope_shapes = {RopeShape::straight, RopeShape::spindle, RopeShape::helix,
                                                         RopeShape::brush,    RopeShape::cage,    RopeShape::snarl};

// Observables of these names (observables.hpp).
struct ShapeNumbers {
  double middle_amplitude = 0;            // nm
  double writhe = 0, turned_back = 0;     // turns, part of the length
  double radius_mid = 0, radius_end = 0;  // nm
  double void_area = 0;                   // nm^2
};
// `start`: radius (nm) of the middle section at the start. NaN where the rope has no centre line: then straight.
RopeShape rope_shape(const ShapeNumbers& now, double start);

}  // namespace ropewalk
