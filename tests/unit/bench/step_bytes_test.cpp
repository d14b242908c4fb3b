#include "bench/step_bytes.hpp"

#include <gtest/gtest.h>

#include "sim/contact/line/list.hpp"
#include "sim/contact/paper/law.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// Without contact the state alone, read and written; with it the axes and the list besides.
TEST(StepBytes, AreOfTheStateAndOfWhatIsListed) {
  Topology topology = test::published_topology();
  const State state = test::disordered_bundle(topology, 7, 40, 1.75, 0.02, 21);
  const auto per_element = [&](const Interaction& in) {
    return step_bytes(Simulation(topology, in, {}, state, 1e-3)) / topology.elements();
  };
  constexpr double alone = 2 * 13 * 8, axes = 2 * 3 * 8;
  EXPECT_EQ(per_element({}), alone);
  Interaction line, paper;
  line.law = line_law({test::line_contact(0.6785, 6, 0.6785, 6)});
  line.precision = Interaction::Precision::mixed;
  paper.law = paper_law(test::published_contact());
  // One chunk, whose buffers have each element once, and some room.
  const double mixed = per_element(line);
  EXPECT_GT(mixed, alone + axes + 2 * 6 * sizeof(float));
  line.precision = Interaction::Precision::full;
  EXPECT_NEAR(per_element(line) - mixed, 2 * 6 * sizeof(float), 4);
  EXPECT_GT(per_element(paper), alone + axes + 2 * 6 * sizeof(double) + 2 * 6 * sizeof(float));
  // The local damping stores all forces; the list has runs of some kind or other.
  Interaction braked;
  braked.damping.local = 0.1;
  EXPECT_EQ(per_element(braked), alone + 2 * 6 * 8);
  line.exclude_along_tube = 20 * test::element_length;
  Interaction apart = line;
  LineContact shorter = test::line_contact(0.6785, 6, 0.6785, 6);
  shorter.density = with_cutoff(shorter.density, 1.6);
  apart.law = line_law({shorter});
  EXPECT_GT(per_element(line), per_element(apart) + 0.5 * sizeof(NeighbourSpan));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
