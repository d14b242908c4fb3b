// Elements become atoms, the atoms are found as tubes without their order, and give the same elements.
#include <gtest/gtest.h>

#include <numeric>

#include "atoms/support.hpp"
#include "atoms/tube_reference.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using namespace test;

// The largest distance and turn of two states, where the sections of the second may all be turned by one of g equal
// parts of a turn, which changes no atom.
struct Difference {
  double distance = 0, turn = 0;
};
Difference difference(const State& a, const State& b, int g) {
  Difference best{1e9, 1e9};
  for (int k = 0; k < g; ++k) {
    const Quaternion part(Eigen::AngleAxisd(2 * units::pi * k / g, Vector3::UnitZ()));
    Difference here;
    for (std::size_t i = 0; i < a.size(); ++i) {
      here.distance = std::max(here.distance, (a.position[i] - b.position[i]).norm());
      here.turn = std::max(here.turn, a.orientation[i].angularDistance(b.orientation[i] * part));
    }
    if (here.turn < best.turn) best = here;
  }
  return best;
}

// The elements that are found in the atoms of a state.
State found_again(const Elements& rod, const TubeReference& reference, unsigned seed, double noise = 0) {
  std::vector<Vector3> atoms = atoms_of(rod, reference);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  if (noise > 0)
    for (Vector3& x : atoms) x += noise * Vector3(normal(random), normal(random), normal(random));
  std::shuffle(atoms.begin(), atoms.end(), random);
  const FoundTubes found = found_in(atoms);
  EXPECT_EQ(found.tubes.size(), 1u);
  const int n = rod.topology.length_of(0);
  const ElementFit fit(reference, rod.topology.types[0].element_length, n, found.tubes[0].atoms);
  State state(static_cast<std::size_t>(n));
  fit.fit(found.positions, state, 0);
  return state;
}

// A tube of two species is found with the first one on the first sublattice, wherever its heights rise.
TEST(TwoSpecies, AreFoundOnTheirSublattices) {
  Honeycomb h;
  h.name = "BN";
  h.species = {"B", "N"};
  h.lattice_constant = 0.2511;
  const Chirality c{6, 2};
  TubeShape shape = rolled_shape(c, h.lattice_constant);
  shape.lift = 0.002;
  const std::vector<Site> sites = strip_sites(c, 60);
  for (const bool upside_down : {false, true}) {
    std::vector<Vector3> atoms;
    std::vector<char> species;
    const Eigen::AngleAxisd turn(upside_down ? units::pi : 0.0, Vector3::UnitX());
    for (const Site& site : sites) {
      atoms.push_back(turn * place(c, site, shape));
      species.push_back(site.second ? 2 : 1);
    }
    const FoundTubes found = find_tubes(atoms, species, {}, "atoms", h);
    ASSERT_EQ(found.tubes.size(), 1u);
    EXPECT_EQ(found.tubes[0].chirality.n, 6);
    EXPECT_EQ(found.tubes[0].chirality.m, 2);
    ASSERT_GT(found.tubes[0].atoms.size(), 90u);
    for (const LabelledAtom& atom : found.tubes[0].atoms) EXPECT_EQ(atom.site.second, species[atom.atom] == 2);
  }
}

class RoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, GivesTheElementsUpToTheLimitsOfTheSet) {
  const ParameterSet set = shipped(GetParam());
  const TubeReference reference = reference_of(set);
  const double a = set.element_length;
  const int g = std::gcd(set.chirality.n, set.chirality.m);
  for (const double part : {0.0, 0.5, 1.0}) {
    const double twist = part * set.validity.twist_collapse / set.radius, bend = part * set.validity.kink_curvature,
                 strain = part * set.validity.stretch;
    for (const RodShape& shape :
         {RodShape{strain, 0, 0}, RodShape{-strain, 0, 0}, RodShape{0, twist, 0}, RodShape{0, -twist, 0},
          RodShape{0, 0, bend}, RodShape{0.5 * strain, twist, bend}}) {
      const Elements before = rod(8, a, shape);
      const Difference d = difference(before.state, found_again(before, reference, 7), g);
      EXPECT_LT(d.distance, 1e-3) << "at " << part << " of the limits";
      EXPECT_LT(d.turn, 1e-3) << "at " << part << " of the limits";
    }
  }
}

