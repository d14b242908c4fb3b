// How a parameter set is graded, and what a scene says of it.
#include "io/grade.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "run/run_directory.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

ParameterSet shipped(const std::string& name) {
  return read_parameters(data_directory() + "/parameters/" + name + ".toml");
}

// With other values of some numbers.
ParameterSet changed(const std::string& name, const std::string& key, double value) {
  ParameterSet set = shipped(name);
  for (Quantity& q : set.quantities)
    if (q.key == key) q.value = value;
  return set;
}

TEST(Grade, OfAMiddlingTubeIsGood) {
  for (const char* name : {"cnt-5-5-tersoff", "cnt-10-10-tersoff", "cnt-12-6-tersoff", "cnt-10-10-lcbop"})
    EXPECT_EQ(grade_of(shipped(name)).words(), "good") << name;
}

TEST(Grade, NamesFacetsOfWideTubes) {
  const Grade wide = grade_of(shipped("cnt-20-20-tersoff"));
  EXPECT_EQ(wide.level, Grade::Level::limited);
  EXPECT_NE(wide.words().find("2.75 nm wide: tubes wider than 2 nm facet"), std::string::npos) << wide.words();
  ParameterSet huge = shipped("cnt-20-20-tersoff");
  huge.radius = 2.2;
  EXPECT_EQ(grade_of(huge).level, Grade::Level::unfit);
}

TEST(Grade, NamesWhatIsKnownBadly) {
  const Grade airebo = grade_of(shipped("cnt-10-10-airebo"));
  EXPECT_EQ(airebo.level, Grade::Level::limited);
  EXPECT_NE(airebo.words().find("EA is known to 1.4 %"), std::string::npos) << airebo.words();
}

TEST(Grade, OfAStiffnessThatIsNotKnownIsUnfit) {
  ParameterSet set = shipped("cnt-10-10-tersoff");
  const auto EI = [&]() -> Quantity& {
    return *std::find_if(set.quantities.begin(), set.quantities.end(),
                         [](const Quantity& q) { return q.key == "bond.EI"; });
  };
  EI().standard_error = 4760;
  EXPECT_EQ(grade_of(set).level, Grade::Level::unfit);
  EXPECT_NE(grade_of(set).words().find("EI is known to 1.3e+03 %"), std::string::npos) << grade_of(set).words();
  EI().standard_error.reset();
  EXPECT_EQ(grade_of(set).words(), "limited: EI has no standard error");
}

TEST(Grade, OfAWallThatIsNotOfCarbonIsUnfit) {
  EXPECT_NEAR(wall_stiffness(shipped("cnt-10-10-tersoff")), 351, 0.1);
  ParameterSet soft = shipped("cnt-10-10-tersoff");
  for (double* k : {&soft.bond.stretch, &soft.bond.bend, &soft.bond.twist}) *k /= 23.06;  // kcal/mol in an eV
  EXPECT_EQ(grade_of(soft).level, Grade::Level::unfit);
  EXPECT_NE(grade_of(soft).words().find("EA/(2 pi r) is 15.22 N/m, and a wall of carbon has 200 to 500"),
            std::string::npos)
      << grade_of(soft).words();
}

TEST(Grade, NamesThinWallsByTheirShellRelation) {
  ParameterSet thin = shipped("cnt-5-5-tersoff");
  thin.radius = 0.2;
  thin.bond.bend = 1.1 * 0.5 * thin.bond.stretch * 0.04;
  EXPECT_NE(grade_of(thin).words().find("0.40 nm wide: below 0.5 nm the wall is no thin shell (EI is +10 % off"),
            std::string::npos)
      << grade_of(thin).words();
}

TEST(Grade, OfTheContactFollowsItsErrors) {
  const ParameterSet set = shipped("cnt-10-10-tersoff");
  EXPECT_NEAR(line_fit_error(set), 1.4e-3, 1e-9);
  EXPECT_NEAR(universal_error(set), 1.374e-3, 1e-6);
  EXPECT_NE(grade_of(changed("cnt-10-10-tersoff", "contact.line.universal.error", 0.05))
                .words()
                .find("the contact with other tubes is off by up to 5 % of the well"),
            std::string::npos);
  EXPECT_NE(grade_of(changed("cnt-10-10-tersoff", "contact.line.universal.error", 0.44))
                .words()
                .find("not to be mixed with other tubes"),
            std::string::npos);
  ParameterSet bad = set;
  for (Quantity& q : bad.quantities)
    if (q.key == "contact.line.K") q.note = "fit error 3.0e-01 of the well";
  EXPECT_EQ(grade_of(bad).level, Grade::Level::unfit);
  EXPECT_EQ(grade_of(shipped("cnt-10-10-paper")).level, Grade::Level::limited);
}

