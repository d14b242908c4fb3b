// A scene that starts from the final state of a run restores the states of its force terms, and has other noise.
#include "scene/state_memory.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"
#include "run/moving_scene.hpp"
#include "scene/kinds/state.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/single_state.hpp"
#include "scene/state_files.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string head = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n";
const std::string still = "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 3\n";
const std::string clamps = "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n";
const std::string run = "[run]\nduration_ps = 20\n";

class StateOfAnEnd : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / fmt::format("ropewalk-memory-{}", getpid());
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

  std::string path(const std::string& name) const { return (dir_ / name).string(); }
  Scene scene(const std::string& text) const { return scene_of_text(head + text, path("scene.toml")); }
  // [state] end.csv, and more.
  Scene next(const std::string& more) const { return scene("[state]\nfile = \"end.csv\"\n" + more); }
  Simulation begun(const std::string& more) const {
    Scene of = next(more);
    return start(of, prepare(of));
  }
  std::string refusal(const std::string& more) const {
    try {
      begun(more);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  void write_end(const Simulation& s, const std::string& as = "end.csv") const {
    const StateFiles files = state_files(s, path(as));
    write_file_atomically(path(as), files.state);
    if (!files.memory.empty()) write_file_atomically(memory_path_of(path(as)), files.memory);
  }
  // At its end, with the energies there.
  Simulation ended(const std::string& text, long steps) const {
    Scene of = scene(text);
    Simulation s = start(of, prepare(of));
    s.steps(steps);
    write_end(s);
    return s;
  }
  static void expect_same_energies(const Simulation& now, const Simulation& then) {
    const Energies &a = now.forces().energy, &b = then.forces().energy;
    EXPECT_NEAR(a.terms, b.terms, 1e-9 * (1 + std::fabs(b.terms)));
    EXPECT_NEAR(a.bonds(), b.bonds(), 1e-9 * (1 + std::fabs(b.bonds())));
    EXPECT_NEAR(a.vdw, b.vdw, 1e-6 * std::fabs(b.vdw));
  }

  fs::path dir_;
};

TEST_F(StateOfAnEnd, FrictionGoesOn) {
  for (const char* slip : {"dry", "corrugation"}) {
    SCOPED_TRACE(slip);
    const std::string friction = fmt::format("[[friction]]\nfrom = \"atoms\"\nslip = \"{}\"\n", slip);
    const Simulation s = ended("[rope]\ntubes = 7\nlength_nm = 11\n" + still + friction + clamps +
                                   "about_z = { rotation_deg = [[0, 0], [8, 20]] }\n" + run,
                               200);
    ASSERT_GT(s.forces().energy.terms, 0.01);
    EXPECT_THAT(read_file(path("end.csv")), HasSubstr("\n# memory: end-memory.csv of friction\n"));
    const Simulation on = begun(still + friction + clamps + run);
    expect_same_energies(on, s);
    EXPECT_EQ(on.term_accounts().at(0).lost, 0) << "accounts begin at zero";

    Scene without = next(still + clamps + run);
    const Prepared p = prepare(without);
    EXPECT_THAT(forgotten(without.memory, p.interaction), ElementsAre(HasSubstr("has no friction")));

    fs::remove(path("end-memory.csv"));
    EXPECT_THAT(refusal(still + friction + clamps + run),
                HasSubstr("end.csv: names end-memory.csv, and there is no such file"));
    EXPECT_EQ(refusal(still + clamps + run), "") << "it is not needed";
    std::string text = read_file(path("end.csv"));
    const std::size_t at = text.find("# memory");
    text.erase(at, text.find('\n', at) + 1 - at);
    write_file_atomically(path("end.csv"), text);
    Scene anew = next(still + friction + clamps + run);
    const Prepared begins = prepare(anew);
    EXPECT_THAT(forgotten(anew.memory, begins.interaction),
                ElementsAre(HasSubstr("friction of the scene begins anew")));
  }
}

TEST_F(StateOfAnEnd, TheMemoryOfAnotherStateIsRefused) {
  const std::string friction = "[[friction]]\nfrom = \"atoms\"\n";
  const std::string rope = "[rope]\ntubes = 7\nlength_nm = 11\n" + still + friction + run;
  ended(rope, 40);
  const std::string memory = read_file(path("end-memory.csv"));
  ended(rope, 60);
  write_file_atomically(path("end-memory.csv"), memory);
  EXPECT_THAT(refusal(still + friction + run), HasSubstr("end-memory.csv: is not the memory of"));
  ended(rope, 60);
  std::string damaged = read_file(path("end-memory.csv"));
  damaged.replace(damaged.find(" "), 1, " x");
  write_file_atomically(path("end-memory.csv"), damaged.substr(0, damaged.rfind(' ')) + "\n");
  EXPECT_THAT(refusal(still + friction + run), HasSubstr("end-memory.csv"));
}

TEST_F(StateOfAnEnd, LinksStayWhereTheyAre) {
  const std::string links = "[[links]]\nper_nm = 0.3\nstiffness_nN_per_nm = 100\nbreaks_at_nN = 2\n";
  const std::string pulled =
      "[[grip]]\nend = \"lower\"\ntubes = [1, 2, 3, 4, 5, 6]\n[[grip]]\nend = \"upper\"\ntubes = [0]\n";
  const Simulation s = ended("[rope]\ntubes = 7\nlength_nm = 14\n" + still + links + pulled +
                                 "z = { displacement_nm = [[0, 0], [8, 1]] }\n" + run,
                             80);
  const TermAccount then = s.term_accounts().at(0);
  ASSERT_GT(then.events, 0);
  ASSERT_GT(then.begun, then.events);
  const Simulation on = begun(still + links + pulled + run);
  expect_same_energies(on, s);
  EXPECT_EQ(on.term_accounts().at(0).begun, then.begun - then.events) << "whole ones are there at the start";
  EXPECT_EQ(on.term_accounts().at(0).events, 0);
  for (const TermEvent& e : on.term_events()) {
    EXPECT_EQ(e.time, 0);
    EXPECT_EQ(e.what, "link formed");
  }
}

TEST_F(StateOfAnEnd, TethersKeepTheirLengthAndStayBroken) {
  const auto tether = [](double breaks_at) {
    return fmt::format(
        "[[tether]]\ntube = 0\nelements = [-1]\nto_point_nm = [0, 0, 30]\nstiffness_nN_per_nm = 5\nbreaks_at_nm = "
        "{}\n",
        breaks_at);
  };
  const std::string chain = "[chain]\nelements = 12\n",
                    pull = "[[load]]\nkind = \"force\"\nelements = [-1]\nforce_nN = [0, 0, -20]\n";
  const Simulation s = ended(chain + still + tether(1000) + pull + run, 60);
  ASSERT_GT(s.forces().energy.terms, 0.01);
  expect_same_energies(begun(still + tether(1000) + pull + run), s);
  EXPECT_THAT(refusal(still + tether(1000) + tether(1000) + pull + run), HasSubstr("memory of 1 \"tether\""));
  const Simulation broken = ended(chain + still + tether(15) + pull + run, 90);
  ASSERT_EQ(broken.term_accounts().at(0).events, 1);
  EXPECT_EQ(begun(still + tether(15) + pull + run).forces().energy.terms, 0);
}

// The parts of a broken tube do not bind end to end, whether the scene has [failure] or not.
TEST_F(StateOfAnEnd, BrokenTubesStayBroken) {
  const std::string failure = "[failure]\nstrain = 0.03\nstrain_deviation = 0.008\nseed = 3\n";
  const std::string steps = "[run]\nduration_ps = 20\ntime_step_fs = 20\n";
  const Simulation s = ended("[rope]\ntubes = 7\nlength_nm = 16\n" + still + failure + clamps +
                                 "z = { strain = [[0, 0], [16, 0.06]] }\n" + steps,
                             330);
  ASSERT_GT(s.term_accounts().at(0).events, 0);
  EXPECT_THAT(read_file(path("end.csv")), HasSubstr("\n# broken_behind_elements: "));
  EXPECT_FALSE(fs::exists(path("end-memory.csv")));
  for (const std::string& table : {failure, std::string()}) {
    const Simulation on = begun(still + table + steps);
    expect_same_energies(on, s);
    EXPECT_EQ(on.topology().tube_begin, s.topology().tube_begin);
    EXPECT_EQ(on.tubes_now().tube_begin, s.tubes_now().tube_begin);
    EXPECT_EQ(on.term_accounts().at(0).events, 0);
    EXPECT_EQ(on.term_events().size(), static_cast<std::size_t>(s.term_accounts().at(0).events));
    for (const TermEvent& e : on.term_events()) EXPECT_EQ(e.time, 0);
    write_end(on, "again.csv");
    EXPECT_EQ(read_file(path("again.csv")), read_file(path("end.csv")));
  }
  // By itself as well, on either path.
  SingleState alone;
  alone.source = std::make_shared<StateSource>(path("end.csv"));
  alone.parameters = {"cnt-10-10-tersoff"};
  for (const bool reference : {false, true}) {
    alone.reference = reference;
    EXPECT_NEAR(evaluate(alone).forces.energy.bonds(), s.forces().energy.bonds(), 1e-9);
  }
  std::string wrong = read_file(path("end.csv"));
  wrong.replace(wrong.find("elements: ") + 10, 0, "0,");
  write_file_atomically(path("end.csv"), wrong);
  EXPECT_THAT(refusal(run), HasSubstr("broken behind element 0, where none ends"));
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  double xy = 0, xx = 0, yy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) xy += x[k] * y[k], xx += x[k] * x[k], yy += y[k] * y[k];
  return xy / std::sqrt(xx * yy);
}