// A tube whose bonds broke behind elements 2 and 3, its pieces drawn apart: each keeps its own atoms, and none lies
// between.
TEST(BrokenTube, HasNoAtomsWhereItBroke) {
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  Elements whole = rod(8, set.element_length, {0, 0, 0});
  const TubeReference reference = reference_of(set);
  const std::vector<TubePart> parts = {{0, 0, 3}, {0, 3, 4}, {0, 4, 8}};
  const auto shift_of = [](int element) { return element < 3 ? 0.0 : element < 4 ? 2.0 : 5.0; };
  std::vector<PlacedAtom> wanted;
  AtomsOfElements(whole.topology, whole.state, {reference}, parts).for_each([&](PlacedAtom atom) {
    atom.position.z() += shift_of(atom.element);
    wanted.push_back(atom);
  });
  for (int e = 3; e < 8; ++e) {
    const auto i = static_cast<std::size_t>(e);
    whole.state.position.set(i, whole.state.position[i] + Vector3(0, 0, shift_of(e)));
  }
  std::size_t at = 0;
  AtomsOfElements(whole.topology, whole.state, {reference}, parts, {0, 0, 1, 1, 0, 0, 0, 0})
      .for_each([&](const PlacedAtom& atom) {
        ASSERT_LT(at, wanted.size());
        EXPECT_LT((atom.position - wanted[at].position).norm(), 1e-9) << "element " << atom.element;
        ++at;
      });
  EXPECT_EQ(at, wanted.size());
}

INSTANTIATE_TEST_SUITE_P(Sets, RoundTrip,
                         ::testing::Values("cnt-5-5-tersoff", "cnt-10-10-tersoff", "cnt-17-0-tersoff",
                                           "cnt-12-6-tersoff", "cnt-8-2-tersoff"));

// Twist and bend that change from bond to bond, and sheared sections: what no element alone shows.
TEST(RoundTripOfElements, GivesElementsThatAreAllDifferent) {
  const ParameterSet set = shipped("cnt-10-10-tersoff");
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Elements before = rod(12, set.element_length, {});
  for (std::size_t i = 0; i < before.state.size(); ++i) {
    before.state.position.set(
        i, before.state.position[i] + 0.02 * Vector3(normal(random), normal(random), normal(random)));
    Vector3 turn = 0.03 * Vector3(normal(random), normal(random), normal(random));
    before.state.orientation.set(i, Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized())));
  }
  const Difference d = difference(before.state, found_again(before, reference_of(set), 5), 10);
  EXPECT_LT(d.distance, 1e-5);
  EXPECT_LT(d.turn, 1e-5);
}

// Upside down a tube has its other sublattice below: it keeps all of its elements.
TEST(RoundTripOfElements, KeepsTheElementsOfATubeThatIsUpsideDown) {
  for (const char* name : {"cnt-17-0-tersoff", "cnt-12-6-tersoff", "cnt-9-0-tersoff"}) {
    const ParameterSet set = shipped(name);
    Elements rod8 = rod(8, set.element_length, {});
    std::vector<Vector3> atoms = atoms_of(rod8, reference_of(set));
    for (Vector3& x : atoms) x = Vector3(x.x(), -x.y(), -x.z());
    const FoundTubes found = found_in(atoms);
    ASSERT_EQ(found.tubes.size(), 1u);
    EXPECT_EQ(found.tubes[0].without_site, 0) << name;
    const ElementFit fit(reference_of(set), set.element_length, 8, found.tubes[0].atoms);
    EXPECT_GT(fit.filled(0), 0.85) << name;
    EXPECT_GT(fit.filled(7), 0.75) << name;
  }
}

