// Which moves and turns of the whole scene statics leaves out.
#include "sim/statics/allowed_motions.hpp"

#include <gtest/gtest.h>

#include "scene/ends/twist.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/force.hpp"
#include "sim/contact/line/law.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Rope {
  Topology topology = test::published_topology();
  State state = test::disordered_bundle(topology, 4, 9, 1.72, 0.03, 3);
  LoadsAndConstraints loads;

  std::size_t left_out() const {
    State at_rest = state;
    at_rest.velocity.set_to_zero();
    at_rest.angular_velocity.set_to_zero();
    Interaction in;
    in.law = line_law({test::line_contact(0.6785, 5, 0.6785, 5)});
    return AllowedMotions(Simulation(topology, in, loads, at_rest, 0.01)).wholes().size();
  }
};

TEST(AllowedMotions, TurnsWithoutTorqueInAnyStateAreLeftOut) {
  EXPECT_EQ(Rope().left_out(), 6u) << "nothing holds it";
  Rope twisted;
  TwistLoad twist;
  twist.moment = 80;
  add_twist(twist, twisted.topology, twisted.loads);
  EXPECT_EQ(twisted.left_out(), 6u) << "couples of fixed direction cancel, however the rope is bent";
  Rope drawn;
  for (int t = 0; t < 4; ++t) {
    drawn.loads.add(ForceLoad({9 * t}, {0, 0, -1}));
    drawn.loads.add(ForceLoad({9 * t + 8}, {0, 0, 1}));
  }
  EXPECT_EQ(drawn.left_out(), 4u) << "a tension draws a tilted rope back";
  Rope fixed;
  fixed.loads.add(FixLoad({0}));
  EXPECT_EQ(fixed.left_out(), 0u);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
