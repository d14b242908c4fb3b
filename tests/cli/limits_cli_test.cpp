// The program where a run outgrows its model.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/support.hpp"
#include "io/log.hpp"
#include "io/parameters_toml.hpp"
#include "model/units.hpp"
#include "observe/limits.hpp"

namespace {
namespace UNIT {

using ropewalk::LogRow;
using ropewalk::test::Outcome;
using ropewalk::test::slurp;
using ropewalk::test::spit;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class Limits : public ropewalk::test::Cli {
 protected:
  // Two tubes' worth of twist: 28 degrees a bond at the end, of the line law.
  void SetUp() override {
    ropewalk::test::Cli::SetUp();
    spit(dir / "s.toml",
         "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 12\n"
         "[bond]\nlaw = \"harmonic\"\n"
         "[twist]\nmoment_nN_nm = 120\nrate_nN_nm_per_ps = 20\nhold_ps = 1\n[run]\nlog_every_ps = 0.5\n"
         "frames_every_ps = 2\n[limits]\nwall_twist = 0\nspeed_nm_per_ps = 0\nkink_curvature_per_nm = 0\n");
  }
  std::vector<LogRow> log_of(const std::string& run) const {
    return ropewalk::read_log((dir / run / "log.csv").string());
  }
  Json limits_of(const std::string& run) const { return Json::parse(slurp(dir / run / "limits.json")); }
  // The messages of the run itself, without those before it about limits that the load may pass.
  static std::string said(const std::string& text) {
    std::string out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (line.rfind("ropewalk: note: ", 0) != 0) out += line + "\n";
    return out;
  }
  static long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }
};

TEST_F(Limits, AreSaidOnceAndTheRunGoesOn) {
  const Outcome o = run("run s.toml --out d --quiet");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("limits.twist_deg = 19.9"));
  EXPECT_THAT(o.err, HasSubstr(", or --on-limit refine; see ropewalk help twist_deg\n"));
  EXPECT_THAT(o.out, ::testing::ContainsRegex(
                         "From [0-9.]+ ps on this run is beyond a limit of its model: twist_deg, passed "
                         "in tube [0-6], element [0-9]+"));
  EXPECT_THAT(o.out, HasSubstr("Torque rose to "));
  EXPECT_THAT(o.err, HasSubstr("note: The load may bring twist_deg to 30.1"));
  EXPECT_EQ(said(o.err).find("limits.twist_deg"), said(o.err).rfind("limits.twist_deg")) << "once";
  EXPECT_THAT(o.out, HasSubstr("Limits passed: twist_deg"));
  const Json json = limits_of("d");
  const Json& twist = json.at("limits").at(1);
  EXPECT_EQ(twist.at("key"), "twist_deg");
  EXPECT_TRUE(twist.at("passed"));
  EXPECT_GT(twist.at("largest"), 19.9);
  EXPECT_GE(twist.at("largest_at_ps"), twist.at("passed_at_ps"));
  EXPECT_FALSE(json.at("limits").at(0).at("passed"));
  EXPECT_THAT(twist.at("passed_held_by").get<std::string>(), HasSubstr(" clamp")) << "either; the ends are alike";
  const std::string page = slurp(dir / "d/report.html");
  EXPECT_THAT(page, HasSubstr("limits.twist_deg"));
  const std::size_t lead = page.find("<p class=\"lead\"><b>From "), ends = page.find("The run finished as planned");
  EXPECT_LT(lead, ends);
  EXPECT_NE(ends, std::string::npos);
  EXPECT_THAT(page, HasSubstr("Dotted: beyond twist_deg, from "));
  EXPECT_THAT(page, HasSubstr("class=\"hatch\""));
  EXPECT_THAT(page, HasSubstr("MJ/kg</b> when twist_deg was passed."));
  EXPECT_EQ(run("compare d --csv d.csv").code, 0);
  EXPECT_THAT(slurp(dir / "d.csv"), HasSubstr(",twist_deg,"));
  EXPECT_EQ(run("compare d --page d.html").code, 0);
  EXPECT_THAT(slurp(dir / "d.html"), HasSubstr("finished, beyond twist_deg from "));
}