// One component of velocity, sampled at intervals longer than its correlation time.
std::vector<double> motion(Simulation s) {
  std::vector<double> out;
  for (int k = 0; k < 150; ++k) {
    s.steps(10, false);
    const Vec3Array& v = s.state().velocity;
    for (std::size_t i = 0; i < v.size(); ++i) out.push_back(v[i].x());
  }
  return out;
}

TEST_F(StateOfAnEnd, HasOtherNoise) {
  const std::string bath =
      "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n[thermostat]\ntemperature_K = "
      "300\ncoupling_per_ps = 5\n[run]\nduration_ps = 20\ntime_step_fs = 20\n";
  Scene first = scene("[chain]\nelements = 6\n" + bath);
  const Simulation began = start(first, prepare(first));
  Simulation s = began;
  s.steps(1500);
  write_end(s);
  const std::vector<double> before = motion(began), after = motion(begun(bath));
  EXPECT_NEAR(correlation(before, motion(began)), 1, 1e-12);
  EXPECT_LT(std::fabs(correlation(before, after)), 0.15);
  EXPECT_EQ(after, motion(begun(bath))) << "the same scene has the same noise";
  Scene other = scene("[chain]\nelements = 6\n[start]\nstream = 2\n" + bath);
  EXPECT_LT(std::fabs(correlation(before, motion(start(other, prepare(other))))), 0.15);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
