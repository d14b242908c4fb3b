// [failure]: scene/interactions/failure.cpp.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "io/log.hpp"
#include "model/error.hpp"
#include "model/units.hpp"
#include "run/events_file.hpp"
#include "run/limit_watch.hpp"
#include "run/moving_scene.hpp"
#include "run/run_directory.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

// One tube of sixty elements between two clamps that draw it out.
Scene chain(const std::string& failure, const std::string& more = "",
            const std::string& run = "duration_ps = 60\n") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 60\n"
      "[contact]\nlaw = \"none\"\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { strain = 0.06, "
      "rate_per_ps = 0.001 }\n" +
          failure + more + "[run]\n" + run,
      "failure.toml");
}
const std::string weak = "[failure]\nstrain = 0.03\nstrain_deviation = 0.002\nseed = 4\n";

Scene rope(const std::string& more = "", const std::string& run = "duration_ps = 60\ntime_step_fs = 16\n") {
  return scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 55\n"
      "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz = { strain = 0.06, rate_per_ps = 0.003 }\n" +
          weak + more + "[run]\n" + run,
      "failure.toml");
}

Simulation begun(Scene scene) {
  const Prepared p = prepare(scene);
  return start(scene, p);
}
double broken(const Simulation& s) { return s.term_accounts().at(0).events; }

TEST(Failure, BreaksATubeAtItsWeakestBondOnce) {
  // The pull adds a strain of 0.0015 while the break unloads the tube, and the second weakest bond bears 0.0018
  // more than the weakest. Without this damping the recoil breaks the tube in more places.
  Scene scene = chain("[failure]\nstrain = 0.03\nstrain_deviation = 0.002\nseed = 12\n",
                      "[damping]\nbond_damping_per_ps = 40\n");
  MovingScene m(scene);
  double largest = 0;
  while (m.state().time < 50 && broken(m.simulation) == 0) {
    m.simulation.step();
    largest = std::max(largest, m.row()["most_tension_nN"]);
  }
  ASSERT_EQ(broken(m.simulation), 1);
  EXPECT_GT(m.row()["ends_strain"], 0.02);
  EXPECT_LT(m.row()["ends_strain"], 0.031) << "the weakest of 59 bonds";
  EXPECT_GT(largest, 0.6 * 0.03 * 1519);
  m.simulation.steps(8000);
  EXPECT_EQ(broken(m.simulation), 1) << "nothing pulls the parts any more";
  const LogRow row = m.row();
  EXPECT_LT(std::fabs(row["most_tension_nN"]), 1);
  EXPECT_EQ(row["overstretched"], 0) << "a broken bond is no bond";
  EXPECT_EQ(row["kinked"], 0);
  EXPECT_EQ(row["bonds_broken"], 1);
  EXPECT_GT(row["failure_lost_eV"], 0);
  const Topology now = m.simulation.tubes_now();
  EXPECT_EQ(now.tubes(), 2);
  EXPECT_EQ(now.strands(), 1);
  const std::vector<TermEvent> events = m.simulation.term_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].what, "tube broke");
  EXPECT_EQ(events[0].a + 1, now.tube_begin[1]);
  EXPECT_EQ(events[0].b, now.tube_begin[1]);
}

TEST(Failure, BrokenBondsActAsEndsOfTubes) {
  Scene scene = rope();
  Simulation s = begun(scene);
  while (s.state().time < 60 && broken(s) < 3) s.step();
  ASSERT_GE(broken(s), 3);
  const Topology cut = s.tubes_now();
  // Bonds of tubes that were cut there from the start.
  Interaction bare = s.interaction();
  bare.law = nullptr;
  bare.terms.clear();
  bare.term_reach = 0;
  Forces plain(s.state().size());
  NeighbourList none;
  ForceEngine engine;
  engine.compute(cut, bare, none, s.state(), plain, {Parts::bonds});
  EXPECT_NEAR(s.forces().energy.bonds(), plain.energy.bonds(), 1e-9 * plain.energy.bonds());
  Interaction with = s.interaction();
  with.law = nullptr;
  with.damping = {};
  bare.damping = {};
  NeighbourList list(with, 0.1);
  list.build(s.topology(), s.state());
  ForceEngine failing;
  failing.set_memory(with, s.memory(), s.topology().elements());
  Forces broken_bonds(s.state().size());
  failing.compute(s.topology(), with, list, s.state(), broken_bonds);
  engine.compute(cut, bare, none, s.state(), plain, {Parts::bonds});
  for (std::size_t i = 0; i < s.state().size(); ++i) {
    EXPECT_LT((broken_bonds.force[i] - plain.force[i]).norm(), 1e-9) << i;
    EXPECT_LT((broken_bonds.torque[i] - plain.torque[i]).norm(), 1e-9) << i;
  }
}

TEST(Failure, TheAccountStaysClosed) {
  Scene scene = rope("[contact]\nprecision = \"double\"\n", "duration_ps = 60\ntime_step_fs = 8\n");
  Simulation s = begun(scene);
  const double total = s.total_energy();
  while (s.state().time < 15) {
    s.step();
    ASSERT_NEAR(s.total_energy() - s.account().supplied(), total, 0.01 * (1 + s.work())) << s.state().time;
  }
  EXPECT_GE(broken(s), 3);
  EXPECT_GT(s.term_accounts().at(0).lost, 1);
}

TEST(Failure, SameBitsOnAnyThreadsAndAfterResume) {
  Scene scene = rope();
  const long steps = 960, every = 240;
  omp_set_num_threads(1);
  Simulation whole = begun(scene);
  std::vector<std::string> saved;
  for (long n = 0; n < steps; ++n) {
    if (n % every == 0) saved.push_back(whole.serialise());
    whole.step(n % 100 == 99);
  }
  EXPECT_GT(broken(whole), 3);
  const std::string end = whole.serialise();
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    Simulation other = begun(scene);
    for (long n = 0; n < steps; ++n) other.step(n % 100 == 99);
    EXPECT_EQ(other.serialise(), end) << threads;
  }
  for (std::size_t at = 0; at < saved.size(); ++at) {
    Simulation resumed = begun(scene);
    resumed.restore(saved[at]);
    EXPECT_EQ(resumed.serialise(), saved[at]);
    for (long n = every * static_cast<long>(at); n < steps; ++n) resumed.step(n % 100 == 99);
    EXPECT_EQ(resumed.serialise(), end) << at;
  }
}

TEST(Failure, BreaksWhereATubeIsBentTooFar) {
  Scene scene = scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 30\n"
      "[contact]\nlaw = \"none\"\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nx = "
      "\"free\"\nz = \"free\"\nabout_y = { rotation_deg = 120, rate_deg_per_ps = 2 }\n[failure]\nmoment_nN_nm = "
      "15\n"
      "[run]\nduration_ps = 60\n",
      "failure.toml");
  Simulation s = begun(scene);
  while (s.state().time < 60 && broken(s) == 0) s.step();
  EXPECT_GE(broken(s), 1);
}

// Without [failure] the run ends there.
TEST(Failure, BreaksWhereATubeIsTwistedTooFar) {
  const auto twisted = [](const std::string& failure) {
    return scene_of_text(
        "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 6\n[bond]\nlaw = "
        "\"harmonic\"\n[contact]\nlaw = \"none\"\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nabout_z = "
        "{ rotation_deg = 600, rate_deg_per_ps = 20 }\n" +
            failure + "[run]\nduration_ps = 40\n",
        "failure.toml");
  };
  Simulation s = begun(twisted("[failure]\nstrain = 0.06\n"));
  const auto largest_twist = [&s] {
    double most = 0;
    const State& state = s.state();
    for (std::size_t i = 0; i + 1 < state.size(); ++i)
      most = std::max(
          most, std::fabs(bond_twist_angle(frame_of(state.orientation[i]), frame_of(state.orientation[i + 1]))));
    return most;
  };
  double before = 0;
  while (s.state().time < 40 && broken(s) == 0) before = largest_twist(), s.step();
  const double at_once = broken(s);  // bonds that are twisted alike break together
  EXPECT_GE(at_once, 1);
  EXPECT_NEAR(before, 0.5 * units::pi, 0.02);
  s.steps(100);
  EXPECT_EQ(s.tubes_now().tubes(), 1 + at_once);
  Simulation whole = begun(twisted(""));
  EXPECT_THROW(whole.steps(100000), NumericalError);
}

// The pressure on the tubes of the scene, whatever has become of them.
TEST(Failure, LimitsAreThoseOfTheTubesOfTheScene) {
  Scene scene = rope();
  MovingScene m(scene);
  LimitWatch watch(watched_by_run(m.scene, m.prepared, m.observer));
  while (m.state().time < 60 && broken(m.simulation) < 5) m.simulation.step();
  m.simulation.steps(200);
  watch.check(m.prepared.topology, m.simulation.tubes_now(), m.state(), m.simulation.list(), {}, true);
  for (const LimitRecord& r : watch.records()) {
    EXPECT_LT(r.tube, 7) << r.key;
    EXPECT_LT(r.largest, 1e3) << r.key;
  }
}

// What a stored frame and events.csv tell is what the run knew.
TEST(Failure, StoredEventsCutTheTubesAgain) {
  Scene scene = rope();
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  while (s.state().time < 60 && broken(s) < 4) s.step();
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "failure-events.csv";
  std::ofstream(file) << events_csv(p.topology, s.term_events());
  const StoredEvents breaks(file.string(), p.topology);
  EXPECT_TRUE(breaks.any_breaks());
  const Topology now = breaks.tubes_at(s.state().time), true_now = s.tubes_now();
  EXPECT_EQ(now.tube_begin, true_now.tube_begin);
  EXPECT_EQ(now.groups.strand_begin, true_now.groups.strand_begin);
  const double second = s.term_events()[1].time;
  EXPECT_EQ(breaks.tubes_at(second - 1e-3).tubes(), 8) << "after the first break";
  EXPECT_EQ(breaks.tubes_at(0).tubes(), 7);
  EXPECT_FALSE(StoredEvents(file.string() + "-none", p.topology).any_breaks());
  for (const char* line : {"1,tube broke,7,0,7,1,0,0,0\n", "1,tube broke,0,79,0,80,0,0,0\n", "1,tube broke,0\n",
                           "x,tube broke,0,0,0,1,0,0,0\n"}) {
    std::ofstream(file) << events_csv(p.topology, {}) << line;
    EXPECT_THROW(StoredEvents(file.string(), p.topology), InputError) << line;
  }
  std::filesystem::remove(file);
}

// Strains at which tubes of one length break first: those of Weibull's law, in elements of any length.
TEST(Failure, ATubeIsAsStrongInElementsOfAnyLength) {
  constexpr double own = 1.3775870846515064, mean = 0.04, deviation = 0.004;
  for (const double length : {0.5 * own, own, 2 * own}) {
    Scene scene = scene_of_text(
        fmt::format(
            "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\nelement_length_nm = {:.17g}\n"
            "[rope]\ntubes = 400\npacking = \"round\"\nlength_nm = {:.17g}\n[contact]\nlaw = \"none\"\n"
            "[failure]\nstrain = {}\nstrain_deviation = {}\nreference_length_nm = {:.17g}\n[run]\n"
            "duration_ps = 1\n",
            length, 20 * own + length, mean, deviation, 20 * own),
        "failure.toml");
    const Prepared p = prepare(scene);
    const std::unique_ptr<ForceTerm> term = p.interaction.terms.at(0)->copy();
    std::vector<double> broke(400, 0);
    State s = p.state;
    for (double strain = 0.02; std::count(broke.begin(), broke.end(), 0) > 0; strain += 0.0002) {
      ASSERT_LT(strain, 0.08);
      for (std::size_t i = 0; i < s.size(); ++i) s.position.z[i] = (1 + strain) * p.state.position.z[i];
      term->advance(0, s);
      for (const TermRecord& r : term->memory())
        if (double& first = broke[static_cast<std::size_t>(p.topology.tube_of(r.element))]; first == 0)
          first = strain;
    }
    double sum = 0, squares = 0;
    for (const double strain : broke) sum += strain, squares += strain * strain;
    const double seen = sum / 400, scatter = std::sqrt(squares / 400 - seen * seen);
    EXPECT_NEAR(seen, mean, 4 * deviation / 20) << length;
    EXPECT_NEAR(scatter, deviation, 0.15 * deviation) << length;
  }
}

