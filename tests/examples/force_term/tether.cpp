// The worked example of docs/how-to/force-term.md: [[tether]] (mdem/scene/interactions/tether.cpp), a force term with a memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "io/log.hpp"
#include "model/error.hpp"
#include "scene/finer.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/refine.hpp"

namespace ropewalk {
namespace {

using ::testing::HasSubstr;

constexpr double k = 0.4 * units::nN_nm;  // eV/nm^2

// Seven tubes of ten elements; `tethers` between them.
Scene rope(const std::string& tethers, const std::string& run = "duration_ps = 5\n", const std::string& more = "") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 6.89\n" + more +
          tethers + "[run]\n" + run,
      "tether.toml");
}

std::string tether(const std::string& ends, const std::string& more = "") {
  return "[[tether]]\n" + ends + "stiffness_nN_per_nm = 0.4\n" + more;
}
const std::string between = "tube = 1\nelements = [-1]\nto_tube = 4\nto_elements = [0, 1]\n",
                  to_point = "tube = 2\nelements = [3]\nto_point_nm = [4, 1, 2]\n";
// A load draws the rope away from the point until the tether breaks.
const std::string breaking =
    tether(to_point, "breaks_at_nm = 3.5\n") +
    "[[load]]\nkind = \"force\"\nelements = \"all\"\nforce_nN = [-1.5, 0, 0]\n";

Simulation simulation_of(Scene scene) {
  const Prepared p = prepare(scene);
  return start(scene, p);
}

Forces forces_of_terms(const Prepared& p, const State& state) {
  Interaction in = p.interaction;
  in.law = nullptr;
  in.damping = {};
  NeighbourList list(in, 0.1);
  list.build(p.topology, state);
  ForceEngine engine;
  Forces with(state.size()), without(state.size());
  engine.compute(p.topology, in, list, state, with);
  in.terms.clear();
  ForceEngine bonds;
  bonds.compute(p.topology, in, list, state, without);
  for (std::size_t i = 0; i < state.size(); ++i) {
    with.force.add(i, -without.force[i]);
    with.torque.add(i, -without.torque[i]);
  }
  return with;
}

TEST(Tether, ForcesAreTheGradientOfItsEnergyAndBalance) {
  Scene scene = rope(tether(between, "rest_nm = 2\n") + tether(to_point, "rest_nm = 1\n"));
  const Prepared p = prepare(scene);
  const Forces at = forces_of_terms(p, p.state);
  EXPECT_GT(at.energy.terms, 1);
  ASSERT_EQ(at.term_energy.size(), 2u);
  EXPECT_NEAR(at.term_energy[0] + at.term_energy[1], at.energy.terms, 1e-12);
  double largest = 0;
  for (std::size_t i = 0; i < p.state.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto energy = [&](double by) {
        State moved = p.state;
        Vector3 x = moved.position[i];
        x[axis] += by;
        moved.position.set(i, x);
        return forces_of_terms(p, moved).energy.terms;
      };
      constexpr double h = 1e-4;
      EXPECT_NEAR(at.force[i][axis], -(energy(h) - energy(-h)) / (2 * h), 1e-6) << i;
      largest = std::max(largest, std::fabs(at.force[i][axis]));
      EXPECT_EQ(at.torque[i][axis], 0) << i << " and no couples";
    }
  EXPECT_GT(largest, 1);
  Scene closed = rope(tether(between, "rest_nm = 2\n"));
  const Prepared alone = prepare(closed);
  const Forces f = forces_of_terms(alone, alone.state);
  const NetForce net = net_force(alone.state, f);
  EXPECT_LT(net.force.norm(), 1e-10);
  EXPECT_LT(net.torque.norm(), 1e-9);
}

TEST(Tether, IsThatOfItsFormulaAndOfTheReference) {
  Scene scene = rope(tether(to_point, "rest_nm = 1\n"));
  const Prepared p = prepare(scene);
  const Simulation s = start(scene, p);
  const auto i = static_cast<std::size_t>(p.topology.tube_begin[2] + 3);
  const Vector3 apart = Vector3(4, 1, 2) - p.state.position[i];
  EXPECT_NEAR(s.forces().energy.terms, 0.5 * k * std::pow(apart.norm() - 1, 2), 1e-12);
  const Forces f = forces_of_terms(p, p.state);
  EXPECT_LT((f.force[i] - k * (1 - 1 / apart.norm()) * apart).norm(), 1e-10);
  Forces plain;
  compute_reference(p.topology, p.interaction, p.state, plain);
  EXPECT_NEAR(plain.energy.terms, s.forces().energy.terms, 1e-12);
  EXPECT_NEAR(plain.energy.potential(), s.forces().energy.potential(), 1e-4);
}