// What a paper on the run cites.
TEST_F(Limits, OfARunThatIsCited) {
  ASSERT_EQ(run("run s.toml --out d --quiet --steps 5").code, 0);
  const Outcome o = run("cite d");
  EXPECT_EQ(o.code, 0) << o.err;
  for (const char* words : {"@software{ropewalk,", "@article{mdem-twist,", "@misc{cnt-10-10-tersoff,",
                            "Phys. Rev. B 81, 205441", "doi = {10.1103/PhysRevB.81.205441}"})
    EXPECT_THAT(o.out, HasSubstr(words));
  EXPECT_EQ(std::count(o.out.begin(), o.out.end(), '{'), std::count(o.out.begin(), o.out.end(), '}'));
  EXPECT_EQ(run("cite nowhere").code, 2);
}

// Each limit has its part of the page on limits, which `help` prints.
TEST_F(Limits, HaveAHeadingEach) {
  const std::string page = slurp(ROPEWALK_SOURCE_DIR "/docs/limits.md");
  std::vector<std::string> names = {"slip"};
  for (const ropewalk::LimitKind& kind : ropewalk::limit_kinds()) names.push_back(kind.key);
  for (const std::string& name : names) {
    EXPECT_THAT(page, HasSubstr("\n## " + name + "\n"));
    const Outcome o = run("help " + name);
    EXPECT_EQ(o.code, 0) << name;
    for (const char* part : {"**Is it real?**", "**What to change.**"}) EXPECT_THAT(o.out, HasSubstr(part)) << name;
  }
  long headings = 0;
  for (std::size_t at = page.find("\n## "); at != std::string::npos; at = page.find("\n## ", at + 1)) ++headings;
  EXPECT_EQ(headings, static_cast<long>(names.size())) << "a heading that is no limit";
}

// Scenes that refinement refuses are not told to refine.
TEST_F(Limits, AdviseWhatWorks) {
  spit(dir / "p.toml", slurp(dir / "s.toml") + "[failure]\nstrain = 0.06\nstrain_deviation = 0.001\n");
  const Outcome o = run("run p.toml --out p --quiet");
  EXPECT_THAT(o.err, HasSubstr("take a shorter element_length_nm; see ropewalk help twist_deg"));
  EXPECT_THAT(o.err, Not(HasSubstr("--on-limit refine")));
}

// Moments on free grips twist each tube by M/GJ before the rope follows.
TEST_F(Limits, OfAPublishedSpindleAreForeseen) {
  const Outcome o = run("check " ROPEWALK_SOURCE_DIR "/data/scenes/spindle-67nm.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out,
              ::testing::ContainsRegex("note: The load may bring wall_twist to 0.0745, from about [12][0-9.]+ "
                                       "ps on, beyond its limit of 0.04"));
}

// A script learns from the exit code that results lie far beyond a limit. A campaign goes on with its other points.
TEST_F(Limits, PassedByFarGiveAStatus) {
  const std::string scene = slurp(dir / "s.toml");
  for (const auto& [limit, code] : {std::pair{"20", 0}, std::pair{"7", 7}}) {
    spit(dir / "f.toml", scene + "twist_deg = " + limit + "\n");
    const Outcome o = run("run f.toml --out f --quiet --force");
    EXPECT_EQ(o.code, code) << o.err;
    EXPECT_EQ(o.err.find("times its limit. Beyond it the results do not") != std::string::npos, code == 7) << o.err;
    EXPECT_EQ(Json::parse(slurp(dir / "f/manifest.json")).at("status"), "finished");
  }
  EXPECT_EQ(run("resume f --quiet").code, 7);
  spit(dir / "sweep.toml", "format = \"ropewalk-sweep-1\"\nscene = \"f.toml\"\n[vary]\nrope.tubes = [7]\n");
  const Outcome swept = run("sweep sweep.toml");
  EXPECT_EQ(swept.code, 0) << swept.err;
  EXPECT_THAT(swept.out, HasSubstr("1 of them is beyond a limit of the model"));
  EXPECT_THAT(swept.out, HasSubstr("far beyond a limit: all, beyond twist_deg from "));
  const std::string table = slurp(dir / "sweep/table.csv");
  EXPECT_THAT(table, HasSubstr("twist_deg up to"));
  EXPECT_THAT(table, HasSubstr("point,rope.tubes,status,first_limit,first_limit_ps,"));
  EXPECT_THAT(table, HasSubstr("\nall,7,finished,twist_deg,"));
  EXPECT_THAT(slurp(dir / "sweep/messages/all.txt"), Not(HasSubstr("--on-limit refine")))
      << "a sweep takes no refine";
}

