#include "bench/machine_peak.hpp"

#include <gtest/gtest.h>

#include "bench/step_bytes.hpp"
#include "sim/contact/line/list.hpp"
#include "sim/contact/paper/law.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// Each chain tends to 0.25 / (1 - 0.5), and the sum of all is left.
template <class T>
void expect_work() {
  T out[64 / sizeof(T)] = {};
  const std::size_t once = multiply_adds(100, T{0.5}, out);
  EXPECT_EQ(out[0], T{6});
  EXPECT_EQ(once % (100 * 12 * 2), 0u);
  EXPECT_EQ(multiply_adds(200, T{0.5}, out), 2 * once);
}

TEST(MachinePeak, LoopsDoWhatTheyCount) {
  expect_work<float>();
  expect_work<double>();
  alignas(64) double a[16], b[16], c[16];
  for (int k = 0; k < 16; ++k) b[k] = k, c[k] = 2 * k;
  triad(a, b, c, 16);
  for (int k = 0; k < 16; ++k) EXPECT_EQ(a[k], 7 * k);
}

TEST(MachinePeak, IsFound) {
  const MachinePeak peak = machine_peak(1, false);
  EXPECT_GT(peak.arithmetic, 0);
  EXPECT_GT(peak.transfer, 0);
}

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