TEST(Grade, LimitsOfOtherHoneycombsByTheRulesForCarbonAreNoGoodOnes) {
  ParameterSet by_rule = shipped("bn-10-10-tersoff");
  const std::string measured = grade_of(by_rule).words();
  EXPECT_EQ(measured.find("the rules for carbon"), std::string::npos) << measured;
  EXPECT_EQ(measured.find("is to be expected"), std::string::npos) << measured;
  for (Quantity& q : by_rule.quantities)
    if (q.key == "validity.kink_curvature") q.origin = "derived";
  const std::string words = grade_of(by_rule).words();
  EXPECT_NE(words.find("limited"), std::string::npos);
  EXPECT_NE(words.find("follow the rules for carbon, and BN may give way earlier"), std::string::npos) << words;
  ParameterSet soft = shipped("bn-10-10-tersoff");
  soft.bond.stretch /= 23;
  EXPECT_NE(grade_of(soft).words().find("a sheet of one layer has 30 to 500"), std::string::npos) << grade_of(soft).words();
}

TEST(Grade, EveryShippedSetSaysHowMuchRegistryCounts) {
  for (const auto& entry : std::filesystem::directory_iterator(data_directory() + "/parameters")) {
    if (entry.path().extension() != ".toml" || entry.path().stem() == "cnt-10-10-paper") continue;
    const ParameterSet set = read_parameters(entry.path().string());
    if (set.filament) continue;  // it has no lattice
    const double deviation = registry_deviation(set);
    EXPECT_GT(deviation, 0) << entry.path();
    EXPECT_LT(deviation, 0.04) << entry.path();
  }
  EXPECT_NEAR(registry_deviation(shipped("cnt-10-10-tersoff")), 0.010, 0.001);
  EXPECT_NEAR(registry_deviation(shipped("cnt-5-5-tersoff")), 0.029, 0.002);
}

TEST(Grade, FindsNumbersThatContradictEachOther) {
  ParameterSet law = shipped("cnt-10-10-tersoff");
  law.law<LineParameters>()->density.K *= 1.05;
  EXPECT_NE(grade_of(law).words().find("eV/nm, and pair_energy is -1.011: one of them is wrong"), std::string::npos)
      << grade_of(law).words();
  ParameterSet density = shipped("cnt-10-10-tersoff");
  density.law<LineParameters>()->surface_density *= 2;
  EXPECT_NE(grade_of(density).words().find("unfit: atoms_per_length and radius give 37.04 atoms per nm^2"),
            std::string::npos)
      << grade_of(density).words();
  ParameterSet bond = shipped("cnt-10-10-tersoff");
  bond.bond.bend *= 1.6;
  EXPECT_NE(grade_of(bond).words().find("% off that of a thin shell"), std::string::npos) << grade_of(bond).words();
}