// A turn at a rate against that of waves.
TEST_F(Limits, OfASlowTurnAreForeseenAndReported) {
  const auto said_for = [&](int ps) {
    spit(dir / "t.toml", fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\n"
                                     "tubes = 7\nlength_nm = 27.5\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = "
                                     "\"upper\"\nabout_z = {{ rotation_deg = [[0, 0], [{}, 40]] }}\n",
                                     ps));
    const std::string text = run("check t.toml").out;
    std::smatch found;
    EXPECT_TRUE(std::regex_search(text, found, std::regex("may be up to ([0-9.]+) % off its quasi-static value")))
        << text;
    EXPECT_EQ(text.find("ps for 5 %.") != std::string::npos, ps < 50) << text;
    return found.empty() ? 0.0 : std::stod(found[1]);
  };
  EXPECT_NEAR(said_for(120) / said_for(30), 0.25, 0.02);
  const double foreseen = said_for(30);
  ASSERT_EQ(run("run t.toml --out t --quiet").code, 0);
  double apart = 0, whole = 0;
  for (const LogRow& r : log_of("t"))
    if (std::isfinite(r["torque_upper_nN_nm"]))
      apart += std::fabs(r["torque_upper_nN_nm"] - r["torque_lower_nN_nm"]),
          whole += std::fabs(r["torque_upper_nN_nm"] + r["torque_lower_nN_nm"]);
  const double seen = 100 * apart / whole;
  EXPECT_LT(seen, foreseen);
  EXPECT_GT(seen, 0.2 * foreseen);
  EXPECT_THAT(slurp(dir / "t/report.html"),
              ::testing::ContainsRegex(fmt::format("from their mean by <b>{:.2g}[0-9]* %</b> on average", seen)));
}

TEST_F(Limits, AreNamedByCheck) {
  const Outcome o = run("check s.toml");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("watched: bend_deg 19.9, twist_deg 19.9, strain 0.0686, press_nm 0.11"));
  EXPECT_THAT(o.out, Not(HasSubstr("wall_twist")));
}

TEST_F(Limits, AreSilentWhereNothingIsPassed) {
  const Outcome o = run("run s.toml --out d --quiet --steps 40");
  EXPECT_EQ(o.code, 0);
  EXPECT_EQ(said(o.err), "");
  EXPECT_THAT(o.out, Not(HasSubstr("Limits passed")));
}

TEST_F(Limits, StopKeepsTheCheckpoint) {
  const Outcome o = run("run s.toml --out d --quiet --on-limit stop");
  EXPECT_EQ(o.code, 5);
  EXPECT_THAT(o.err, HasSubstr("ropewalk resume d"));
  EXPECT_EQ(Json::parse(slurp(dir / "d/manifest.json")).at("status"), "stopped");
  EXPECT_THAT(slurp(dir / "d/report.html"), HasSubstr("stopped at"));
  const double stopped = log_of("d").back()["time_ps"];
  EXPECT_LT(stopped, 7);
  const Outcome on = run("resume d --quiet --on-limit stop");
  EXPECT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(on.err, "") << "it was said";
  ASSERT_EQ(run("run s.toml --out whole --quiet").code, 0);
  EXPECT_EQ(log_of("d").back()["twist_eV"], log_of("whole").back()["twist_eV"]) << "bit for bit";
}

