// Tubes of two species: the file that names them, and the contact of their atoms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "atomistic/runs.hpp"
#include "atoms/honeycomb_file.hpp"
#include "contact/integral.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string shipped_text = read_file(data_directory() + "/atoms/BN.toml");

// The reader's message about the shipped file with `old` replaced.
std::string said(const std::string& old, const std::string& by, const std::string& potential = "") {
  const TemporaryFolder folder;
  std::string text = shipped_text;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  text.replace(at, old.size(), by);
  const std::string path = folder.path() + "/mine.toml";
  std::ofstream(path) << text;
  try {
    potential_of_atoms(path, potential);
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos);
    return what;
  }
  return "accepted";
}

SpeciesLaws laws_of(const Honeycomb& h, double cutoff) {
  SpeciesLaws out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = {h.pairs[k].epsilon, h.pairs[k].sigma, cutoff};
  return out;
}

TEST(Honeycomb, ShippedFileHasSpeciesPotentialsAndContact) {
  const Potential extep = potential_of_atoms("BN", ""), tersoff = potential_of_atoms("BN", "tersoff");
  EXPECT_EQ(extep.name, "extep");
  ASSERT_EQ(tersoff.commands.size(), 2u);
  EXPECT_THAT(tersoff.commands[1], HasSubstr("BNC.tersoff B N"));
  EXPECT_EQ(extep.honeycomb.stem(), "bn");
  EXPECT_NEAR(extep.honeycomb.bond_length(), 0.145, 1e-12);
  EXPECT_NEAR(extep.honeycomb.mean_mass() / units::atomic_mass, 0.5 * (10.81 + 14.007), 1e-12);
  EXPECT_EQ(potential_of_atoms("C", "").name, "tersoff");
  EXPECT_TRUE(potential_of_atoms("", "lcbop").honeycomb.carbon());
}

TEST(Honeycomb, BadFilesAreRefusedInOneLine) {
  EXPECT_THAT(said("species = [\"B\", \"N\"]", "species = [\"B\"]"), HasSubstr("species: has 1 name"));
  EXPECT_THAT(said("species = [\"B\", \"N\"]", "species = [\"B\", \"nitrogen\"]"),
              HasSubstr("species: names \"nitrogen\", which is no element"));
  EXPECT_THAT(said("species = [\"B\", \"N\"]", ""), HasSubstr("species: is missing"));
  EXPECT_THAT(said("name = \"BN\"", "name = \"C\""), HasSubstr("carbon is built in"));
  EXPECT_THAT(said("name = \"BN\"", "name = \"../BN\""), HasSubstr("write up to 12 letters and digits"));
  EXPECT_THAT(said("BN.extep", "BN.nowhere"), HasSubstr("BN.nowhere: the potential file is not in"));
  EXPECT_THAT(said("\"extep\"\nfile", "\"extep $x\"\nfile"), HasSubstr("pair_style: names a variable"));
  EXPECT_THAT(said("[lennard_jones]", "[other]"), HasSubstr("lennard_jones: is missing"));
  EXPECT_THAT(said("epsilon_eV = [4.1196e-3, 3.3564e-3]", "epsilon_eV = [4.1196e-3, 0]"), HasSubstr("epsilon_eV"));
  EXPECT_THAT(said("bond_length_nm = 0.145", "bond_length_nm = 1.45"), HasSubstr("bond_length_nm"));
  EXPECT_THAT(said("10.1021/j100389a010", "j100389a010"), HasSubstr("doi"));
  EXPECT_THAT(said("BN", "BN", "airebo"), HasSubstr("potential: 'airebo' is none of BN; choose extep or tersoff"));
  try {
    potential_of_atoms("SiC", "");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("--atoms: is \"SiC\"; name one of BN, C"));
  }
}