// Displacements of 0.01 nm of every atom move an element of N by 0.01/sqrt(N), twice as much with its neighbours.
TEST(RoundTripOfElements, AveragesTheNoiseOfAtoms) {
  const ParameterSet set = shipped("cnt-10-10-tersoff");
  const Elements before = rod(10, set.element_length, {0, 0.05, 0.05});
  const Difference d = difference(before.state, found_again(before, reference_of(set), 5, 0.01), 10);
  const double atoms = set.atoms_per_length * set.element_length;
  EXPECT_LT(d.distance, 10 * 0.01 / std::sqrt(atoms));
  EXPECT_LT(d.turn, 14 * 0.01 / set.radius / std::sqrt(atoms));
  EXPECT_GT(d.distance, 0.2 * 0.01 / std::sqrt(atoms));
}

// Velocities of atoms at 300 K: motion of their elements along each axis and turning about each has that
// temperature.
TEST(RoundTripOfElements, KeepsTheTemperatureOfAtoms) {
  constexpr double kT = units::boltzmann * 300;
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  const double a = set.element_length;
  constexpr int n = 300;
  const TubeReference reference = reference_of(set);
  const FoundTubes found = found_in(atoms_of(rod(n, a, {}), reference));
  ASSERT_EQ(found.tubes.size(), 1u);
  std::mt19937 random(300);
  std::normal_distribution<double> normal(0, std::sqrt(kT / units::carbon_mass));
  std::vector<Vector3> velocities;
  for (std::size_t i = 0; i < found.positions.size(); ++i)
    velocities.emplace_back(normal(random), normal(random), normal(random));
  const ElementFit fit(reference, a, n, found.tubes[0].atoms);
  State state(n);
  fit.fit(found.positions, state, 0);
  fit.fit_velocities(found.positions, velocities, state, 0);
  const double mass = set.element_mass(a), along = set.element_inertia(a),
               across = mass * (0.5 * set.radius * set.radius + a * a / 12);
  double energy[6] = {};  // in kT/2, means of a component of all elements
  for (std::size_t e = 0; e < n; ++e) {
    const Vector3 v = state.velocity[e], w = state.angular_velocity[e];
    for (int k = 0; k < 3; ++k) {
      energy[k] += mass * v[k] * v[k] / kT / n;
      energy[3 + k] += (k == 2 ? along : across) * w[k] * w[k] / kT / n;
    }
  }
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(energy[k], 1, 3.5 * std::sqrt(2.0 / n)) << "component " << k;
}

TEST(AtomsOfElements, CountWithoutPlacingThem) {
  for (const char* name : {"cnt-8-2-tersoff", "cnt-17-0-tersoff"}) {
    const ParameterSet set = shipped(name);
    const Elements e = rod(9, set.element_length, {});
    const TubeReference reference = reference_of(set);
    const AtomsOfElements all(e.topology, e.state, {reference}, {{0, 0, 9}}),
        parts(e.topology, e.state, {reference}, {{0, 0, 4}, {0, 4, 9}});
    long placed = 0;
    all.for_each([&](const PlacedAtom&) { ++placed; });
    EXPECT_EQ(all.count(), placed);
    EXPECT_EQ(parts.count(), placed) << "each atom belongs to one element";
    EXPECT_NEAR(static_cast<double>(placed), set.atoms_per_length * 9 * set.element_length,
                2 * set.chirality.n + 2);
  }
}

// Bonds of a bent, twisted and stretched tube are near those at rest: no atom is misplaced at the border of
// elements.
TEST(AtomsOfElements, KeepTheLengthsOfBonds) {
  const ParameterSet set = shipped("cnt-12-6-tersoff");
  const std::vector<Vector3> atoms = atoms_of(rod(6, set.element_length, {0.01, 0.02, 0.05}), reference_of(set));
  for (std::size_t i = 0; i < atoms.size(); i += 5) {
    int bonds = 0;
    for (std::size_t j = 0; j < atoms.size(); ++j) {
      const double d = (atoms[i] - atoms[j]).norm();
      if (i == j || d > 0.19) continue;
      ++bonds;
      EXPECT_GT(d, 0.133);
      EXPECT_LT(d, 0.153);
    }
    EXPECT_GE(bonds, 1);
    EXPECT_LE(bonds, 3);
  }
}

TEST(TubeReference, RefusesASetThatIsNoCarbonTube) {
  ParameterSet set = shipped("cnt-10-10-tersoff");
  set.radius *= 1.5;
  EXPECT_THROW(reference_of(set), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