TEST(Tether, IsAtRestAsItStartsWhereNoLengthIsTyped) {
  EXPECT_EQ(simulation_of(rope(tether(between))).forces().energy.terms, 0);
}

TEST(Tether, TheAccountOfEnergyStaysClosedAlsoWhereOneBreaks) {
  const auto run = [](const std::string& tethers) {
    Simulation s = simulation_of(rope(tethers, "duration_ps = 20\ntime_step_fs = 4\n", "[contact]\nprecision = \"double\"\n"));
    const double total = s.total_energy(), first = s.forces().energy.terms;
    bool broke = false;
    for (int n = 0; n < 1000; ++n) {
      const double before = s.forces().energy.terms;
      s.step();
      broke = broke || (before > 0 && s.forces().energy.terms == 0);
      EXPECT_NEAR(s.total_energy() - s.account().supplied(), total, 2e-3 * (1 + first + s.work())) << n;
    }
    EXPECT_GT(s.dissipated(), 0.01);
    const TermAccount account = s.term_accounts().at(0);
    EXPECT_EQ(account.events, broke ? 1 : 0);
    EXPECT_EQ(account.lost > 0, broke);
    EXPECT_LE(account.lost, s.dissipated());
    return broke;
  };
  EXPECT_FALSE(run(tether(to_point, "rest_nm = 1\n")));
  EXPECT_TRUE(run(breaking));
}

const std::string strong_then_weak = tether(between, "rest_nm = 6\n") + breaking;

TEST(Tether, SameBitsOnAnyThreadsAndAfterResume) {
  Scene scene = rope(strong_then_weak, "duration_ps = 20\ntime_step_fs = 8\n", "[start]\ntemperature_K = 300\nmay_cool = true\n");
  omp_set_num_threads(1);
  Simulation whole = simulation_of(scene);
  std::vector<std::string> saved;
  int broken_at = -1;
  for (int n = 0; n < 400; ++n) {
    if (n % 50 == 0) saved.push_back(whole.serialise());
    whole.step(n % 50 == 49);
    if (broken_at < 0 && whole.forces().term_energy[1] == 0) broken_at = n;
  }
  ASSERT_GT(broken_at, 60) << "before and after some checkpoints";
  ASSERT_LT(broken_at, 300);
  const std::string end = whole.serialise();
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    Simulation other = simulation_of(scene);
    for (int n = 0; n < 400; ++n) other.step(n % 50 == 49);
    EXPECT_EQ(other.serialise(), end) << threads;
  }
  for (std::size_t at = 0; at < saved.size(); ++at) {
    Simulation resumed = simulation_of(scene);
    resumed.restore(saved[at]);
    EXPECT_EQ(resumed.serialise(), saved[at]);
    for (int n = 50 * static_cast<int>(at); n < 400; ++n) resumed.step(n % 50 == 49);
    EXPECT_EQ(resumed.serialise(), end) << at;
  }
  std::string damaged = saved.back();
  EXPECT_THROW(simulation_of(rope(tether(between))).restore(damaged), std::runtime_error) << "another scene's memory";
}

// The tether stays where it holds the tubes, and it remembers its length and that it is broken.
TEST(Tether, IsCarriedOverWhereElementsAreSplit) {
  Scene coarse = rope(strong_then_weak, "duration_ps = 20\n");
  const Prepared p = prepare(coarse);
  Simulation s = start(coarse, p);
  for (const int steps : {3, 60}) {
    s.steps(steps);
    Scene finer = scene_of_text(finer_scene_text(coarse, p, "finer"), "finer.toml");
    Prepared q = prepare(finer);
    q.state = halved(p.topology, s.state(), splitting_of(coarse));
    Simulation split = start(finer, q);
    split.set_memory(s.halved_memory(heirs(p.topology, splitting_of(coarse))));
    const std::vector<double>&before = s.forces().term_energy, &after = split.forces().term_energy;
    ASSERT_EQ(after.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) EXPECT_NEAR(after[t], before[t], 1e-9) << steps;
    EXPECT_EQ(before[1] == 0, steps > 3);
    EXPECT_GT(before[0], 0.01);
  }
}

