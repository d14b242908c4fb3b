// A run that is stopped and goes on is the run that was never stopped, in all its files: run/run.hpp.
#include "run/run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "io/files.hpp"
#include "io/log.hpp"
#include "run/begin_run.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string head = "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n";
const std::string clamps = "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\n";
// The time steps are halved on the way.
const std::string turned =
    head + "[rope]\ntubes = 7\nlength_nm = 11\n" + clamps +
    "about_z = { rotation_deg = [[0, 0], [9, 40]] }\n[run]\nduration_ps = 12\nlog_every_ps = "
    "2\nframes_every_ps = 5\n";
const std::string linked =
    head +
    "[rope]\ntubes = 7\nlength_nm = 14\n[[links]]\nper_nm = 0.2\nstiffness_nN_per_nm = 100\nbreaks_at_nN = 5\n"
    "forming_per_nm_ps = 0.002\nmost_per_nm = 0.6\n[failure]\nstrain = 0.02\nstrain_deviation = 0.004\n"
    "[[friction]]\nfrom = \"atoms\"\n" +
    clamps + "z = { strain = [[0, 0], [8, 0.05]] }\n[run]\nduration_ps = 9\nlog_every_ps = 1\n";
const std::string refined = head +
                            "element_length_nm = 4\n[rope]\ntubes = 7\nlength_nm = 24\n[twist]\nmoment_nN_nm = "
                            "22\nrate_nN_nm_per_ps = 6\n[run]\nduration_ps = 8\nlog_every_ps = 0.7\n";
const std::string relaxed =
    head +
    "[chain]\nelements = 8\n[[load]]\nkind = \"torque\"\nelements = [0]\ntorque_nN_nm = [0, -20, 0]\n[[load]]\n"
    "kind = \"torque\"\nelements = [-1]\ntorque_nN_nm = [0, 20, 0]\n[run]\nmode = \"relax\"\n";

// Asks for an end when it has been asked so often.
class Follower : public RunListener {
 public:
  explicit Follower(long patience = -1) : left_(patience) {}
  void tell(const std::string& line) override { said += line + "\n"; }
  std::string asked_to_stop() override { return left_-- == 0 ? "by a test" : ""; }
  std::string said;

 private:
  long left_;
};

using Files = std::map<std::string, std::string>;

class Stops : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() / fmt::format("ropewalk-stops-{}", getpid());
    fs::remove_all(dir_);
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

  RunDirectory run_dir(const std::string& name) const { return {(dir_ / name).string()}; }
  // Of all stages of a run.
  Files files_of(const std::string& name) const {
    Files out;
    for (const auto& stage : fs::directory_iterator(dir_)) {
      const std::string end = stage.path().filename().string();
      if (end != name && end.rfind(name + ".fine", 0) != 0) continue;
      for (const char* file :
           {"final.csv", "final-memory.csv", "log.csv", "frames.gsd", "limits.json", "events.csv"})
        if (fs::exists(stage.path() / file))
          out[end.substr(name.size()) + "/" + file] = read_file((stage.path() / file).string());
    }
    return out;
  }
  RunResult run(const std::string& name, const std::string& text, const RunSettings& asked,
                Follower& follower) const {
    RunSettings settings = asked;
    settings.force = true;
    return go_through(
        begin_run(scene_of_text(text, (dir_ / "scene.toml").string()), run_dir(name), settings, follower));
  }
  RunResult run(const std::string& name, const std::string& text, const RunSettings& asked = {}) const {
    Follower nobody;
    return run(name, text, asked, nobody);
  }
  // The last stage that has a checkpoint.
  RunResult go_on(const std::string& name, const RunSettings& asked = {}) const {
    Follower nobody;
    RunDirectory dir = run_dir(name);
    for (const char* stage : {".fine", ".fine2"})
      if (has_checkpoint(run_dir(name + stage))) dir = run_dir(name + stage);
    ResumeSettings settings;
    static_cast<RunSettings&>(settings) = asked;
    return go_through(resume_run(dir, settings, nobody));
  }
  void clear(const std::string& name) const {
    for (const char* stage : {"", ".fine", ".fine2"}) fs::remove_all(dir_ / (name + stage));
  }
  void expect_whole(const Files& whole, const std::string& when) const {
    const Files part = files_of("part");
    EXPECT_EQ(part.size(), whole.size()) << when;
    for (const auto& [name, content] : whole)
      EXPECT_TRUE(part.count(name) == 1 && part.at(name) == content) << when << ": " << name;
  }
  // Stopped at this step, and once more on the way.
  void expect_same_by_steps(const std::string& text, const Files& whole, long step,
                            const RunSettings& asked = {}) const {
    clear("part");
    RunSettings first = asked, second = asked;
    first.steps = step;
    second.steps = step + 37;
    run("part", text, first);
    go_on("part", second);
    go_on("part", asked);
    expect_whole(whole, fmt::format("steps {}", step));
  }
  void expect_same_when_asked(const std::string& text, const Files& whole, long turns,
                              const RunSettings& asked = {}) const {
    clear("part");
    Follower follower(turns);
    if (run("part", text, asked, follower).end == RunEnd::asked) go_on("part", asked);
    expect_whole(whole, fmt::format("asked after {} turns", turns));
  }

  fs::path dir_;
};

