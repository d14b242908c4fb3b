// Atoms of tubes, by counting and measuring: every bond, every neighbour, the twist and the hand.
#include "atoms/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

const double bond = graphene_lattice_constant / std::sqrt(3.0);

std::vector<Chirality> tubes() {
  return {{10, 10}, {5, 5}, {9, 0}, {17, 0}, {6, 4}, {8, 2}, {12, 6}, {16, 4}, {10, 9}, {7, 1}, {15, 10}, {20, 20}};
}

// Periods with and without twist, of either orientation.
std::vector<LatticeVector> periods(Chirality c) {
  const LatticeVector t = translation_vector(c);
  return {t,
          {-t.p, -t.q},
          {2 * t.p, 2 * t.q},
          {t.p + 1, t.q},
          {t.p, t.q + 1},
          {3 * t.p - 1, 3 * t.q + 2},
          {t.p + 5 * c.n, t.q + 5 * c.m}};
}

// Distances to all atoms within `reach`, over the periodic images along z.
std::vector<double> distances(const TubeCell& cell, std::size_t i, double reach) {
  std::vector<double> found;
  const int images = 1 + static_cast<int>(reach / cell.length);
  for (std::size_t j = 0; j < cell.atoms.size(); ++j)
    for (int image = -images; image <= images; ++image) {
      if (i == j && image == 0) continue;
      const double d = (cell.atoms[j] + Vector3(0, 0, image * cell.length) - cell.atoms[i]).norm();
      if (d < reach) found.push_back(d);
    }
  return found;
}

TEST(Lattice, CellHasTwoAtomsForEachHexagonEachOnce) {
  for (const Chirality c : tubes())
    for (const LatticeVector v : periods(c)) {
      const TubeCell cell = tube_cell(c, v);
      const long hexagons = std::abs(static_cast<long>(c.n) * v.q - static_cast<long>(c.m) * v.p);
      ASSERT_EQ(static_cast<long>(cell.atoms.size()), 2 * hexagons) << c.n << "," << c.m;
      EXPECT_NEAR(static_cast<double>(cell.atoms.size()) / cell.length, atoms_per_length(c), 1e-9);
      for (std::size_t i = 0; i < cell.atoms.size(); i += 7) {
        EXPECT_EQ(distances(cell, i, 0.6 * bond).size(), 0u) << "two atoms in one place";
        EXPECT_GE(cell.atoms[i].z(), -1e-12);
        EXPECT_LT(cell.atoms[i].z(), cell.length - 1e-12);
        EXPECT_NEAR(std::hypot(cell.atoms[i].x(), cell.atoms[i].y()), tube_radius(c), 1e-12);
      }
    }
}

TEST(Lattice, SitesOfAStripAreDifferentOnTheTube) {
  for (const Chirality c : tubes()) {
    const long g = std::gcd(c.n, c.m);
    const long hexagons = 12 * g;
    std::set<std::tuple<long, long, bool>> seen;
    for (const Site& s : strip_sites(c, hexagons)) {
      EXPECT_GE(height_in_thirds(c, s), 0);
      EXPECT_LT(height_in_thirds(c, s), 3 * hexagons);
      // Brought to 0 <= arc < turn: the name of the site on the tube.
      const long turn = 2L * (c.n * c.n + c.n * c.m + c.m * c.m);
      const long arc = s.i * (2L * c.n + c.m) + s.j * (2L * c.m + c.n);
      seen.insert({height_in_thirds(c, s), ((arc % turn) + turn) % turn, s.second});
    }
    EXPECT_EQ(static_cast<long>(seen.size()), 2 * hexagons);
    EXPECT_THROW(strip_sites(c, 0), std::invalid_argument);
    if (g > 1) {
      EXPECT_THROW(strip_sites(c, 12 * g + 1), std::invalid_argument);
    }
  }
}

TEST(Lattice, EveryAtomHasThreeBondsAlsoAcrossTheTwistedBoundary) {
  for (const Chirality c : tubes())
    for (const LatticeVector v : periods(c)) {
      const TubeCell cell = tube_cell(c, v);
      // A wrong twist of the boundary would break bonds there. Wild twists stretch all bonds alike: leave them out.
      if (std::abs(cell.twist) * cell.radius > 0.05) continue;
      const double curved = bond * bond / (24 * cell.radius * cell.radius);  // chord against arc
      const double sheared = std::abs(cell.twist) * cell.radius;
      for (std::size_t i = 0; i < cell.atoms.size(); i += 3) {
        const std::vector<double> near = distances(cell, i, 1.25 * bond);
        ASSERT_EQ(near.size(), 3u) << c.n << "," << c.m << " period " << v.p << "," << v.q << " atom " << i;
        for (const double d : near) EXPECT_NEAR(d / bond, 1, 1.2 * curved + 0.6 * sheared + 1e-9);
      }
    }
}

TEST(Lattice, TwistOfTheCellIsThatOfItsPeriod) {
  const Chirality c{10, 10};
  const TubeCell straight = tube_cell(c, translation_vector(c));
  EXPECT_EQ(straight.twist, 0);
  EXPECT_NEAR(straight.length, graphene_lattice_constant, 1e-12);
  for (const LatticeVector v : {LatticeVector{-39, 40}, LatticeVector{-40, 39}}) {
    // (-39,40) = 39 T + (0,1) runs by half a T up and sqrt(3)/2 a around it, and its mirror image the other way.
    const TubeCell cell = tube_cell(c, v);
    EXPECT_NEAR(cell.length, 39.5 * graphene_lattice_constant, 1e-9);
    const double around = 0.5 * std::sqrt(3.0) * graphene_lattice_constant * (v.p == -39 ? 1 : -1);
    EXPECT_NEAR(cell.twist, -around / (cell.radius * cell.length), 1e-12);
  }
  // A whole turn around the tube is no twist at all.
  const LatticeVector t = translation_vector(c);
  EXPECT_EQ(tube_cell(c, {t.p + 3 * c.n, t.q + 3 * c.m}).twist, 0);
  EXPECT_THROW(tube_cell(c, {10, 10}), std::invalid_argument);
  EXPECT_THROW(tube_cell({0, 0}, {1, 0}), std::invalid_argument);
}