TEST_F(Limits, RefineGoesOnBesideTheRun) {
  const Outcome o = run("run s.toml --out d --quiet --on-limit refine");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("63 elements of 1.378 nm became 119 of 0.6888 nm"));
  EXPECT_EQ(lines(said(o.err)), 2) << o.err;
  EXPECT_THAT(o.out, HasSubstr("d.fine/report.html"));
  const auto before = log_of("d"), after = log_of("d.fine");
  EXPECT_EQ(before.back()["time_ps"], after.front()["time_ps"]);
  EXPECT_EQ(before.back()["work_eV"], after.front()["work_eV"]);
  EXPECT_EQ(before.back()["dissipated_eV"], after.front()["dissipated_eV"]);
  EXPECT_NEAR(before.back()["balance_eV"], after.front()["balance_eV"], 1e-9 * before.back()["work_eV"]);
  EXPECT_NEAR(after.back()["time_ps"], 7, 0.02);
  EXPECT_LT(std::fabs(after.back()["balance_eV"]), 0.01 * after.back()["work_eV"]);
  EXPECT_LT(after.back()["largest_bond_twist_deg"], 19.9);

  for (const char* name : {"d", "d.fine"}) {
    const Json split = limits_of(name).at("refinements").at(0);
    EXPECT_EQ(split.at("from"), "");
    EXPECT_EQ(split.at("to"), ".fine");
    EXPECT_EQ(split.at("elements_after"), 119);
    EXPECT_NEAR(split.at("energy_before_eV").at("twist"), before.back()["twist_eV"], 1e-9);
    EXPECT_NEAR(split.at("energy_after_eV").at("contact"), after.front()["vdw_eV"], 1e-9);
    const std::string report = slurp(dir / name / "report.html");
    EXPECT_THAT(report, HasSubstr("Elements split on the way"));
    EXPECT_THAT(report, HasSubstr("<b>DIR.fine</b>"));
  }
  EXPECT_EQ(Json::parse(slurp(dir / "d/manifest.json")).at("status"), "refined");
  EXPECT_THAT(slurp(dir / "d.fine/scene.toml"), HasSubstr("of the run d: every element split in two"));

  // Both are runs like any other.
  for (const char* name : {"d", "d.fine"}) {
    const Outcome seen = run(std::string("observe --json ") + name);
    ASSERT_EQ(seen.code, 0) << seen.err;
    const Json frames = Json::parse(seen.out);
    EXPECT_NEAR(frames.back().at("physical_twist_deg"), log_of(name).back()["physical_twist_deg"], 0.1);
    EXPECT_EQ(run(std::string("report ") + name).code, 0);
  }
  const Outcome back = run("resume d");
  EXPECT_EQ(back.code, 2);
  EXPECT_THAT(back.err, HasSubstr("ropewalk resume d.fine"));
  // So it is under other names.
  fs::rename(dir / "d", dir / "moved");
  fs::rename(dir / "d.fine", dir / "moved.fine");
  const Outcome moved = run("resume moved");
  EXPECT_EQ(moved.code, 2);
  EXPECT_THAT(moved.err, HasSubstr("ropewalk resume moved.fine"));
  fs::rename(dir / "moved", dir / "d");
  fs::rename(dir / "moved.fine", dir / "d.fine");
  EXPECT_EQ(run("resume d.fine --quiet --until 7.5").code, 0);
  EXPECT_NEAR(log_of("d.fine").back()["time_ps"], 7.5, 0.02);
  // Nothing is overwritten by chance, and both on demand.
  EXPECT_EQ(run("run s.toml --out d --quiet --on-limit refine").code, 2);
  EXPECT_EQ(run("run s.toml --out d/ --quiet --on-limit refine --force").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(log_of("d.fine").back()["time_ps"], after.back()["time_ps"]);
  const Outcome again = run("run s.toml --out d2 --quiet --on-limit refine --steps 10");
  EXPECT_EQ(again.code, 0);
  fs::create_directories(dir / "d3.fine");
  EXPECT_EQ(run("run s.toml --out d3 --quiet --on-limit refine").code, 2);
  EXPECT_FALSE(fs::exists(dir / "d3"));
}