TEST_F(Stops, AtAStepOrWhenAsked) {
  Follower follower;
  run("whole", turned, {}, follower);
  EXPECT_THAT(follower.said, HasSubstr("on with steps of"));
  const Files whole = files_of("whole");
  ASSERT_EQ(whole.size(), 4u);
  for (const long step : {0, 1, 31, 100, 128, 150, 210}) expect_same_by_steps(turned, whole, step);
  for (const long turns : {0, 3, 7, 11}) expect_same_when_asked(turned, whole, turns);
}

TEST_F(Stops, WithLinksFrictionAndBrokenTubes) {
  run("whole", linked);
  const Files whole = files_of("whole");
  EXPECT_THAT(whole.at("/events.csv"), HasSubstr("tube broke"));
  EXPECT_THAT(whole.at("/events.csv"), HasSubstr("link broke"));
  for (const long step : {50, 129, 200}) expect_same_by_steps(linked, whole, step);
  expect_same_when_asked(linked, whole, 9);
}

TEST_F(Stops, WithoutEventsThatWereTakenAway) {
  RunSettings first;
  first.steps = 50;
  run("part", linked, first);
  fs::remove(dir_ / "part/events.csv");
  Follower follower;
  go_through(resume_run(run_dir("part"), ResumeSettings(), follower));
  EXPECT_THAT(follower.said, HasSubstr("events.csv is missing"));
  EXPECT_THAT(follower.said, HasSubstr("events begin anew here; those before are lost"));
  run("whole", linked);
  EXPECT_EQ(read_file((dir_ / "part/log.csv").string()), read_file((dir_ / "whole/log.csv").string()));
  const std::string left = read_file((dir_ / "part/events.csv").string()),
                    all = read_file((dir_ / "whole/events.csv").string());
  const std::string lines = left.substr(left.find('\n') + 1);
  ASSERT_LT(lines.size(), all.size());
  EXPECT_EQ(lines, all.substr(all.size() - lines.size()));
}

TEST_F(Stops, WhereElementsAreSplit) {
  RunSettings asked;
  asked.on_limit = OnLimit::refine;
  run("whole", refined, asked);
  const Files whole = files_of("whole");
  ASSERT_GE(whole.size(), 12u) << "three stages";
  // Before the first splitting, at it, and behind it and the second one.
  const double split = read_log((dir_ / "whole/log.csv").string()).back()["time_ps"];
  for (const double time : {0.5, split - 0.03, split, split + 0.5}) {
    clear("part");
    RunSettings first = asked, second = asked;
    first.until_ps = time;
    second.until_ps = time + 1.3;
    run("part", refined, first);
    go_on("part", second);
    go_on("part", asked);
    expect_whole(whole, fmt::format("until {} ps", time));
  }
  expect_same_when_asked(refined, whole, 4, asked);
}

TEST_F(Stops, InARelaxation) {
  run("whole", relaxed);
  const Files whole = files_of("whole");
  const auto end = static_cast<long>(read_log((dir_ / "whole/log.csv").string()).back()["step"]);
  ASSERT_GT(end, 190);
  for (const long step : {0, 60, 100, 150}) expect_same_by_steps(relaxed, whole, step);
  expect_same_when_asked(relaxed, whole, 100);
}

// The row, the frame and the end that a limit or a rule made are taken back.
TEST_F(Stops, AtALimitAndByARule) {
  run("whole", turned + "[limits]\nstrain = 0.0005\n");
  const Files whole = files_of("whole");
  RunSettings stops;
  stops.on_limit = OnLimit::stop;
  ASSERT_EQ(run("part", turned + "[limits]\nstrain = 0.0005\n", stops).end, RunEnd::at_limit);
  go_on("part");
  expect_whole(whole, "a limit");

  run("whole", turned);
  const std::string rule = "[[stop]]\nwhen = \"above\"\ncolumn = \"time_ps\"\nvalue = 5\n";
  clear("part");
  EXPECT_THAT(run("part", turned + rule).reason, HasSubstr("decided at 5.95"));
  write_file_atomically((dir_ / "part/scene.toml").string(), turned);
  go_on("part");
  expect_whole(files_of("whole"), "a rule");
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