// Half of the atoms of each shell are of each species.
TEST(Honeycomb, LawOfShellsIsTheSumOverThePairsOfSpecies) {
  const Honeycomb h = potential_of_atoms("BN", "").honeycomb;
  const PairLaw mean = shell_law(h.pairs);
  const SpeciesLaws laws = laws_of(h, 1.2);
  const AtomLaw law{mean.epsilon, mean.sigma, 1.2};
  for (const double d : {0.28, 0.34, 0.5, 1.1})
    EXPECT_NEAR(law.energy(d), 0.25 * (laws[0].energy(d) + 2 * laws[1].energy(d) + laws[2].energy(d)),
                1e-12 * std::abs(law.energy(d)));
}

// Sums over the atoms of two tubes, over many turns and shifts, against the integral over two shells.
TEST(Honeycomb, AtomsOfTwoSpeciesAttractAsTheIntegralSays) {
  const Honeycomb h = potential_of_atoms("BN", "").honeycomb;
  const Chirality c{8, 4};
  const TubeCell cell = tube_cell(c, translation_vector(c), h.lattice_constant);
  AtomColumn column{cell.atoms, cell.length, {}};
  for (std::size_t k = 0; k < cell.atoms.size(); ++k) column.second.push_back(k >= cell.atoms.size() / 2 ? 1 : 0);
  const PairLaw mean = shell_law(h.pairs);
  const Shell shell{cell.radius, graphene_density(h.lattice_constant)};
  const Well well = PairIntegral({mean.epsilon, mean.sigma, 1.2}, shell, shell).parallel_well();
  const RegistrySpread atoms = registry_spread(laws_of(h, 1.2), column, column, well.distance, 200);
  EXPECT_NEAR(atoms.mean / well.energy, 1, 2e-3);
  // The law of one species alone gives another energy: the laws are not mixed up.
  SpeciesLaws wrong = laws_of(h, 1.2);
  wrong[2] = wrong[0];
  EXPECT_GT(std::abs(registry_spread(wrong, column, column, well.distance, 50).mean / well.energy - 1), 0.02);
}

// Types, masses and the lift of a relaxed tube. Both ends of a bond of boron nitride are alike by its potentials: no
// lift. Of silicon carbide silicon lies outside.
TEST(Honeycomb, RelaxedTubeHasItsSpeciesAndTheirLift) {
  const TemporaryFolder folder;
  std::string text = shipped_text;
  const std::pair<const char*, const char*> changes[] = {{"\"BN\"", "\"SiC\""},
                                                         {"[\"B\", \"N\"]", "[\"Si\", \"C\"]"},
                                                         {"[10.81, 14.007]", "[28.085, 12.011]"},
                                                         {"0.145", "0.178"},
                                                         {"\"extep\"", "\"tersoff2\""},
                                                         {"\"extep\"", "\"tersoff\""},
                                                         {"BN.extep", "SiC.tersoff"},
                                                         {"[\"B\", \"N\"]", "[\"Si\", \"C\"]"},
                                                         {"0.22", "0.30"},
                                                         {"0.18", "0.22"}};
  for (const auto& [old, by] : changes) text.replace(text.find(old), std::string(old).size(), by);
  std::ofstream(folder.path() + "/sic.toml") << text;
  const Potential silicon_carbide = potential_of_atoms(folder.path() + "/sic.toml", "tersoff2");
  const StiffnessOptions for_sic;
  const std::string sic_path = folder.path() + "/sic";
  RunContext sic{{5, 5}, silicon_carbide, sic_path, for_sic, 0, {}};
  EXPECT_GT(std::abs(relax_tube(sic).shape.lift), 1e-4);
  const Potential potential = potential_of_atoms("BN", "extep");
  const StiffnessOptions options;
  const std::string path = folder.path() + "/run";
  RunContext run{{5, 5}, potential, path, options, 0, {}};
  const RelaxedTube tube = relax_tube(run);
  const std::string data = read_file(path + "/relax.data");
  EXPECT_THAT(data, HasSubstr("2 atom types"));
  EXPECT_THAT(data, HasSubstr("1 10.81\n2 14.007\n"));
  EXPECT_NEAR(tube.shape.lift, 0, 1e-7);
  EXPECT_NEAR(tube.shape.radius / tube_radius({5, 5}, potential.honeycomb.lattice_constant), 1, 0.03);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