// Of a tube in elements of two, one and half a diameter that is strained everywhere alike but for one place, which
// is as long as half a diameter: the strain over a diameter counts.
TEST(Failure, TheStrainOverADiameterCounts) {
  constexpr double own = 1.3775870846515064;
  for (const double length : {0.5 * own, own, 2 * own}) {
    Scene scene = scene_of_text(
        fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\nelement_length_nm = "
                    "{:.17g}\n[chain]\nelements = 21\n[contact]\nlaw = \"none\"\n[failure]\nstrain = 0.05\n"
                    "[run]\nduration_ps = 1\n",
                    length),
        "failure.toml");
    const Prepared p = prepare(scene);
    const auto breaks = [&](double strain, double more) {
      State s = p.state;
      for (std::size_t i = 0; i < s.size(); ++i)
        s.position.z[i] = (1 + strain) * p.state.position.z[i] + (i > 10 ? more : 0);
      const std::unique_ptr<ForceTerm> term = p.interaction.terms.at(0)->copy();
      return term->advance(0, s).events;
    };
    EXPECT_EQ(breaks(0.0499, 0), 0) << length;
    EXPECT_EQ(breaks(0.0501, 0), 20) << length;
    // 0.02 of a diameter more: reached where the rest is strained by 0.03, or by 0.04 in elements of two diameters.
    const double others = length > 1.5 * own ? 0.04 : 0.03;
    EXPECT_EQ(breaks(others - 0.001, 0.02 * own), 0) << length;
    EXPECT_GT(breaks(others + 0.001, 0.02 * own), 0) << length;
  }
}

TEST(Failure, BadOnesAreRefused) {
  const auto message = [](const std::string& failure, const std::string& more = "") -> std::string {
    try {
      Scene scene = chain(failure, more);
      const Prepared p = prepare(scene);
      return "none";
    } catch (const InputError& e) {
      return e.what();
    }
  };
  EXPECT_THAT(message("[failure]\n"), HasSubstr("strain: is missing"));
  EXPECT_THAT(message("[failure]\nstrain = 0\n"), HasSubstr("strain"));
  EXPECT_THAT(
      message("[failure]\nstrain = 0.3\n"),
      HasSubstr("failure.toml:13: failure.strain: is 0.3, and the bonds of cnt-10-10-tersoff follow its atoms "
                "up to 0.26"));
  EXPECT_THAT(message("[failure]\nstrain = 0.16\n", "[bond]\nlaw = \"harmonic\"\n"),
              HasSubstr("up to 0.0686; leave [bond] law out, or take at most 0.0686"));
  EXPECT_THAT(message("[failure]\nfrom = \"atoms\"\n", "[bond]\nlaw = \"harmonic\"\n"),
              HasSubstr("is \"atoms\", and the bonds are harmonic"));
  EXPECT_THAT(message("[failure]\nfrom = \"atoms\"\nstrain = 0.1\n"), HasSubstr("stands beside from"));
  EXPECT_THAT(message("[failure]\nmoment_nN_nm = 15\nstrain_deviation = 0.01\n"), HasSubstr("without strain"));
  EXPECT_EQ(message("[failure]\nfrom = \"atoms\"\n"), "none");
  EXPECT_EQ(message("[failure]\nmoment_nN_nm = 15\n"), "none");
  EXPECT_THAT(message("[failure]\nstrain = 0.05\nstrain_deviation = 0.05\n"), HasSubstr("take at most 0.017"));
  EXPECT_THAT(log_header(), HasSubstr(",failure_lost_eV,bonds_broken"));
  EXPECT_THAT(log_header(), ::testing::Not(HasSubstr("failure_eV")));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
