// The shipped sets in the simulator, held to the surface integral that they came from: rows of elements, as a rope
// has them, against the integral over the two shells.
#include <gtest/gtest.h>

#include "atomistic/stiffness.hpp"
#include "atoms/lattice.hpp"
#include "contact/integral.hpp"
#include "io/parameters_toml.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/contact/paper.hpp"
#include "scene/laws/line.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "verbs/calibration.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

ParameterSet shipped(const std::string& name) { return read_parameters(find_parameters(name, "")); }

Scene scene_of(const std::vector<std::string>& names) {
  Scene s;
  for (const std::string& n : names) s.sets.push_back(shipped(n));
  s.contact.law = "line";
  s.element_length = s.sets[0].element_length;
  return s;
}

struct TubePair {
  const char *i, *j;
};
void PrintTo(const TubePair& p, std::ostream* out) { *out << p.i << " beside " << p.j; }

class ShippedPair : public ::testing::TestWithParam<TubePair> {
 protected:
  void SetUp() override {
    const Scene s = scene_of({GetParam().i, GetParam().j});
    const std::vector<LineContact> all = line_contacts(s);
    // A set beside itself is its own fit; beside another, the universal law.
    contact = std::string(GetParam().i) == GetParam().j ? line_contacts(scene_of({GetParam().i}))[0] : all[1];
    AtomLaw law;
    const LineParameters &a = *s.sets[0].law<LineParameters>(), &b = *s.sets[1].law<LineParameters>();
    ASSERT_EQ(a.universal.epsilon, law.epsilon);
    ASSERT_EQ(a.universal.lj_cutoff, law.cutoff);
    integral = std::make_unique<PairIntegral>(law, Shell{s.sets[0].radius, a.surface_density},
                                              Shell{s.sets[1].radius, b.surface_density});
  }

  double row(double distance, double shift) const {
    double sum = 0;
    for (int e = -20; e <= 20; ++e)
      sum += contact.energy({distance, 0, e * contact.length_j + shift}, Vector3::UnitZ(), Vector3::UnitZ());
    return sum / contact.length_i;
  }
  double crossing(double distance, double angle) const {
    const Vector3 ni = Vector3::UnitZ(), nj(0, std::sin(angle), std::cos(angle));
    const int reach = static_cast<int>(4.5 / (contact.length_i * std::sin(angle))) + 3;
    double sum = 0;
    for (int k = -reach; k <= reach; ++k)
      for (int l = -reach; l <= reach; ++l)
        sum += contact.energy(
            Vector3(distance, 0, 0) + (l + 0.3) * contact.length_j * nj - (k - 0.1) * contact.length_i * ni, ni,
            nj);
    return sum;
  }

  LineContact contact;
  std::unique_ptr<PairIntegral> integral;
};

TEST_P(ShippedPair, ParallelRowsHaveItsSpacingAndDepth) {
  const Well well = integral->parallel_well();
  double lowest = 0, at = 0;
  for (int k = -200; k <= 200; ++k) {
    const double R = well.distance * (1 + 1e-5 * k);
    if (const double e = row(R, 0.13); e < lowest) lowest = e, at = R;
  }
  EXPECT_NEAR(at / well.distance, 1, 1e-3);
  EXPECT_NEAR(lowest / well.energy, 1, 5e-3);
}

TEST_P(ShippedPair, CrossedRowsHaveItsEnergyAtEveryAngle) {
  const Well well = integral->crossed_well();
  for (const double degrees : {20.0, 30.0, 45.0, 60.0, 90.0}) {
    const double angle = degrees * units::degree;
    EXPECT_NEAR(crossing(well.distance, angle) * std::sin(angle) / well.energy, 1, 0.01) << degrees;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, ShippedPair,
                         ::testing::Values(TubePair{"cnt-5-5-tersoff", "cnt-5-5-tersoff"},
                                           TubePair{"cnt-9-0-tersoff", "cnt-9-0-tersoff"},
                                           TubePair{"cnt-12-6-tersoff", "cnt-12-6-tersoff"},
                                           TubePair{"cnt-10-10-tersoff", "cnt-10-10-tersoff"},
                                           TubePair{"cnt-20-20-tersoff", "cnt-20-20-tersoff"},
                                           TubePair{"cnt-10-10-tersoff", "cnt-5-5-tersoff"}));

TEST(ShippedSets, AreAllThereAndReadable) {
  for (const char* tube :
       {"5-5", "6-6", "8-8", "10-10", "12-12", "15-15", "20-20", "9-0", "17-0", "6-4", "8-2", "12-6", "16-4"}) {
    const ParameterSet set = shipped("cnt-" + std::string(tube) + "-tersoff");
    EXPECT_TRUE(set.law<LineParameters>() && set.law<LineParameters>()->has_universal) << tube;
    EXPECT_TRUE(set.law<PaperContact>()) << tube;
    EXPECT_EQ(set.quantities[0].origin, "calibrated");
    // A thin shell: EI = EA r^2/2 within a few per cent, whatever the chirality.
    EXPECT_NEAR(set.bond.bend / (0.5 * set.bond.stretch * set.radius * set.radius), 1, 0.04) << tube;
    EXPECT_NEAR(set.bond.shear / thin_tube_shear(set.bond, set.radius), 1, 1e-9) << tube;
  }
  for (const char* potential : {"airebo", "rebo", "lcbop"}) shipped("cnt-10-10-" + std::string(potential));
}

// The energies of the atoms from which the sets were made, by chains of short, middle and long elements: stretched
// and twisted at once up to the limits, and bent. Small energies are compared with a twentieth of the largest.
TEST(ShippedSets, AnharmonicBondsHaveTheEnergiesOfTheAtoms) {
  for (const char* tube :
       {"5-5", "10-10", "17-0", "12-6", "8-2", "6-4", "6-6", "8-8", "9-0", "12-12", "16-4", "15-15", "20-20"}) {
    const ParameterSet set = shipped("cnt-" + std::string(tube) + "-tersoff");
    ASSERT_TRUE(set.anharmonic) << tube;
    const BondStiffness bond = set.anharmonic_bond(0);
    const double natural = find_quantity(set, "atomistic.natural_twist")->value;
    const auto chain = [&](double a, double strain, double twist, double curvature) {
      const double turn = curvature * a, chord = turn > 0 ? 2 / curvature * std::sin(0.5 * turn) : a;
      const Quaternion half(Eigen::AngleAxisd(0.5 * turn, Vector3::UnitY()));
      const Quaternion j = half * Quaternion(Eigen::AngleAxisd(twist * a, Vector3::UnitZ()));
      return bond_energy(bond, a, Vector3(0, 0, (1 + strain) * chord), frame_of(half.conjugate()), frame_of(j))
                 .total() /
             a;
    };
    const std::vector<AtomisticRow> rows =
        read_atomistic_csv(set.path.substr(0, set.path.size() - 5) + "-stiffness.csv");
    double largest = 0;
    int compared = 0;
    for (const AtomisticRow& row : rows)
      if (row.kind == "wide-stretch-twist") largest = std::max(largest, row.energy / row.length);
    const auto compare = [&](double atoms, double strain, double twist, double curvature) {
      const double middle = chain(1.36, strain, twist, curvature);
      EXPECT_NEAR(middle, atoms, 0.01 * std::max(atoms, 0.05 * largest))
          << tube << ": strain " << strain << ", twist " << twist << ", curvature " << curvature;
      for (const double a : {0.7, 2.7})
        EXPECT_NEAR(chain(a, strain, twist, curvature), middle, 0.005 * std::max(middle, 1e-6));
      ++compared;
    };
    for (const AtomisticRow& row : rows) {
      const double twist = row.twist - natural;
      if (row.kind == "wide-stretch-twist" && set.radius * std::fabs(twist) < bond.anharmonic.max_shear)
        compare(row.energy / row.length, row.strain, twist, 0);
      for (const AtomisticRow& other : rows)
        if (row.kind == "wide-bend-long" && other.kind == "wide-bend-short" && row.curvature > 0 &&
            row.curvature == other.curvature)
          compare((row.energy - other.energy) / (row.length - other.length), 0, 0, row.curvature);
    }
    EXPECT_GT(compared, 20) << tube;
  }
}

// The pulls from which the sets were made: mean forces between their rows.
TEST(ShippedSets, PulledBondsHaveTheForcesOfTheAtoms) {
  for (const char* tube :
       {"5-5", "10-10", "17-0", "12-6", "8-2", "6-4", "6-6", "8-8", "9-0", "12-12", "16-4", "15-15", "20-20"}) {
    const ParameterSet set = shipped("cnt-" + std::string(tube) + "-tersoff");
    ASSERT_TRUE(set.pull) << tube;
    const BondStiffness bond = set.anharmonic_bond(0);
    const double twist = -find_quantity(set, "atomistic.natural_twist")->value;
    const auto energy = [&](double strain, double of) {
      const Frame j = frame_of(Quaternion(Eigen::AngleAxisd(twist + of, Vector3::UnitZ())));
      return bond_energy(bond, 1, Vector3(0, 0, 1 + strain), frame_of(Quaternion::Identity()), j).total();
    };
    std::vector<AtomisticRow> rows;
    for (const AtomisticRow& row : read_atomistic_csv(set.path.substr(0, set.path.size() - 5) + "-stiffness.csv"))
      if (row.kind == "pull") rows.push_back(row);
    ASSERT_GT(rows.size(), 20u) << tube;
    EXPECT_NEAR(rows.back().strain, set.pull->end, 1e-9);
    for (std::size_t k = 5; k < rows.size(); ++k) {
      const double a = rows[k - 1].strain, b = rows[k].strain,
                   atoms = (rows[k].energy - rows[k - 1].energy) / rows[k].length;
      EXPECT_NEAR((energy(b, rows[k].twist) - energy(a, rows[k].twist)) / atoms, 1, 0.02) << tube << " " << b;
    }
  }
}

TEST(ShippedSets, TheTenTenTubeIsTheReference) {
  const ParameterSet set = shipped("cnt-10-10-tersoff");
  const double angstrom = 0.1;  // nm
  EXPECT_NEAR(set.radius, 0.6888, 5e-5);
  EXPECT_NEAR(set.bond.stretch * angstrom, 948, 0.005 * 948);
  EXPECT_NEAR(set.bond.bend / angstrom, 22646, 0.005 * 22646);
  EXPECT_NEAR(set.bond.twist / angstrom, 20604, 0.005 * 20604);
}

// Real atoms, of a chiral tube as well: over all registries their mean is the surface integral.
TEST(AtomByAtom, MeanOverRegistryIsTheSurfaceIntegral) {
  for (const Chirality c : {Chirality{8, 2}, Chirality{10, 10}}) {
    const TubeCell cell = tube_cell(c, translation_vector(c));
    const AtomColumn column{cell.atoms, cell.length};
    const AtomLaw law;
    const Shell shell{cell.radius, graphene_density(graphene_lattice_constant)};
    const Well well = parallel_well(law, shell, shell);
    const RegistrySpread spread = registry_spread({law, law, law}, column, column, well.distance);
    EXPECT_NEAR(spread.mean / well.energy, 1, 5e-3) << c.n << "," << c.m;
    EXPECT_GT(spread.deviation, 0);
    EXPECT_LT(spread.deviation, 0.03 * std::fabs(well.energy));
    RecordProperty("registry_" + std::to_string(c.n) + "_" + std::to_string(c.m),
                   std::to_string(spread.deviation / std::fabs(well.energy)));
  }
}

TEST(UniversalLaw, ScalesWithEpsilonAndRefusesAnotherCutoff) {
  AtomLaw law;
  const auto one = universal_law(law);
  ASSERT_TRUE(one);
  law.epsilon *= 2;
  const auto two = universal_law(law);
  ASSERT_TRUE(two);
  EXPECT_NEAR(two->density(0.5, 38, 0.7, 38).K / one->density(0.5, 38, 0.7, 38).K, 2, 1e-12);
  law.cutoff = 1.0;
  EXPECT_FALSE(universal_law(law));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
