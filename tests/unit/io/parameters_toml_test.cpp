// Correlations of the errors of a set: their table, and the covariance that follows.
#include "io/parameters_toml.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "report/page.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::HasSubstr;

const std::string path = ROPEWALK_SOURCE_DIR "/data/parameters/cnt-6-4-tersoff.toml";

// The shipped set, without the correlations that it may have, and with these.
std::string with(const std::string& groups) {
  ParameterSet set = read_parameters(path);
  set.correlations.clear();
  return parameters_text(set, "# changed\n") + groups;
}

constexpr const char* group = R"(
[[correlation]]
of = ["bond.EA", "bond.GJ", "atomistic.coupling"]
matrix = [[1, 0.5, 0], [0.5, 1, -0.25], [0, -0.25, 1]]
)";

TEST(Correlations, GiveTheCovariance) {
  const ParameterSet set = parameters_of_text(with(group), "set.toml");
  const double EA = *find_quantity(set, "bond.EA")->standard_error,
               GJ = *find_quantity(set, "bond.GJ")->standard_error,
               EI = *find_quantity(set, "bond.EI")->standard_error;
  const auto c = covariance(set, {"bond.GJ", "bond.EA", "bond.EI", "bond.nothing"});
  EXPECT_DOUBLE_EQ(c[0][0], GJ * GJ);
  EXPECT_DOUBLE_EQ(c[0][1], 0.5 * EA * GJ);
  EXPECT_DOUBLE_EQ(c[1][0], 0.5 * EA * GJ);
  EXPECT_DOUBLE_EQ(c[2][2], EI * EI);
  EXPECT_EQ(c[0][2], 0) << "in no group with GJ";
  EXPECT_EQ(c[3][3], 0);
}

TEST(Correlations, AreWrittenAsTheyAreRead) {
  const ParameterSet set = parameters_of_text(with(group), "set.toml");
  const ParameterSet again = parameters_of_text(parameters_text(set, ""), "set.toml");
  ASSERT_EQ(again.correlations.size(), 1u);
  EXPECT_EQ(again.correlations[0].of, set.correlations[0].of);
  EXPECT_EQ(again.correlations[0].matrix, set.correlations[0].matrix);
}