// Each value of a good set ten times, a tenth of it, with the other sign, and in another unit of energy.
TEST(Grade, NoNumberOfAGoodSetIsFree) {
  // Of these the set says nothing else: diagnostics that no run reads, terms of the law beyond Hooke's that are
  // small in one direction, fits of the published form, and errors that the set claims of itself.
  const std::map<std::string, std::string> free = {{"tube.element_length", "any length will do"},
                                                   {"atomistic.natural_twist", "zero, or any of a chiral tube"},
                                                   {"atomistic.coupling", "zero, or any of a chiral tube"},
                                                   {"atomistic.sublattice_turn", "atoms alone are placed by it"},
                                                   {"bond.anharmonic.e2s", "zero, or any of a chiral tube"},
                                                   {"bond.anharmonic.s3", "zero, or any of a chiral tube"},
                                                   {"bond.anharmonic.e3s", "zero, or any of a chiral tube"},
                                                   {"bond.anharmonic.es3", "zero, or any of a chiral tube"},
                                                   {"bond.anharmonic.e4", "small beside e3"},
                                                   {"bond.anharmonic.e2s2", "small, of either sign"},
                                                   {"bond.anharmonic.s4", "small, below the window's end"},
                                                   {"contact.line.registry", "any small part of the well"},
                                                   {"contact.line.universal.error", "claimed by the set"}};
  const std::string path = data_directory() + "/parameters/cnt-10-10-tersoff.toml", text = read_file(path);
  int tried = 0;
  for (const Quantity& q : shipped("cnt-10-10-tersoff").quantities) {
    if (q.value == 0 || q.key.rfind("contact.paper.", 0) == 0) continue;
    const std::string key = q.key.substr(q.key.rfind('.') + 1);
    // The key in its table.
    const std::string table = "[" + q.key.substr(0, q.key.rfind('.')) + "]\n";
    const std::size_t section = text.find(table), line = text.find("\n" + key + " ", section),
                      value = text.find("value = ", line) + 8;
    ASSERT_NE(section, std::string::npos) << q.key;
    ASSERT_NE(line, std::string::npos) << q.key;
    for (const double factor : {10.0, 0.1, -1.0, 23.06, 1 / 23.06}) {
      std::string changed = text;
      changed.replace(value, text.find(',', value) - value, fmt::format("{}", factor * q.value));
      std::string grade = "refused";
      try {
        grade = grade_of(parameters_of_text(changed, path)).words();
      } catch (const InputError&) {
      }
      ++tried;
      EXPECT_TRUE(grade != "good" || free.count(q.key) > 0) << q.key << " times " << factor;
    }
  }
  EXPECT_GT(tried, 150);
}

Scene scene_with(const std::string& set, const std::string& law) {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"" + set +
                           "\"\n[rope]\ntubes = 7\nlength_nm = 14\n[contact]\nlaw = \"" + law +
                           "\"\n[run]\nduration_ps = 1\n",
                       "t.toml");
}

std::vector<std::string> warnings(Scene scene) { return warnings_of(scene, prepare(scene)); }

// The bad error of the published form between crossed tubes is computed from law and set.
TEST(Grade, TheScenesWarningGivesTheErrorOfThePublishedForm) {
  EXPECT_TRUE(warnings(scene_with("cnt-10-10-tersoff", "line")).empty());
  const std::vector<std::string> said = warnings(scene_with("cnt-10-10-tersoff", "paper"));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("and the surface integral gives -1.45 eV"), std::string::npos) << said[0];
  EXPECT_TRUE(warnings(scene_with("cnt-10-10-paper", "paper")).empty());
}

TEST(Grade, TheScenesWarningsNameALossByCutoffAndUnlikeTubes) {
  Scene scene = scene_with("cnt-10-10-tersoff", "line");
  scene.contact.cutoff = 2.2;
  ASSERT_EQ(warnings(scene).size(), 1u);
  EXPECT_NE(warnings(scene)[0].find("two parallel tubes bind with"), std::string::npos);
  scene.contact.cutoff = 2.8;
  EXPECT_TRUE(warnings(scene).empty());
  scene.sets.push_back(shipped("cnt-5-5-tersoff"));
  scene.contact.cutoff = 0;
  ASSERT_EQ(warnings(scene).size(), 1u);
  EXPECT_NE(warnings(scene)[0].find("Q_delaunay needs no distance"), std::string::npos);
}

// Atoms stand behind no number of a filament, and units are all that can be held to anything.
TEST(Grade, OfAFilamentIsLimitedAndSeesWrongUnits) {
  for (const char* name : {"cellulose-36", "f-actin"}) {
    const Grade grade = grade_of(shipped(name));
    EXPECT_EQ(grade.level, Grade::Level::limited) << name;
    EXPECT_EQ(grade.words().find("is a number or a unit wrong"), std::string::npos) << grade.words();
  }
  ParameterSet heavy = shipped("f-actin"), thick = shipped("f-actin");
  heavy.mass_per_length *= 100;
  EXPECT_NE(grade_of(heavy).words().find("mass_per_length over pi contact_radius^2"), std::string::npos);
  thick.bond.bend *= 100;
  EXPECT_NE(grade_of(thick).words().find("sqrt(EI/EA) over contact_radius"), std::string::npos);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
