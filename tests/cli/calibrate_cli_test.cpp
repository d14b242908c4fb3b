// `ropewalk calibrate` as a user meets it. The calibration itself runs LAMMPS on the thinnest shipped tube.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/support.hpp"
#include "outputs_page.hpp"

namespace {
namespace UNIT {

using ropewalk::test::Outcome;
using ropewalk::test::slurp;
using ropewalk::test::spit;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class Calibrate : public ropewalk::test::Cli {
 protected:
  void expect_refusal(const std::string& arguments, const std::string& words, const std::string& before = "") {
    const Outcome o = run("calibrate " + arguments, before);
    EXPECT_TRUE(o.code == 2 || o.code == 3) << arguments << ": " << o.code;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    EXPECT_NE(o.err.find(words), std::string::npos) << arguments << "\n" << o.err;
    for (const auto& entry : fs::directory_iterator(dir))
      EXPECT_TRUE(keep.count(entry.path().filename().string())) << arguments << " left " << entry.path();
  }
  std::set<std::string> keep = {"stdout.txt", "stderr.txt"};
};

TEST_F(Calibrate, WrongInputGetsOneLineAndLeavesNothing) {
  expect_refusal("", "--chirality: is missing");
  expect_refusal("--chirality 10", "write two integers");
  expect_refusal("--chirality 0,0 --quiet", "not a tube");
  expect_refusal("--chirality 3,0 --quiet", "(3,0)");
  expect_refusal("--chirality 200,200 --quiet", "(200,200)");
  expect_refusal("--chirality 6,-12 --quiet", "not negative");
  expect_refusal("--chirality 5,5 --quiet --lj-cutoff -1", "--lj-cutoff: is -1 nm");
  expect_refusal("--chirality 5,5 --quiet --lj-cutoff 0.4", "at least 2 sigma");
  expect_refusal("--chirality 5,5 --quiet --lj 3", "--lj");
  expect_refusal("--chirality 5,5 --quiet --potential tersof", "tersoff");
  expect_refusal("--chirality 5,5 --quiet --atoms nothing", "--atoms: is \"nothing\"; name one of BN, C");
  expect_refusal("--chirality 5,5 --quiet --atoms BN --potential lcbop", "'lcbop' is none of BN");
  expect_refusal("--chirality 5,5 --quiet --atoms BN --lj 3e-3,0.34", "--lj: is one law, and BN has one for each pair");
  expect_refusal("--chirality '(5,5)@(10,10)' --quiet --bend-lengths 6,3", "bend lengths: must be 2 to 100 nm, the long one");
  expect_refusal("--chirality '(2,1)@(7,7)' --quiet", "(2,1) is 0.207 nm wide");
  expect_refusal("--chirality 5,5 --quiet --potential-file nowhere.txt", "nowhere.txt");
  expect_refusal("--chirality 5,5 --quiet --out set.txt", "--out");
  expect_refusal("--chirality 5,5 --quiet --out no/such/set.toml", "make the directory");
  expect_refusal("--chirality 5,5 --quiet", "lmp", "ROPEWALK_LMP=./lmp");
  expect_refusal("show nothing-of-the-kind", "no parameter set");
  expect_refusal("check-shipped cnt-10-10-paper", "only a set made by");
  expect_refusal("friction", "set is required");
  expect_refusal("friction cnt-10-10-paper", "contact.line: is missing");
  expect_refusal("friction cnt-10-10-tersoff cnt-10-10-rebo", "provenance.potential");
  expect_refusal("friction cnt-5-5-tersoff --drag-ps 3", "--drag-ps");
  expect_refusal("friction cnt-5-5-tersoff --out no/such/friction.toml", "make the directory");
  expect_refusal("pull", "set is required");
  expect_refusal("pull cnt-10-10-rebo", "bond.anharmonic: is missing");
  expect_refusal("pull cnt-5-5-tersoff --out no/such/set.toml", "make the directory");
}

// A set from before pulls were made gets one, and with it a strength.
TEST_F(Calibrate, PullGivesAnOlderSetItsStrength) {
  const std::string shipped = ROPEWALK_SOURCE_DIR "/data/parameters/cnt-5-5-tersoff";
  for (const char* end : {".toml", "-stiffness.csv", "-contact.csv"})
    fs::copy_file(shipped + end, dir / (std::string("old") + end));
  std::string old = slurp(dir / "old.toml");
  const auto begin = old.find("[bond.pull]"), end = old.find("[contact.line]");
  ASSERT_NE(begin, std::string::npos);
  old.erase(begin, end - begin);
  for (const char* table : {"stiffness", "contact"}) {
    const std::string name = std::string("cnt-5-5-tersoff-") + table;
    old.replace(old.find(name), name.size(), std::string("old-") + table);
  }
  spit(dir / "old.toml", old);
  const auto scene = [&](const char* set) {
    spit(dir / "scene.toml", std::string("format = \"ropewalk-scene-1\"\nparameters = \"") + set +
                                 "\"\n[chain]\nelements = 12\n[failure]\nfrom = \"atoms\"\n[run]\nduration_ps = 1\n");
    return run("check scene.toml");
  };
  EXPECT_NE(scene("old.toml").err.find("`ropewalk calibrate pull "), std::string::npos);
  const Outcome made = run("calibrate pull old.toml --out new.toml");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("a bond would be longer than 0.18 nm"), std::string::npos) << made.out;
  EXPECT_EQ(scene("new.toml").code, 0);
  EXPECT_NE(run("calibrate pull old.toml --out new.toml").err.find("exists"), std::string::npos);
  EXPECT_EQ(run("calibrate pull new.toml --out new.toml --force").code, 0) << "in its own place";
}

// What it prints for a scene is a scene's table.
TEST_F(Calibrate, FrictionFromSetToScene) {
  const Outcome made = run("calibrate friction cnt-5-5-tersoff cnt-9-0-tersoff --registers 4 --checks 2 --drag-ps 0 --quiet");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(fs::exists(dir / "friction-5-5-9-0-tersoff.toml"));
  const auto at = made.out.find("[[friction]]");
  ASSERT_NE(at, std::string::npos) << made.out;
  spit(dir / "scene.toml", "format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 7\n" +
                               made.out.substr(at) + "[run]\nduration_ps = 1\n");
  const Outcome checked = run("check scene.toml");
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_NE(checked.out.find("pN at each end"), std::string::npos) << checked.out;
  EXPECT_NE(run("calibrate friction cnt-5-5-tersoff cnt-9-0-tersoff --drag-ps 0 --quiet").err.find("exists"), std::string::npos);
}

// The universal law is off by more than the well for so thin a tube; without it every other command takes the set.
TEST_F(Calibrate, AThinTubesSetServesOneKindOfTube) {
  const Outcome made = run("calibrate --chirality 5,0 --quiet");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("Grade: limited: 0.41 nm wide"), std::string::npos) << made.out;
  const std::string scene = "format = \"ropewalk-scene-1\"\nparameters = ";
  const std::string rest = "[rope]\ntubes = 7\nlength_nm = 5\n[run]\nduration_ps = 0.1\n";
  spit(dir / "one.toml", scene + "\"cnt-5-0-tersoff.toml\"\n" + rest);
  const Outcome one = run("check one.toml");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_NE(one.out.find("grade of cnt-5-0-tersoff: limited: 0.41 nm wide"), std::string::npos) << one.out;
  spit(dir / "two.toml",
       scene + "[\"cnt-5-0-tersoff.toml\", \"cnt-5-5-tersoff\"]\ntube_types = [0,1,0,1,0,1,0]\n" + rest);
  EXPECT_NE(run("check two.toml").err.find("has no [contact.line.universal]"), std::string::npos);
  // A set that an earlier version made, with a law that is as far off.
  std::string text = slurp(std::string(ROPEWALK_SOURCE_DIR) + "/data/parameters/cnt-6-6-tersoff.toml");
  const std::size_t at = text.find("value", text.find("\nerror "));
  text.replace(at, text.find(',', at) - at, "value = 1.23");
  spit(dir / "old.toml", text);
  spit(dir / "two.toml", scene + "[\"old.toml\", \"cnt-5-5-tersoff\"]\ntube_types = [0,1,0,1,0,1,0]\n" + rest);
  EXPECT_NE(run("check two.toml")
                .err.find("is not to be mixed: the contact law between tubes of different kinds is off "
                          "by 1.2e+02 % of the well"),
            std::string::npos);
}

