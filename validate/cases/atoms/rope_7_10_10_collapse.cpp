// The rope of rope_7_10_10.cpp, twisted beyond the collapse of its walls.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk {
namespace {

const RegisteredCase registered([] {
  Case c = twisted_rope_case(collapsed_rope_7_10_10(), "(10,10)", "8.1");
  c.order = 95;
  c.title = "Twisted 7-tube rope of (10,10) beyond the collapse of its walls";
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk
