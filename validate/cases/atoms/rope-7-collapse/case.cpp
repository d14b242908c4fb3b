// The rope of rope-7-short, twisted beyond the collapse of its walls.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk::validate::rope_7_collapse {
namespace {

const RegisteredCase registered([] {
  RopeComparison rope;
  rope.name = "rope-7-collapse";
  rope.length = 8;
  rope.shear = 0.089;
  rope.increments = 12;
  rope.collapsed = {45, 60};
  rope.axial_free = {false};
  Case c = twisted_rope_case(rope);
  c.order = 90;
  c.only_these =
      "it compares with stored atoms of (10,10), an hour of LAMMPS; other tubes collapse at other angles";
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_7_collapse