// Stopped after the splitting and gone on with, it is the run that was not stopped.
TEST_F(Limits, ARefinedRunResumesBitForBit) {
  ASSERT_EQ(run("run s.toml --out d --quiet --on-limit refine").code, 0);
  const auto whole = log_of("d.fine");
  const long steps = limits_of("d").at("refinements").at(0).at("step_before").get<long>() + 20;
  ASSERT_EQ(run("run s.toml --out e --quiet --on-limit refine --steps " + std::to_string(steps)).code, 0);
  ASSERT_TRUE(fs::exists(dir / "e.fine"));
  EXPECT_LT(log_of("e.fine").back()["time_ps"], whole.back()["time_ps"] - 0.5);
  ASSERT_EQ(run("resume e.fine --quiet").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_EQ(log_of("e.fine").back()["time_ps"], whole.back()["time_ps"]);
  EXPECT_EQ(log_of("e.fine").back()["twist_eV"], whole.back()["twist_eV"]);
  EXPECT_EQ(log_of("e.fine").back()["work_eV"], whole.back()["work_eV"]);
}

// A stopped run may be refined afterwards; one whose elements are as short as the model allows goes on, and says so.
TEST_F(Limits, AStoppedRunMayBeRefinedAndOnlyOnce) {
  ASSERT_EQ(run("run s.toml --out d --quiet --on-limit stop").code, 5);
  ASSERT_EQ(run("resume d --quiet --on-limit refine").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_TRUE(fs::exists(dir / "d.fine/checkpoint.bin"));
  spit(dir / "t.toml", slurp(dir / "s.toml") + "twist_deg = 12\n");
  const Outcome o = run("run t.toml --out e --quiet --on-limit refine");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("not refined: elements of 0.3444 nm would be shorter than the radius"));
  EXPECT_FALSE(fs::exists(dir / "e.fine2"));
}

TEST_F(Limits, WhatCannotBeRefinedIsRefusedBeforeItRuns) {
  spit(dir / "p.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\nlength_nm = 14\n"
       "[run]\nduration_ps = 1\n");
  const Outcome o = run("run p.toml --out d --on-limit refine");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(lines(o.err), 1);
  EXPECT_THAT(o.err, HasSubstr("law \"paper\" holds for elements of 1.356 nm alone"));
  EXPECT_FALSE(fs::exists(dir / "d"));
  EXPECT_EQ(run("run p.toml --out d --on-limit explode").code, 2);
}

// A relaxation whose chain is bent too far goes on with the finer one.
// The couple is below that at which the arc leaves its plane, pi (EI GJ)^1/2/L = 113 nN nm.
TEST_F(Limits, ARelaxationIsRefinedAsWell) {
  spit(dir / "r.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[bond]\nlaw = "
       "\"harmonic\"\n[chain]\nelements = 8\n[contact]\n"
       "law = \"none\"\n[[load]]\nkind = \"torque\"\nelements = [0]\ntorque_nN_nm = [0, -100, 0]\n[[load]]\n"
       "kind = \"torque\"\nelements = [-1]\ntorque_nN_nm = [0, 100, 0]\n[run]\nmode = \"relax\"\n"
       "max_steps = 20000\n");
  const Outcome o = run("run r.toml --out d --quiet --on-limit refine");
  ASSERT_EQ(o.code, 7) << o.err;  // curved by more than three times the curvature of a kink
  EXPECT_THAT(o.out, HasSubstr("relaxed: largest force below"));
  EXPECT_THAT(o.err + o.out, Not(HasSubstr("speed_nm_per_ps")));  // a minimiser's speed is not one of tubes
  // Fourteen bonds between the fifteen elements carry the couple, EI/a ((1 - 3 s) sin phi + 6 s sin phi/2).
  const ropewalk::BondStiffness bond =
      ropewalk::read_parameters(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-10-10-tersoff.toml").bond;
  const double a = 0.5 * 1.3775870846515064, s = ropewalk::shear_share(bond, a),
               moment = 100 * ropewalk::units::nN_nm;
  double below = 0, above = 1;
  for (int k = 0; k < 60; ++k) {
    const double phi = 0.5 * (below + above);
    const bool more = bond.bend / a * ((1 - 3 * s) * std::sin(phi) + 6 * s * std::sin(0.5 * phi)) < moment;
    (more ? below : above) = phi;
  }
  const double bend = 14 * bond.bend / a * (1 - std::cos(below));
  EXPECT_NEAR(log_of("d.fine").back()["bend_eV"], bend, 5e-5 * bend);
  EXPECT_EQ(run("observe d.fine").code, 0);
}

// At 0.6 of its limit a hot chain without damping gives the steps some of its energy.
TEST_F(Limits, EnergyDriftIsALimitOfTheWholeRun) {
  const auto hot = [&](const char* name, const char* step, const char* limits) {
    spit(dir / name,
         fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[chain]\nelements = 40\n"
                     "[damping]\ncontact_viscosity_eV_ps_per_nm2 = 0\nbond_damping_per_ps = 0\n[start]\n"
                     "temperature_K = 300\n{}[run]\nduration_ps = 20\ntime_step_fs = {}\n",
                     limits, step));
  };
  hot("long.toml", "32", "[limits]\nenergy_drift = 0.01\n");
  const Outcome o = run("run long.toml --out d --quiet");
  EXPECT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.err, HasSubstr("the error of the energy balance, over the energy that was converted, is"));
  EXPECT_THAT(o.err, HasSubstr("beyond limits.energy_drift = 0.01"));
  EXPECT_THAT(o.out, HasSubstr("Limits passed: energy_drift up to 0.0"));
  const auto drift_of = [&](const char* folder) {
    const Json all = limits_of(folder).at("limits");
    return *std::find_if(all.begin(), all.end(), [](const Json& l) { return l.at("key") == "energy_drift"; });
  };
  const Json limit = drift_of("d");
  EXPECT_EQ(limit.at("key"), "energy_drift");
  EXPECT_EQ(limit.at("tube"), -1);
  EXPECT_TRUE(limit.at("passed").get<bool>());
  EXPECT_THAT(slurp(dir / "d/report.html"), HasSubstr("of the energy that was converted; the limit is 1 %"));
  EXPECT_EQ(run("run long.toml --out e --quiet --on-limit stop").code, 5);
  // It is judged alike after a resume.
  EXPECT_EQ(run("run long.toml --out f --quiet --until 7").code, 0);
  EXPECT_EQ(run("resume f --quiet --until 20").code, 0);
  EXPECT_EQ(slurp(dir / "f/limits.json"), slurp(dir / "d/limits.json"));
  hot("short.toml", "10", "");
  EXPECT_THAT(run("run short.toml --out g --quiet").err, Not(HasSubstr("limits.energy_drift")));
  EXPECT_LT(drift_of("g").at("largest").get<double>(), 0.01);
  hot("unwatched.toml", "32", "[limits]\nenergy_drift = 0\n");
  EXPECT_THAT(run("run unwatched.toml --out h --quiet").err, Not(HasSubstr("limits.energy_drift")));
}

