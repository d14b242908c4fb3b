// Seven (10,10) tubes: wider than (5,5), flatter where they touch, and bound twice as strongly.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk {
namespace {

const RegisteredCase registered([] {
  Case c = twisted_rope_case(rope_7_10_10(), "(10,10)", "8.1");
  c.order = 90;
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}, {wrong_contact(2), {"vdW energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk
