// Filaments without a lattice, as a user meets them: a rope of them runs, and what needs atoms says so in one line.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using test::Outcome;
using test::slurp;
using test::spit;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = test::fs;

class Filament : public test::Cli {
 protected:
  void scene(const std::string& file, const std::string& parameters, const std::string& more = "") const {
    spit(dir / file, fmt::format("format = \"ropewalk-scene-1\"\nname = \"f\"\nparameters = {}\n"
                                 "[rope]\ntubes = 7\nlength_nm = 40\n{}\n[run]\nduration_ps = 20\n",
                                 parameters, more));
  }
  void refuses(const std::string& command, const std::string& words) const {
    const Outcome o = run(command);
    EXPECT_EQ(o.code, 2) << command;
    EXPECT_THAT(o.err, HasSubstr(words)) << command;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  }
};

TEST_F(Filament, ARopeOfThemRunsAndIsReported) {
  scene("a.toml", "\"cellulose-36\"");
  ASSERT_EQ(run("run a.toml --out d --quiet").code, 0) << slurp(dir / "stderr.txt");
  const std::string page = slurp(dir / "d/report.html");
  EXPECT_THAT(page, HasSubstr("cellulose-36"));
  EXPECT_THAT(page, HasSubstr("a filament without a lattice"));
  EXPECT_THAT(page, Not(HasSubstr("(0,0)")));
  refuses("atoms d -o a.xyz", "filament: has no lattice of atoms");
}

TEST_F(Filament, EndsInLineKeepTheDistanceOfTheirContact) {
  scene("ends.toml", "\"cellulose-36\"", "tube_length_nm = 20");
  ASSERT_EQ(run("run ends.toml --out e --quiet").code, 0) << slurp(dir / "stderr.txt");
}

TEST_F(Filament, WhatNeedsALatticeSaysSo) {
  scene("mixed.toml", "[\"cellulose-36\", \"f-actin\"]\ntube_types = [0, 0, 0, 0, 1, 1, 1]");
  refuses("check mixed.toml", "a filament has one with its own kind alone");
  scene("friction.toml", "\"cellulose-36\"", "[[friction]]\nfrom = \"atoms\"");
  refuses("check friction.toml", "no friction follows from it");
  refuses("calibrate friction cellulose-36", "no friction follows from it");
  refuses("calibrate pull f-actin", "there is nothing to pull");
}

TEST_F(Filament, ItsTableHasNoWallOfCarbon) {
  const Outcome o = run("calibrate show cellulose-36 --table");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("contact_radius"));
  EXPECT_THAT(o.out, Not(HasSubstr("0.335 nm")));
  EXPECT_THAT(o.out, Not(HasSubstr("(potential)")));
  ASSERT_EQ(run("compare cellulose-36 f-actin --page sets.html").code, 0) << slurp(dir / "stderr.txt");
  EXPECT_THAT(slurp(dir / "sets.html"), HasSubstr("mass per length"));
}

TEST_F(Filament, CasesAgainstAtomsAreNotForIt) {
  const Outcome o = run("validate run ring-energy tube-bend --parameters f-actin --out v --quiet");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_THAT(slurp(dir / "v/tube-bend.json"), HasSubstr("a filament has no lattice"));
  EXPECT_THAT(slurp(dir / "v/ring-energy.json"), HasSubstr("f-actin"));
}

// A set with a shape of its own: a scene starts twisted along and says what its curvature costs, comes to rest without
// energy, and what needs straight filaments says so.
TEST_F(Filament, AShapeOfItsOwn) {
  std::string set = slurp(fs::path(ROPEWALK_SOURCE_DIR) / "data/parameters/f-actin.toml");
  const auto number = [](const char* key, double value, const char* unit) {
    return fmt::format("{} = {{ value = {}, unit = \"{}\", standard_error = {}, origin = \"chosen\" }}\n", key, value, unit,
                       value / 10);
  };
  const auto with = [&](const std::string& file, double curvature) {
    std::string text = set;
    text.insert(text.find("[filament]\n") + 11,
                number("curvature_2", curvature, "1/nm") + number("twist_per_length", 0.04, "rad/nm"));
    const std::size_t EI = text.find("\nEI ") + 1;
    text.replace(EI, text.find('\n', EI) + 1 - EI, number("EI_1", 110, "nN nm^2") + number("EI_2", 55, "nN nm^2"));
    spit(dir / file, text);
  };
  with("curved.toml", 0.005);
  with("twisted.toml", 0);
  const auto lone = [&](const std::string& file, const std::string& parameters, const std::string& run) {
    spit(dir / file, fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n[chain]\nelements = 25\n[run]\n{}\n",
                                 parameters, run));
  };
  lone("twisted-chain.toml", "twisted.toml", "duration_ps = 10");
  Outcome o = run("check twisted-chain.toml");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("EI 110 and 55 nN nm^2"));
  EXPECT_THAT(o.out, HasSubstr("a twist of 2.292 deg/nm"));
  EXPECT_THAT(o.out, Not(HasSubstr("natural curvature")));
  lone("curved-chain.toml", "curved.toml", "mode = \"relax\"");
  o = run("check curved-chain.toml");
  EXPECT_THAT(o.out + o.err, HasSubstr("natural curvature of 0.005/nm and starts straight"));
  ASSERT_EQ(run("run curved-chain.toml --out rest --quiet").code, 0) << slurp(dir / "stderr.txt");
  const Outcome energy = run("energy rest/final.csv --parameters curved.toml --json");
  ASSERT_EQ(energy.code, 0) << energy.err;
  const auto j = nlohmann::json::parse(energy.out);
  EXPECT_LT(j.at("energy_eV").at("bend").get<double>(), 1e-3);
  o = run("validate run euler-buckling natural-helix --parameters curved.toml --out v --quiet");
  EXPECT_EQ(o.code, 0) << o.out << o.err;
  EXPECT_THAT(slurp(dir / "v/euler-buckling.json"), HasSubstr("straight at rest"));
  scene("slice.toml", "\"curved.toml\"", "[periodic]\ntwist_deg_per_nm = [[0, 0], [10, 1]]");
  refuses("check slice.toml", "periodic: needs tubes that are straight at rest");
  spit(dir / "long.toml", "format = \"ropewalk-scene-1\"\nparameters = \"curved.toml\"\nelement_length_nm = 50\n[chain]\n"
                          "elements = 9\n[run]\nduration_ps = 1\n");
  refuses("check long.toml", "take at most 38.966 nm");
}

// What theory says of a beam and of a zipper holds for both, whose stiffnesses and wells are 20 to 30 times apart.
TEST_F(Filament, TheoryHoldsForTheShippedOnes) {
  for (const std::string name : {"cellulose-36", "f-actin"}) {
    const Outcome o = run("validate run ring-energy euler-buckling stretch-and-cantilever peeling-force --parameters " +
                          name + " --quiet --out " + name);
    EXPECT_EQ(o.code, 0) << o.out << o.err;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