// Two parallel tethers of one chain: a straight tube hangs between its clamp and the point.
TEST(Tether, RelaxesToTheBalanceOfABeamAndATether) {
  Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 21\n[contact]\nlaw = "
      "\"none\"\n[[load]]\nkind = \"fix\"\nelements = [0]\n[[tether]]\ntube = 0\nelements = [-1]\nto_point_nm = [20, 0, "
      "13.7758708]\nstiffness_nN_per_nm = 0.02\nrest_nm = 19\n[run]\nmode = \"relax\"\nforce_tolerance_nN = 1e-8\n",
      "tether.toml");
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  ASSERT_TRUE(s.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; }));
  const TubeType& tube = p.topology.types[0];
  const double length = 20 * tube.element_length, spring = 0.02 * units::nN_nm;
  double compliance = std::pow(length, 3) / (3 * tube.bond.bend);
  if (tube.bond.shear > 0) compliance += length / tube.bond.shear;
  const double expected = spring * compliance / (1 + spring * compliance);  // of the 1 nm by which it is stretched
  EXPECT_NEAR(s.state().position.x[20] / expected, 1, 2e-3);
}

// A tether stiffer than the bonds: the automatic step stays below its mode.
TEST(Tether, LowersTheStabilityLimit) {
  Scene soft = rope(tether(between)), stiff = rope("[[tether]]\n" + between + "stiffness_nN_per_nm = 5000\n");
  const Prepared a = prepare(soft), b = prepare(stiff);
  EXPECT_LT(b.limit.limit, 0.7 * a.limit.limit);
  Simulation s = start(stiff, b);
  const double total = s.total_energy();
  s.steps(2000);
  EXPECT_NEAR(s.total_energy() - s.account().supplied(), total, 0.05 * std::fabs(total));
}

TEST(Tether, HasItsColumnInTheLog) {
  EXPECT_THAT(log_header(), HasSubstr(",tether_eV"));
  EXPECT_THAT(scene_key_help(), HasSubstr("[[tether]]"));
  Scene scene = rope(tether(to_point, "rest_nm = 1\n"));
  Simulation s = simulation_of(scene);
  const auto readings = term_readings(s.interaction(), s.forces().term_energy, s.term_accounts());
  EXPECT_EQ(readings.at("tether").energy, s.forces().energy.terms);
}

TEST(Tether, BadOnesAreRefused) {
  const auto message = [](const std::string& tethers) -> std::string {
    try {
      Scene scene = rope(tethers);
      prepare(scene);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(message(tether("tube = 1\nelements = [0]\n")), HasSubstr("tether.to_point_nm: is missing"));
  EXPECT_THAT(message(tether(between + "to_point_nm = [0, 0, 0]\n")), HasSubstr("a tether has two ends"));
  EXPECT_THAT(message(tether("tube = 1\nelements = [0, 0]\nto_point_nm = [0, 0, 0]\n")), HasSubstr("names 0 twice"));
  EXPECT_THAT(message(tether("tube = 1\nelements = [-1, 4]\nto_point_nm = [0, 0, 0]\n")), HasSubstr("4 is an element of tube 1 that is named already"));
  EXPECT_THAT(message(tether("tube = 7\nelements = [0]\nto_point_nm = [0, 0, 0]\n")), HasSubstr("there is no tube 7"));
  EXPECT_THAT(message(tether("tube = 1\nelements = [10]\nto_point_nm = [0, 0, 0]\n")), HasSubstr("tube 1 has no element 10"));
  EXPECT_THAT(message(tether(to_point, "rest_nm = 3\nbreaks_at_nm = 2\n")), HasSubstr("tether.breaks_at_nm"));
  EXPECT_THAT(message("[[tether]]\n" + to_point), HasSubstr("tether.stiffness_nN_per_nm: is missing"));
}

}  // namespace
}  // namespace ropewalk
