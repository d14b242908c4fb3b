// Seven tubes, so short that the bending at the clamps takes a sixth of the energy.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk::validate::rope_7_short {
namespace {

const RegisteredCase registered([] {
  RopeComparison rope;
  rope.name = "rope-7-short";
  rope.length = 8;
  rope.remarks = {
      "Stretch holds 6 % of the energy or less, so that a wrong `EA` does not show here.",
      "A wide tube that is clamped at both ends shears where it bends: at a length of six diameters, bonds "
      "without shear are 5 % too stiff from the smallest angle on.",
      "The vdW energy of atoms of wide tubes is 3 to 5 % deeper: they flatten where they touch, rigid cylinders do "
      "not."};
  Case c = twisted_rope_case(rope, "Twisted 7-tube ropes of {tube}, 8 nm");
  c.order = 70;
  c.sets = {"cnt-5-5-tersoff", "cnt-10-10-tersoff"};
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}},
                 {wrong_contact(2), {"vdW energy"}},
                 {wrong_EI(1.25), {"twisting energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_7_short
