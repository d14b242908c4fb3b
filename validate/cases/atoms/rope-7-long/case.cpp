// Seven tubes of twice the length of rope-7-short, in which the clamps count for less.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk::validate::rope_7_long {
namespace {

const RegisteredCase registered([] {
  RopeComparison rope;
  rope.name = "rope-7-long";
  rope.length = 16;
  Case c = twisted_rope_case(rope);
  c.order = 80;
  c.sets = {"cnt-5-5-tersoff"};
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}, {wrong_contact(2), {"vdW energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_7_long