TEST_F(Limits, AShockIsForeseenAndSeen) {
  const auto rope = [&](const char* name, const char* rate, const char* more) {
    spit(dir / name,
         fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 7\n"
                     "length_nm = 40.68\n[twist]\nmoment_nN_nm = 30\nrate_nN_nm_per_ps = {}\nhold_ps = 20\n{}",
                     rate, more));
  };
  rope("fast.toml", "12", "");
  const Outcome foreseen = run("check fast.toml");
  EXPECT_THAT(foreseen.out, HasSubstr("The load may bring shock to 2.25, beyond its limit of 0.25"));
  EXPECT_THAT(foreseen.out, HasSubstr("a ramp of 4 nN nm/ps, over "));
  const Outcome seen = run("run fast.toml --out fast --quiet");
  EXPECT_THAT(seen.err, HasSubstr("the kinetic energy, over the energy of twist under the whole moment, is"));
  EXPECT_THAT(seen.err, HasSubstr("beyond limits.shock = 0.25"));
  EXPECT_EQ(run("run fast.toml --out stopped --quiet --on-limit stop").code, 5);
  for (const auto& [name, rate, more] :
       {std::tuple("slow.toml", "1", ""), std::tuple("unwatched.toml", "12", "[limits]\nshock = 0\n")}) {
    rope(name, rate, more);
    EXPECT_THAT(run(std::string("check ") + name).out, Not(HasSubstr("may bring shock")));
    EXPECT_THAT(run(std::string("run ") + name + " --out d --force --quiet").err, Not(HasSubstr("limits.shock")));
  }
}

}  // namespace UNIT
}  // namespace