TEST_F(Calibrate, AnExistingFileStands) {
  spit(dir / "cnt-5-5-tersoff.toml", "mine");
  keep.insert("cnt-5-5-tersoff.toml");
  expect_refusal("--chirality 5,5 --quiet", "exists");
  EXPECT_EQ(slurp(dir / "cnt-5-5-tersoff.toml"), "mine");
}

TEST_F(Calibrate, AChildThatFailsIsQuoted) {
  spit(dir / "potential.txt", "pair_style tersoff\npair_coeff * * " + (dir / "no.tersoff").string() + " C\n");
  keep.insert("potential.txt");
  expect_refusal("--chirality 5,5 --quiet --potential-file potential.txt", "no.tersoff");
}

// In one line of its own, before LAMMPS starts: each wall needs a pair style of its own.
TEST_F(Calibrate, AHybridPotentialOfSeveralWallsIsRefused) {
  spit(dir / "hybrid.txt", "pair_style hybrid/overlay tersoff zero 5.0\npair_coeff * * tersoff BNC.tersoff C\n"
                           "pair_coeff * * zero\n");
  spit(dir / "two.txt", "pair_style tersoff\npair_coeff * * BNC.tersoff C\npair_coeff 1 1 BNC.tersoff C\n");
  keep.insert({"hybrid.txt", "two.txt"});
  expect_refusal("--chirality '(5,5)@(10,10)' --quiet --potential-file hybrid.txt",
                 "hybrid.txt: --potential-file: has the line \"pair_coeff * * zero\", which several walls cannot have");
  expect_refusal("--chirality '(5,5)@(10,10)' --quiet --potential-file two.txt", "which several walls cannot have");
}