TEST(Correlations, ThatCannotBeAreRefused) {
  const auto message = [](const std::string& groups) {
    try {
      parameters_of_text(with(groups), "set.toml");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const std::string head = "[[correlation]]\nof = [\"bond.EA\", \"bond.GJ\"]\nmatrix = ";
  EXPECT_THAT(message("[[correlation]]\nof = [\"bond.EB\"]\nmatrix = [[1]]\n"),
              HasSubstr("no quantity of this set"));
  EXPECT_THAT(message(head + "[[1, 0.5]]\n"), HasSubstr("2 arrays of 2 numbers"));
  EXPECT_THAT(message(head + "[[1, 0.5], [0.5]]\n"), HasSubstr("2 arrays of 2 numbers"));
  EXPECT_THAT(message(head + "[[1, 0.5], [0.4, 1]]\n"), HasSubstr("not one of correlations"));
  EXPECT_THAT(message(head + "[[2, 0.5], [0.5, 1]]\n"), HasSubstr("matrix"));
  EXPECT_THAT(message("[[correlation]]\nof = [\"bond.EA\", \"bond.GJ\", \"bond.EI\"]\n"
                      "matrix = [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]\n"),
              HasSubstr("not one of correlations"));
  EXPECT_THAT(message(std::string(group) + group), HasSubstr("a second time"));
}

TEST(PullOfASet, IsWrittenAsItIsRead) {
  const ParameterSet set = read_parameters(path), again = parameters_of_text(parameters_text(set, ""), "set.toml");
  ASSERT_TRUE(set.pull && again.pull);
  EXPECT_EQ(set.pull->end, again.pull->end);
  EXPECT_EQ(set.end_of_stretch(), set.pull->end);
  for (std::size_t k = 0; k <= PULL_STEPS; ++k)
    EXPECT_NEAR(set.pull->force[k], again.pull->force[k], 1e-6 * set.pull->force[k]) << k;
  ParameterSet without = set;
  const auto begin = std::find_if(without.quantities.begin(), without.quantities.end(),
                                  [](const Quantity& q) { return q.key == "bond.pull.end"; });
  ASSERT_NE(begin, without.quantities.end());
  without.quantities.erase(
      std::remove_if(without.quantities.begin(), without.quantities.end(),
                     [](const Quantity& q) { return q.key.rfind("bond.pull.", 0) == 0; }),
      without.quantities.end());
  const ParameterSet old = parameters_of_text(parameters_text(without, ""), "set.toml");
  EXPECT_FALSE(old.pull);
  EXPECT_EQ(old.end_of_stretch(), old.anharmonic->max_strain);
}

// Another EA, and another term of strain: by every way the pull begins where the window ends and keeps its shape.
// Nothing of a set that is unchanged is scaled, not by a bit, and one that does not say where its pull begins is as it
// was.
TEST(PullOfASet, FollowsTheEdgeOfTheWindow) {
  const std::string text = read_file(path);
  const ParameterSet set = parameters_of_text(text, path);
  const auto force = [](const ParameterSet& s, double strain) {
    return s.bond.stretch * strain + strain_energy(*s.anharmonic, s.anharmonic->max_strain, 0).by_strain +
           stretch_beyond(*s.anharmonic, s.bond.stretch, strain).by_strain;
  };
  const double start = set.anharmonic->max_strain, step = set.anharmonic->pull_step;
  for (int k = 1; k <= PULL_STEPS; ++k)
    EXPECT_NEAR(force(set, start + k * step) / set.pull->force[static_cast<std::size_t>(k)], 1, 1e-12) << k;
  const auto without = [](std::string lines) {
    for (const char* key : {"start", "edge_force"})
      if (const auto at = lines.find(std::string("\n") + key + " "); at != std::string::npos)
        lines.erase(at, lines.find('\n', at + 1) - at);
    return lines;
  };
  const std::string older = without(text);
  ASSERT_NE(older, text);
  const ParameterSet of_older = parameters_of_text(older, path);
  const Anharmonic &law = *set.anharmonic, &older_law = *of_older.anharmonic;
  EXPECT_TRUE(std::equal(law.pull_force, law.pull_force + PULL_STEPS + 1, older_law.pull_force));
  EXPECT_EQ(with_start_of_pull(text, path), text);
  EXPECT_NE(with_start_of_pull(older, path).find("edge_force"), std::string::npos);
  const std::string head = "[bond.pull]\n";
  const auto table = older.find(head), end = older.find("\n\n", table);
  std::string keys = "pull." + older.substr(table + head.size(), end + 1 - table - head.size());
  keys.insert(keys.find("\nend") + 1, "pull.");
  std::string dotted = older.substr(0, table) + older.substr(end + 2);
  dotted.insert(dotted.find("EA "), keys);
  ASSERT_EQ(parameters_of_text(dotted, path).pull->force, set.pull->force);
  for (const std::string& base : {text, older, dotted})
    for (const auto& [key, factor] : {std::pair("bond.EA", 0.6), std::pair("bond.anharmonic.e3", 1.1)}) {
      const std::string file = with_start_of_pull(base, path);
      const double value = find_quantity(set, key)->value;
      const ParameterSet by_text = parameters_of_text(
          with_value(file, std::string(key) + ".value", fmt::format("{:.17g}", factor * value), path), path);
      ParameterSet in_memory = parameters_of_text(base, path);
      for (Quantity& q : in_memory.quantities)
        if (q.key == key) q.value = factor * value;
      for (const ParameterSet& other : {by_text, parameters_of_text(parameters_text(in_memory, ""), path)}) {
        const double edge = edge_of_window(*other.anharmonic, other.bond.stretch).force /
                            edge_of_window(*set.anharmonic, set.bond.stretch).force;
        EXPECT_LT(edge, 0.99) << key;
        for (int k = 1; k <= PULL_STEPS; ++k)
          EXPECT_NEAR(force(other, start + k * step) / force(set, start + k * step), edge, 1e-7) << key << ' ' << k;
      }
    }
}

TEST(PullOfASet, ThatCannotBeIsRefused) {
  const auto message = [](const std::function<void(ParameterSet&)>& change) {
    ParameterSet set = read_parameters(path);
    change(set);
    try {
      parameters_of_text(parameters_text(set, ""), "set.toml");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const auto put_end = [](ParameterSet& set, double end) {
    for (Quantity& q : set.quantities)
      if (q.key == "bond.pull.end") q.value = end;
  };
  EXPECT_EQ(message([](ParameterSet&) {}), "accepted");
  EXPECT_THAT(message([](ParameterSet& s) { s.pull->force[5] = s.pull->force[4]; }),
              HasSubstr("bond.pull.force: does not rise from value 4 to value 5"));
  EXPECT_THAT(message([](ParameterSet& s) { s.pull->force[0] *= 1.2; }), HasSubstr("calibrate the set anew"));
  const auto put = [](ParameterSet& set, const std::string& key, double value) {
    for (Quantity& q : set.quantities)
      if (q.key == key) q.value = value;
  };
  EXPECT_THAT(message([&](ParameterSet& s) { put(s, "bond.anharmonic.max_strain", 0.05); }),
              HasSubstr("bond.pull.start: is "));
  EXPECT_THAT(message([&](ParameterSet& s) { put(s, "bond.pull.edge_force", 1); }), HasSubstr("edge_force is 1 nN"));
  EXPECT_THAT(message([&](ParameterSet& s) { put_end(s, 0.01); }), HasSubstr("bond.pull.end"));
  EXPECT_THAT(message([&](ParameterSet& s) { put_end(s, 0.9); }), HasSubstr("rises too little"));
}

TEST(MeasuredText, HasAsManyDigitsAsTheErrorAllows) {
  EXPECT_EQ(measured_text(740.83567, 0.0523), "740.836 ± 0.052");
  EXPECT_EQ(measured_text(1229.66, 18.2), "1230 ± 18");
  EXPECT_EQ(measured_text(-0.0090643, 1.0e-6), "-0.0090643 ± 0.0000010");
  EXPECT_EQ(measured_text(0.34710715, 9.8e-8), "0.347107150 ± 0.000000098");
  EXPECT_EQ(measured_text(358.4, 0), "358.4");
  EXPECT_EQ(measured_text(-3.2e-13, 2.5e-8), "0 ± 2.5e-08");
  EXPECT_EQ(measured_text(1814.42, 4756), "1814 ± 4756") << "an error that exceeds a value does not hide it";
}

// --- sets of filaments, without a lattice

const std::string filament_text = read_file(ROPEWALK_SOURCE_DIR "/data/parameters/cellulose-36.toml");

// The shipped filament with `old` replaced, or with lines behind a header; what the reader says of it.
std::string said_of_filament(const std::string& old, const std::string& by) {
  std::string text = filament_text;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), by);
  try {
    parameters_of_text(text, "set.toml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

// --- sets of other honeycombs than carbon

const std::string tube_text = read_file(ROPEWALK_SOURCE_DIR "/data/parameters/cnt-10-10-tersoff.toml");
const char* const lattice_table = R"([lattice]
name = "BN"
species = ["B", "N"]
bond_length = { value = 0.1425, unit = "nm", standard_error = 0, origin = "chosen" }
weight_1 = { value = 10.81, unit = "u", standard_error = 0, origin = "chosen" }
weight_2 = { value = 14.007, unit = "u", standard_error = 0, origin = "chosen" }
epsilon_11 = { value = 4e-3, unit = "eV", standard_error = 0, origin = "chosen" }
sigma_11 = { value = 0.35, unit = "nm", standard_error = 0, origin = "chosen" }
epsilon_12 = { value = 3e-3, unit = "eV", standard_error = 0, origin = "chosen" }
sigma_12 = { value = 0.34, unit = "nm", standard_error = 0, origin = "chosen" }
epsilon_22 = { value = 2e-3, unit = "eV", standard_error = 0, origin = "chosen" }
sigma_22 = { value = 0.33, unit = "nm", standard_error = 0, origin = "chosen" }

)";

std::string lattice_text() {
  std::string text = tube_text;
  return text.insert(text.find("[tube]"), lattice_table);
}

std::string said_of_lattice(const std::string& old, const std::string& by) {
  std::string text = lattice_text();
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), by);
  try {
    parameters_of_text(text, "set.toml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(LatticeSet, HasItsSpeciesMassAndName) {
  const ParameterSet carbon = parameters_of_text(tube_text, "set.toml"), set = parameters_of_text(lattice_text(), "set.toml");
  EXPECT_EQ(tube_name(carbon), "(10,10)");
  EXPECT_EQ(tube_name(set), "(10,10) BN");
  EXPECT_NEAR(set.element_mass(1) / carbon.element_mass(1), 0.5 * (10.81 + 14.007) / 12.011, 1e-12);
  EXPECT_EQ(set.honeycomb.pairs[1].sigma, 0.34);
  EXPECT_NEAR(set.honeycomb.bond_length(), 0.1425, 1e-15);
  EXPECT_FALSE(find_quantity(set, "bond.EA")->of_carbon) << "potentials of carbon say nothing of it";
  EXPECT_NO_THROW(refuse_other_than_carbon(carbon, "so"));
  EXPECT_THROW(refuse_other_than_carbon(set, "so"), InputError);
}

TEST(LatticeSet, IsReadAsItIsWritten) {
  const ParameterSet set = parameters_of_text(lattice_text(), "set.toml");
  const ParameterSet again = parameters_of_text(parameters_text(set, ""), "set.toml");
  EXPECT_EQ(again.honeycomb.name, "BN");
  EXPECT_EQ(again.honeycomb.species, set.honeycomb.species);
  EXPECT_EQ(again.honeycomb.atomic_weight, set.honeycomb.atomic_weight);
  EXPECT_EQ(again.honeycomb.lattice_constant, set.honeycomb.lattice_constant);
  ASSERT_EQ(again.quantities.size(), set.quantities.size());
  for (std::size_t k = 0; k < set.quantities.size(); ++k)
    EXPECT_EQ(again.quantities[k].value, set.quantities[k].value) << set.quantities[k].key;
}

TEST(LatticeSet, BadLatticesAreRefused) {
  EXPECT_THAT(said_of_lattice("[\"B\", \"N\"]", "[\"B\"]"), HasSubstr("species: are not two"));
  EXPECT_THAT(said_of_lattice("[\"B\", \"N\"]", "[\"B\", \"n\"]"), HasSubstr("species: names \"n\", which is no element"));
  EXPECT_THAT(said_of_lattice("species = [\"B\", \"N\"]\n", ""), HasSubstr("species: is missing"));
  EXPECT_THAT(said_of_lattice("name = \"BN\"", "name = \"C\""), HasSubstr("carbon is built in"));
  EXPECT_THAT(said_of_lattice("value = 0.1425", "value = 0.178"), HasSubstr("a (10,10) tube has about"));
  EXPECT_THAT(said_of_lattice("sigma_12 =", "sigma_21 ="), HasSubstr("sigma_12: is missing"));
  EXPECT_THAT(said_of_filament("[filament]", std::string(lattice_table) + "[filament]"),
              HasSubstr("lattice: is that of a tube"));
}

TEST(FilamentSet, HasTheMassOfItsFileAndOneLimitOfTwist) {
  const ParameterSet set = parameters_of_text(filament_text, "set.toml");
  ASSERT_TRUE(set.filament);
  EXPECT_FALSE(set.chirality.valid());
  EXPECT_EQ(tube_name(set), "cellulose-36");
  // 36 chains, two units of 162.14 u on 1.038 nm.
  EXPECT_NEAR(set.element_mass(2) * units::mass_unit_kg / (2 * 36 * 2 / 1.038 * 162.14 * units::atomic_mass_kg), 1, 1e-5);
  EXPECT_EQ(set.validity.collapse_at(set.radius, 0), set.validity.twist_collapse);
  EXPECT_EQ(set.validity.collapse_at(set.radius, 50), set.validity.twist_collapse);
}

TEST(FilamentSet, IsWrittenAsItIsRead) {
  const ParameterSet set = parameters_of_text(filament_text, "set.toml");
  const std::string text = parameters_text(set, "");
  const ParameterSet again = parameters_of_text(text, "set.toml");
  EXPECT_TRUE(again.filament);
  EXPECT_THAT(text, ::testing::Not(HasSubstr("chirality")));
  EXPECT_EQ(again.element_mass(1), set.element_mass(1));
  ASSERT_EQ(again.quantities.size(), set.quantities.size());
  for (std::size_t k = 0; k < set.quantities.size(); ++k) {
    EXPECT_EQ(again.quantities[k].key, set.quantities[k].key);
    EXPECT_EQ(again.quantities[k].value, set.quantities[k].value) << set.quantities[k].key;
  }
}

TEST(FilamentSet, RefusesWhatOnlyATubeHas) {
  const auto behind = [](const std::string& head, const std::string& lines) {
    return said_of_filament(head + "\n", head + "\n" + lines + "\n");
  };
  EXPECT_THAT(behind("[meta]", "chirality = [5, 5]"), HasSubstr("chirality: is that of a tube"));
  EXPECT_THAT(behind("[contact.line]", "sigma = 0.34"), HasSubstr("sigma: is of the atoms of a carbon tube"));
  EXPECT_THAT(said_of_filament("[validity]", "[atomistic]\n[validity]"), HasSubstr("atomistic: is of the lattice"));
  EXPECT_THAT(said_of_filament("[validity]", "[bond.anharmonic]\n[validity]"), HasSubstr("anharmonic: is of the wall"));
  EXPECT_THAT(said_of_filament("[filament]", "[tube]\n[filament]"), HasSubstr("tube: is that of a carbon tube"));
  EXPECT_THAT(
      behind("[validity]", "endless_collapse = { value = 1, unit = \"1\", standard_error = 0, origin = \"chosen\" }"),
      HasSubstr("endless_collapse: is of the wall"));
}

// A line of a number.
std::string number(const std::string& key, double value, const std::string& unit) {
  return fmt::format("{} = {{ value = {}, unit = \"{}\", standard_error = 0, origin = \"chosen\" }}\n", key, value, unit);
}

TEST(FilamentSet, HasANaturalShapeAndTwoStiffnesses) {
  std::string text = filament_text;
  const auto put = [&](const std::string& behind, const std::string& lines) {
    text.insert(text.find(behind) + behind.size(), lines);
  };
  put("[filament]\n", number("curvature_1", 0.01, "1/nm") + number("curvature_2", -0.02, "1/nm") +
                           number("twist_per_length", 0.1, "rad/nm"));
  const std::size_t EI = text.find("\nEI ") + 1;
  text.erase(EI, text.find('\n', EI) + 1 - EI);
  text.erase(text.find("[[correlation]]"));  // of the one EI
  put("[bond]\n", number("EI_1", 2000, "nN nm^2") + number("EI_2", 1000, "nN nm^2"));
  const ParameterSet set = parameters_of_text(text, "set.toml");
  EXPECT_DOUBLE_EQ(set.bond.bend, 1500 * units::nN_nm);
  EXPECT_DOUBLE_EQ(set.bond.bend_difference, 500 * units::nN_nm);
  EXPECT_EQ(vector(set.bond.natural), Vector3(0.01, -0.02, 0.1));
  const ParameterSet again = parameters_of_text(parameters_text(set, ""), "again.toml");
  EXPECT_EQ(vector(again.bond.natural), vector(set.bond.natural));
  EXPECT_EQ(again.bond.bend_difference, set.bond.bend_difference);
  EXPECT_FALSE(is_shaped(parameters_of_text(filament_text, "set.toml").bond));
}

TEST(FilamentSet, SaysWhatShapesItCannotHave) {
  EXPECT_THAT(said_of_filament("[filament]\n", "[filament]\n" + number("curvature", 0.1, "1/nm")),
              HasSubstr("curvature: has no direction"));
  EXPECT_THAT(said_of_filament("[filament]\n", "[filament]\n" + number("twist_per_length", 1, "rad/nm")),
              HasSubstr("the natural shape turns by"));
  EXPECT_THAT(said_of_filament("[bond]\n", "[bond]\n" + number("EI_1", 2, "nN nm^2")), HasSubstr("EI_1: stands beside EI"));
  EXPECT_THAT(said_of_filament("\nEI ", "\nEI_2 "), HasSubstr("EI_1: is missing"));
  std::string tube = tube_text;
  tube.replace(tube.find("\nEI "), 4, "\nEI_1 ");
  try {
    parameters_of_text(tube, "set.toml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("EI_1: is of a filament"));
  }
}

TEST(FilamentSet, WhoseWellIsNotThatOfItsLawIsRefused) {
  EXPECT_THAT(said_of_filament("pair_energy      = { value = -0.035", "pair_energy      = { value = -0.045"),
              HasSubstr("pair_energy: is -0.045"));
  EXPECT_THAT(said_of_filament("pair_spacing     = { value = 3.9", "pair_spacing     = { value = 4.9"),
              HasSubstr("pair_spacing: is 4.9"));
}

TEST(FilamentSet, IsWhatASetWithoutChiralityIsPointedTo) {
  std::string text = read_file(path);
  const std::size_t line = text.find("\nchirality");
  text.erase(line, text.find('\n', line + 1) - line);
  try {
    parameters_of_text(text, "set.toml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("what has no lattice of carbon has [filament] in place of [tube]"));
  }
}

// Potentials of carbon say nothing of a filament.
TEST(FilamentSet, HasNoErrorBetweenPotentialsOfCarbon) {
  const ParameterSet set = parameters_of_text(filament_text, "set.toml");
  EXPECT_THAT(measured_text(*find_quantity(set, "bond.EA")), ::testing::Not(HasSubstr("potential")));
  EXPECT_THAT(measured_text(*find_quantity(read_parameters(path), "bond.EA")), HasSubstr("potential"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
