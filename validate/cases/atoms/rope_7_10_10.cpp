// Seven (10,10) tubes: wider, flatter where they touch, twice as strongly bound.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk {

TwistedRope rope_7_10_10() {
  TwistedRope rope;
  rope.name = "rope-7-10-10";
  rope.parameters = "cnt-10-10-tersoff";
  rope.free_rows = 64;
  rope.band_rows = 8;
  rope.bonds = 13;
  rope.step = 4.5 * units::degree;
  rope.increments = 6;
  rope.elastic_increments = 6;
  rope.remarks = {
      "A tube of six diameters that is clamped at both ends shears where it bends: Euler-Bernoulli bonds are 5 % "
      "too stiff from the smallest angle on, bonds with the shear stiffness of a thin tube agree within 0.3 % "
      "there.",
      "From there on the excess grows with the angle as in the ropes of (5,5), by the anharmonic tubes.",
      "The vdW energy of atoms is 3 to 5 % deeper: wide tubes flatten where they touch, rigid cylinders do not."};
  return rope;
}

Case rope_7_10_10_case() { return twisted_rope_case(rope_7_10_10(), "(10,10)", "8.1"); }

}  // namespace ropewalk
