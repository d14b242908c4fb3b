#include "model/contract.hpp"

#include <gtest/gtest.h>

#include "sim/state/state.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

#ifdef NDEBUG
TEST(Contract, CostsNothingWhereItIsNotChecked) {
  int evaluated = 0;
  ROPEWALK_EXPECTS(++evaluated < 0);
  ROPEWALK_ENSURES(++evaluated < 0);
  EXPECT_EQ(evaluated, 0);
}
#else
TEST(Contract, ABrokenOneEndsTheProgramWithItsPlace) {
  const Vec3Array three(3);
  EXPECT_DEATH(three.x[3], "columns\\.hpp:[0-9]+: operator\\[\\] expects: i < size_");
  Topology topology;
  topology.add_tube(4);
  EXPECT_EQ(topology.tube_of(3), 0);
  EXPECT_DEATH(topology.tube_of(4), "state\\.cpp:[0-9]+: tube_of expects");
}
#endif

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
