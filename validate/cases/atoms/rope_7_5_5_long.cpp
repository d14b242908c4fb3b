// Seven (5,5) tubes of twice the length: clamps count for less, torsion for more.
#include "cases/common/twisted_rope.hpp"

namespace ropewalk {

Case rope_7_5_5_long_case() {
  TwistedRope rope;
  rope.name = "rope-7-5-5-long";
  rope.parameters = "cnt-5-5-tersoff";
  rope.free_rows = 128;
  rope.band_rows = 8;
  rope.bonds = 26;
  rope.step = 18 * units::degree;
  rope.increments = 6;
  rope.elastic_increments = 6;
  return twisted_rope_case(rope, "(5,5)", "16.2");
}

}  // namespace ropewalk
