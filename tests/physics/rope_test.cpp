// The untwisted rope of the published scenes: packing, spacing, cohesion; and the time step limit of a whole rope.
#include "scene/kinds/rope.hpp"

#include <gtest/gtest.h>

#include "io/parameters_toml.hpp"
#include "model/contact/paper.hpp"
#include "model/error.hpp"
#include "observe/observe.hpp"
#include "scene/prepare.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

Scene rope_scene(int tubes, double length, double perturbation = 0) {
  Scene scene;
  scene.sets = {read_parameters(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-10-10-paper.toml")};
  scene.element_length = scene.parameters().element_length;
  RopeSource rope;
  rope.tubes = tubes;
  rope.length = length;
  rope.perturbation = perturbation;
  scene.source = std::make_shared<RopeSource>(rope);
  scene.run.duration = 1;
  return scene;
}

TEST(UntwistedRope, IsPackedHexagonallyWithoutCharge) {
  Scene scene = rope_scene(91, 27.12, 5e-4);
  const Prepared p = prepare(scene);
  const RopeShells shells = rope_shells(p.topology, p.state, 0);
  const RopeObservation o = observe(p.topology, p.state, shells, {scene.parameters().validity}, 0, p.spacing);
  EXPECT_EQ(o.middle.charge, 0);
  EXPECT_EQ(o.middle.charge_delaunay, 0);
  EXPECT_EQ(o.middle.contacts, 240);  // 3 N - sqrt(12 N - 3)
  EXPECT_EQ(o.middle.voids, 0);
  EXPECT_EQ(o.kinked + o.overtwisted + o.overstretched, 0);
  EXPECT_NEAR(o.radius_mid, 5 * p.spacing + 0.678, 2e-3);
}

// One pair at its minimum: -2.19 eV/nm at 1.713 nm. A rope's tubes feel second neighbours as well, and its
// relaxed spacing is a little smaller.
TEST(UntwistedRope, SpacingAndCohesion) {
  Scene scene = rope_scene(91, 27.12);
  EXPECT_NEAR(pair_spacing(*scene.parameters().law<PaperContact>(), 1.356), 1.713, 1e-3);
  EXPECT_NEAR(paper_parallel_energy(*scene.parameters().law<PaperContact>(), 1.356, 1.713), -2.19, 0.01);

  // Difference of two lengths, so that the ends drop out.
  const auto vdw = [](double length) {
    Scene rope = rope_scene(91, length);
    const Prepared p = prepare(rope);
    return start(rope, p).forces().energy.vdw;
  };
  const double per_contact = (vdw(54.24) - vdw(27.12)) / (240 * 27.12);
  EXPECT_NEAR(per_contact, -2.217, 0.005);  // second neighbours add 1.2 %

  Scene small = rope_scene(19, 27.12);
  const Prepared p = prepare(small);
  Simulation s = start(small, p);
  ASSERT_TRUE(s.relax(1e-3, 20000, [](long) { return true; })) << s.largest_force();
  double nearest = 0;
  const int middle = 10;
  for (int t = 1; t <= 6; ++t)
    nearest += (s.state().position[static_cast<std::size_t>(p.topology.tube_begin[t] + middle)] -
                s.state().position[static_cast<std::size_t>(middle)])
                   .head<2>()
                   .norm() /
               6;
  EXPECT_NEAR(nearest, p.spacing, 0.01 * p.spacing);
  EXPECT_LT(nearest, p.spacing);
}

// The default step is stable for the whole rope, undamped and damped; so is 95 % of the stated limit.
TEST(UntwistedRope, TimeStepLimitHoldsForARope) {
  for (double viscosity : {0.0, 20.0}) {
    Scene scene = rope_scene(19, 13.56, 5e-3);
    scene.damping.contact.eta = viscosity;
    scene.damping.bond.rate = viscosity > 0 ? 1 : 0;
    Scene fast = scene;
    fast.run.time_step = 0.95 * prepare(scene).limit.limit;
    const Prepared p = prepare(fast);
    Simulation s = start(fast, p);
    const double first = s.total_energy();
    s.steps(3000);
    EXPECT_LT(s.total_energy() - first, 0.05 * std::fabs(first)) << "viscosity " << viscosity;
    fast.run.time_step = 1.01 * p.limit.limit;
    EXPECT_THROW(prepare(fast), InputError);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
