// A checkpoint that no run can have written is refused, whatever its checksum says.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

Simulation bundle() {
  Topology topology = test::published_topology();
  State state = test::disordered_bundle(topology, 3, 4, 1.8, 0.01, 1);
  state.time = 0.7071067811865476;
  return Simulation(topology, {}, {}, state, 0.01, 0.2);
}

std::string with(std::string bytes, double old, double value) {
  char pattern[sizeof old];
  std::memcpy(pattern, &old, sizeof old);
  const std::size_t at = bytes.find(std::string(pattern, sizeof pattern));
  EXPECT_NE(at, std::string::npos);
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

TEST(Checkpoint, WithNumbersThatNoRunHasIsRefused) {
  Simulation s = bundle();
  s.step();
  const std::string good = s.serialise();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(s.restore(good));
  EXPECT_THROW(s.restore(with(good, s.state().time, nan)), std::runtime_error);
  s.restore(good);
  EXPECT_THROW(s.restore(with(good, s.state().position.x[5], nan)), std::runtime_error);
  s.restore(good);
  EXPECT_THROW(s.restore(with(good, s.state().velocity.y[2], 1e300)), std::runtime_error);
  s.restore(good);
  EXPECT_THROW(s.restore(with(good, s.time_step(), 1e9)), std::runtime_error);
  EXPECT_THROW(s.restore(good.substr(0, good.size() - 1)), std::runtime_error);
  EXPECT_THROW(s.restore(good + "x"), std::runtime_error);
  s.restore(good);
  EXPECT_EQ(s.serialise(), good);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
