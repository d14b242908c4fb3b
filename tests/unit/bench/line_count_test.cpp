#include "bench/line_count.hpp"

#include <gtest/gtest.h>

#include "sim/contact/line/engine.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/simulation.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// A sheet of tubes as long as twice the distance between samples: their ends, which cost more, are no more frequent
// among these than among all.
TEST(RadialCount, OfSomeElementsIsThatOfAll) {
  constexpr int tubes = 200, elements = 40;
  Topology topology = test::published_topology();
  for (int t = 0; t < tubes; ++t) topology.add_tube(elements);
  State state(static_cast<std::size_t>(topology.elements()));
  for (int t = 0, i = 0; t < tubes; ++t)
    for (int e = 0; e < elements; ++e, ++i)
      state.position.set(static_cast<std::size_t>(i), Vector3(1.75 * t, 0, e * topology.types[0].element_length));
  Interaction in;
  in.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  in.exclude_along_tube = 3 * test::element_length;
  const Simulation rope(topology, in, {}, state, 1e-3);
  const auto count = [&](int most) {
    return count_radial(rope.topology(), rope.interaction(), rope.state(), rope.list(),
                        dynamic_cast<const LineEngine&>(*rope.engine().contact()).list(), most);
  };
  const RadialCount all = count(topology.elements()), some = count(topology.elements() / 20);
  EXPECT_NEAR(some.evaluations, all.evaluations, 0.05 * all.evaluations);
  EXPECT_NEAR(some.useful, all.useful, 0.05 * all.useful);
  EXPECT_NEAR(some.spans, all.spans, 0.05 * all.spans);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