// One calibration from end to end; everything that can be asked of its files is asked here, since it takes seconds.
TEST_F(Calibrate, AThinTubeFromChiralityToRun) {
  const Outcome o = run("calibrate --chirality 5,5 --json --quiet --keep atoms");
  ASSERT_EQ(o.code, 0) << o.err;
  const Json j = Json::parse(o.out);
  for (const char* key : {"EA_nN", "EI_nN_nm2", "GJ_nN_nm2", "radius_nm", "atoms_per_nm", "natural_twist",
                          "pair_spacing_nm", "pair_energy_eV_per_nm", "cross90_energy_eV"}) {
    ASSERT_TRUE(j.contains(key)) << key;
    EXPECT_TRUE(j.at(std::string(key) + "_standard_error").is_number()) << key;
  }
  EXPECT_NEAR(j.at("EA_nN"), 760, 30);  // half of (10,10)'s
  EXPECT_NEAR(j.at("radius_nm"), 0.3459, 0.002);
  EXPECT_NEAR(j.at("natural_twist"), 0, 1e-4);  // not chiral
  EXPECT_LT(j.at("line_error"), 2e-3);
  EXPECT_FALSE(fs::is_empty(dir / "atoms"));
  for (const char* file : {"cnt-5-5-tersoff.toml", "cnt-5-5-tersoff-stiffness.csv", "cnt-5-5-tersoff-contact.csv"})
    EXPECT_TRUE(fs::exists(dir / file)) << file;

  // The set says where it comes from, and a scene takes it.
  const Outcome shown = run("calibrate show cnt-5-5-tersoff.toml");
  ASSERT_EQ(shown.code, 0) << shown.err;
  for (const char* word : {"bond.EA", "contact.line", "potential_hash", "kn ", "natural_twist"})
    EXPECT_NE((shown.out + "bond.EA").find(word), std::string::npos) << word;
  const std::string page = slurp(dir / "cnt-5-5-tersoff.html");
  EXPECT_NE(page.find("Energy against strain"), std::string::npos);
  EXPECT_NE(page.find("Tubes crossed at 90 degrees"), std::string::npos);
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(dir)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("cnt-5-5-tersoff", 0) == 0) left.insert("NAME" + name.substr(15));
  }
  EXPECT_EQ(left, ropewalk::test::outputs_names("`ropewalk calibrate`"));
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-5-5-tersoff.toml\"\n[rope]\ntubes = 7\nlength_nm = 7\n"
       "[run]\nduration_ps = 1\n");
  EXPECT_EQ(run("run s.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");

  // The table is fitted again: with EA alone free the others stay, and EA comes back.
  spit(dir / "fit.toml",
       "format = \"ropewalk-fit-1\"\nmodel = \"stiffness\"\nbase = \"cnt-5-5-tersoff.toml\"\nfree = [\"EA\", "
       "\"GJ\"]\n"
       "[start]\nEA = 500\n");
  const Outcome fit = run("calibrate fit cnt-5-5-tersoff-stiffness.csv fit.toml --json --out again.toml");
  ASSERT_EQ(fit.code, 0) << fit.err << fit.out;
  const Json f = Json::parse(fit.out);
  EXPECT_NEAR(f.at("EA").get<double>() / j.at("EA_nN").get<double>(), 1, 5e-3);
  EXPECT_NEAR(f.at("GJ").get<double>() / j.at("GJ_nN_nm2").get<double>(), 1, 5e-3);
  EXPECT_EQ(f.at("EI").get<double>(), j.at("EI_nN_nm2").get<double>());
  EXPECT_EQ(run("check s.toml").code, 0);
  EXPECT_EQ(run("calibrate show again.toml --table").code, 0);

  spit(dir / "line.toml",
       "format = \"ropewalk-fit-1\"\nmodel = \"line\"\nbase = \"cnt-5-5-tersoff.toml\"\nfree = [\"K\", \"s\"]\n");
  const Outcome line = run("calibrate fit cnt-5-5-tersoff-contact.csv line.toml --json");
  ASSERT_EQ(line.code, 0) << line.err << line.out;
  EXPECT_LT(Json::parse(line.out).at("rms"), 4e-3);

  spit(dir / "bad.toml",
       "format = \"ropewalk-fit-1\"\nmodel = \"stiffness\"\nbase = \"cnt-5-5-tersoff.toml\"\nfree = [\"K\"]\n");
  const Outcome bad = run("calibrate fit cnt-5-5-tersoff-stiffness.csv bad.toml");
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.err.find("bad.toml:4: free:"), std::string::npos) << bad.err;

  // A table that was changed afterwards is not shown as the set's own.
  spit(dir / "cnt-5-5-tersoff-contact.csv", "kind,distance_nm,angle_deg,energy\n");
  EXPECT_EQ(run("calibrate show cnt-5-5-tersoff.toml").code, 2);
}