// Signed volumes spanned by the three bonds of every atom and the normal do not see the hand of a tube; the angle
// of the steepest bond against the axis does.
double mean_hand(const TubeCell& cell) {
  double sum = 0;
  for (std::size_t i = 0; i < cell.atoms.size(); ++i) {
    const Vector3 a = cell.atoms[i];
    const Vector3 around = Vector3(-a.y(), a.x(), 0).normalized();
    for (std::size_t j = 0; j < cell.atoms.size(); ++j)
      for (int image = -1; image <= 1; ++image) {
        const Vector3 d = cell.atoms[j] + Vector3(0, 0, image * cell.length) - a;
        if (d.norm() < 0.5 * bond || d.norm() > 1.2 * bond) continue;
        sum += std::sin(6 * std::atan2(d.dot(around), d.z()));
      }
  }
  return sum / static_cast<double>(3 * cell.atoms.size());
}

TEST(Lattice, ChiralTubesHaveAHandAndMirrorImagesTheOther) {
  for (const Chirality c : {Chirality{6, 4}, Chirality{8, 2}, Chirality{12, 6}}) {
    const Chirality mirror{c.m, c.n};
    const double hand = mean_hand(tube_cell(c, translation_vector(c)));
    EXPECT_GT(std::abs(hand), 0.1);
    EXPECT_NEAR(mean_hand(tube_cell(mirror, translation_vector(mirror))), -hand, 1e-9);
    // C runs at the chiral angle from a1, counterclockwise as the azimuth: so a1 and its bonds run clockwise from
    // C, and sin 6 (angle from the axis) has the sign of sin 6 theta.
    EXPECT_NEAR(hand, std::sin(6 * chiral_angle(c)), 0.1);
  }
  for (const Chirality c : {Chirality{10, 10}, Chirality{9, 0}})
    EXPECT_NEAR(mean_hand(tube_cell(c, translation_vector(c))), 0, 1e-9);
}

TEST(Lattice, TwistedPeriodsAreSortedDifferentAndWithinTheirBounds) {
  for (const Chirality c : tubes()) {
    const std::vector<LatticeVector> found = twisted_periods(c, 2, 12, 0.03);
    ASSERT_FALSE(found.empty());
    double last = -1;
    bool negative = false, positive = false;
    for (const LatticeVector v : found) {
      const TubeCell cell = tube_cell(c, v);
      EXPECT_GE(cell.length, 2 - 1e-9);
      EXPECT_LE(cell.length, 12 + 1e-9);
      EXPECT_LE(std::abs(cell.twist) * cell.radius, 0.03 + 1e-12);
      EXPECT_GT(cell.twist, last + 1e-12);
      last = cell.twist;
      negative = negative || cell.twist < 0;
      positive = positive || cell.twist > 0;
    }
    EXPECT_TRUE(negative && positive) << c.n << "," << c.m;
  }
  // The shortest one of each twist: twice the vector has the same twist and is not there.
  for (const LatticeVector v : twisted_periods({6, 4}, 1, 12, 0.03))
    EXPECT_LT(tube_cell({6, 4}, v).length, 12 + 1e-9);
}

TEST(Lattice, ShapePlacesTheRolledTube) {
  const Chirality c{8, 2};
  TubeShape shape = rolled_shape(c);
  EXPECT_NEAR(place(c, {0, 0, false}, shape).x(), tube_radius(c), 1e-12);
  EXPECT_NEAR((place(c, {0, 0, true}, shape) - place(c, {0, 0, false}, shape)).norm(), bond, 0.01 * bond);
  const Vector3 around = place(c, {c.n, c.m, false}, shape);
  EXPECT_NEAR((around - place(c, {0, 0, false}, shape)).norm(), 0, 1e-12);
  shape.twist = 0.5;
  shape.arc_shift = 0.1;
  shape.height_shift = 0.02;
  const LatticeVector t = translation_vector(c);
  const Vector3 up = place(c, {t.p, t.q, false}, shape);
  EXPECT_NEAR(std::atan2(up.y(), up.x()), std::remainder(0.5 * up.z(), 2 * units::pi), 1e-9);
  EXPECT_NEAR(place(c, {0, 0, true}, shape).z(), place(c, {0, 0, true}, rolled_shape(c)).z() + 0.02, 1e-12);
}

TEST(Lattice, HugeTubesAreCheapAndExact) {
  const auto start = std::chrono::steady_clock::now();
  for (const Chirality c : {Chirality{200, 200}, Chirality{200, 0}, Chirality{200, 199}, Chirality{199, 1}}) {
    const LatticeVector t = translation_vector(c);
    const TubeCell cell = tube_cell(c, t);
    EXPECT_EQ(static_cast<long>(cell.atoms.size()), 2 * cell_hexagons(c, t));
    EXPECT_EQ(cell.twist, 0);
    double top = 0;
    for (const Vector3& a : cell.atoms) top = std::max(top, a.z());
    EXPECT_LT(top, cell.length);
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5.0);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
