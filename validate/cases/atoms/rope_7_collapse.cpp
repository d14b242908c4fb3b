// The rope of rope_7_short.cpp, twisted beyond the collapse of its walls.
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
  rope.remarks = {
      "Beyond `r tau = 0.04` the walls collapse. The bond's torque is constant from there, at the twist at which a "
      "clamped tube of this length collapses; its energy is compared within 10 %."};
  Case c = twisted_rope_case(rope, "Twisted 7-tube rope of {tube}, 8 nm, beyond the collapse");
  c.order = 90;
  c.only_these =
      "it compares with stored atoms of (10,10), an hour of LAMMPS; other tubes collapse at other angles";
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::rope_7_collapse
