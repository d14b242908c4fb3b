// Seven tubes, so short that the bending at the clamps takes a sixth of the energy.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk::validate::rope_7_short {
namespace {

const RegisteredCase registered([] {
  RopeComparison rope;
  rope.name = "rope-7-short";
  rope.length = 8;
  Case c = twisted_rope_case(rope);
  c.order = 70;
  c.sets = {"cnt-5-5-tersoff", "cnt-10-10-tersoff"};
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}},
                 {wrong_contact(2), {"vdW energy"}},
                 {wrong_EI(1.25), {"twisting energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_7_short