// Energies in another unit, from another zero, or with one wrong row: no set, and what to look at.
TEST_F(Calibrate, AFitThatDoesNotHoldIsRefused) {
  const std::string shipped = slurp(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-5-5-tersoff-stiffness.csv");
  // The shipped table with other energies in the rows of the fit.
  const auto table = [&](const std::function<double(double, int row)>& energy) {
    std::istringstream in(shipped);
    std::string text;
    int row = 0;
    for (std::string line; std::getline(in, line);) {
      if (line.rfind("stretch-twist,", 0) == 0 || line.rfind("bend-short,", 0) == 0 ||
          line.rfind("bend-long,", 0) == 0) {
        std::size_t from = 0;
        for (int k = 0; k < 6; ++k) from = line.find(',', from) + 1;
        const std::size_t to = line.find(',', from);
        line.replace(from, to - from,
                     fmt::format("{:.12g}", energy(std::stod(line.substr(from, to - from)), row++)));
      }
      text += line + "\n";
    }
    spit(dir / "own.csv", text);
  };
  const auto fit = [&](const std::string& free, const std::string& more = "") {
    spit(dir / "own.toml",
         "format = \"ropewalk-fit-1\"\nmodel = \"stiffness\"\nbase = \"cnt-5-5-tersoff\"\nfree = " + free + "\n" +
             more);
    const Outcome out = run("calibrate fit own.csv own.toml --out own-set.toml --json");
    EXPECT_EQ(fs::exists(dir / "own-set.toml"), out.code == 0);
    EXPECT_EQ(Json::parse(out.out).at("usable"), out.code == 0);
    fs::remove(dir / "own-set.toml");
    return out;
  };
  const std::string all = "[\"EA\", \"GJ\", \"EI\"]";
  const auto refused = [&](const Outcome& out, const std::string& where) {
    EXPECT_EQ(out.code, 2);
    EXPECT_NE(out.err.find(where), std::string::npos) << out.err;
  };
  table([](double e, int) { return e; });
  EXPECT_EQ(fit(all).code, 0);
  refused(fit(all, "[bounds]\nGJ = [20, 30]\n[start]\nGJ = 25\n"),
          "own.toml:4: free: GJ ended at a bound of its box");
  table([](double e, int) { return e + 0.5; });
  refused(fit(all), "energy_eV: the fit misses this energy by");
  table([](double e, int) { return 23.06 * e; });
  refused(fit(all), "own.");
  table([](double e, int row) { return row == 5 ? 1.5 * e : e; });
  const Outcome one = fit(all);
  refused(one, "own.csv:");
  EXPECT_NE(one.err.find("or take this row out"), std::string::npos) << one.err;
}

// Twice as stiff a wall, by energies of one's own: the shear stiffness follows, which no row of the table names.
TEST_F(Calibrate, AFitOfTorsionTakesTheShearWithIt) {
  std::istringstream table(slurp(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-5-5-tersoff-stiffness.csv"));
  std::string twice;
  for (std::string line; std::getline(table, line);) {
    if (line.rfind("stretch-twist,", 0) == 0) {
      std::size_t from = 0;
      for (int k = 0; k < 6; ++k) from = line.find(',', from) + 1;
      const std::size_t to = line.find(',', from);
      line.replace(from, to - from, fmt::format("{:.12g}", 2 * std::stod(line.substr(from, to - from))));
    }
    twice += line + "\n";
  }
  spit(dir / "twice.csv", twice);
  spit(dir / "fit.toml",
       "format = \"ropewalk-fit-1\"\nmodel = \"stiffness\"\nbase = \"cnt-5-5-tersoff\"\nfree = [\"EA\", \"GJ\"]\n");
  const Outcome fit = run("calibrate fit twice.csv fit.toml --out twice.toml");
  ASSERT_EQ(fit.code, 0) << fit.err << fit.out;
  const auto kGA = [&](const std::string& set) {
    return Json::parse(run("compare " + set + " cnt-5-5-tersoff --json").out).at(0).at("bond.kGA").at("value");
  };
  EXPECT_NEAR(kGA("twice.toml").get<double>() / kGA("cnt-5-5-tersoff").get<double>(), 2, 0.02);
}

}  // namespace UNIT
}  // namespace
