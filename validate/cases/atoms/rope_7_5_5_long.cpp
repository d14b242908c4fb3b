// Seven (5,5) tubes of twice the length: the clamps count for less, torsion for more.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk {
namespace {

const RegisteredCase registered([] {
  TwistedRope rope;
  rope.name = "rope-7-5-5-long";
  rope.parameters = "cnt-5-5-tersoff";
  rope.free_rows = 128;
  rope.band_rows = 8;
  rope.bonds = 26;
  rope.step = 18 * units::degree;
  rope.increments = 6;
  rope.elastic_increments = 6;
  Case c = twisted_rope_case(rope, "(5,5)", "16.2");
  c.order = 80;
  c.turns_red = {{wrong_GJ(0.9), {"twisting energy"}}, {wrong_contact(2), {"vdW energy"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk
