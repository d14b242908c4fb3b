// Tubes in heaps of atoms: (n,m) and hand from shuffled, turned and noisy places, with defects, in periodic boxes.
#include "atoms/find_tubes.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "atoms/support.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using namespace test;

std::string name(Chirality c) { return "(" + std::to_string(c.n) + "," + std::to_string(c.m) + ")"; }

// The places that the sites of a tube have on the ideal lattice, moved onto its atoms as one body: how far off they
// are.
double misfit(const FoundTubes& found, const FoundTube& tube) {
  const TubeShape shape = rolled_shape(tube.chirality);
  Eigen::Matrix3Xd ideal(3, tube.atoms.size()), real(3, tube.atoms.size());
  for (std::size_t k = 0; k < tube.atoms.size(); ++k) {
    ideal.col(static_cast<Eigen::Index>(k)) = place(tube.chirality, tube.atoms[k].site, shape);
    real.col(static_cast<Eigen::Index>(k)) = found.positions[tube.atoms[k].atom];
  }
  const Eigen::Matrix4d move = Eigen::umeyama(ideal, real, false);
  Eigen::Matrix3Xd moved = move.topLeftCorner<3, 3>() * ideal;
  moved.colwise() += Vector3(move.topRightCorner<3, 1>());
  return std::sqrt((moved - real).squaredNorm() / static_cast<double>(tube.atoms.size()));
}

TEST(FindTubes, KnowsEveryChiralityAndItsHand) {
  int tubes = 0;
  for (int n = 1; n <= 20; ++n)
    for (int m = 0; m <= 20; ++m) {
      const Chirality c{n, m};
      if (tube_radius(c) <= 0.2) continue;
      ++tubes;
      const FoundTubes found = found_in(scrambled(lattice_atoms(c, 3), 0.01, static_cast<unsigned>(100 * n + m)));
      ASSERT_EQ(found.tubes.size(), 1u) << name(c);
      EXPECT_EQ(name(found.tubes[0].chirality), name(c));
      // A proper motion brings the lattice of (n,m) onto it: the hand is right, and every site.
      EXPECT_LT(misfit(found, found.tubes[0]), 0.02) << name(c);
      EXPECT_LE(found.tubes[0].without_site, 6 * (n + m)) << name(c);
    }
  EXPECT_GT(tubes, 390);
}

TEST(FindTubes, FindsThemWithOneAtomOfAHundredMissing) {
  int with_holes = 0;
  for (int n = 1; n <= 20; ++n)
    for (int m = 0; m <= 20; ++m) {
      const Chirality c{n, m};
      if (tube_radius(c) <= 0.2) continue;
      std::vector<Vector3> atoms = scrambled(lattice_atoms(c, 3), 0.01, static_cast<unsigned>(100 * n + m));
      const std::size_t all = atoms.size();
      atoms.resize(all - all / 100);  // in random order
      const FoundTubes found = found_in(atoms);
      ASSERT_EQ(found.tubes.size(), 1u) << name(c);
      const FoundTube& tube = found.tubes[0];
      EXPECT_EQ(name(tube.chirality), name(c));
      EXPECT_LT(misfit(found, tube), 0.02) << name(c);
      EXPECT_GT(tube.atoms.size(), 0.8 * static_cast<double>(atoms.size())) << name(c);
      if (tube.open_atoms > 0) ++with_holes;  // not where only atoms at an end are missing
    }
  EXPECT_GT(with_holes, 390);
}

// A bond that is turned by 90 degrees: two rings of five and two of seven.
TEST(FindTubes, NamesATurnedBond) {
  const Chirality c{10, 10};
  std::vector<Vector3> atoms = lattice_atoms(c, 5);
  const auto middle = std::min_element(atoms.begin(), atoms.end(), [](const Vector3& a, const Vector3& b) {
    return std::hypot(a.z() - 2.5, a.y()) - a.x() < std::hypot(b.z() - 2.5, b.y()) - b.x();
  });
  const auto other = std::min_element(atoms.begin(), atoms.end(), [&](const Vector3& a, const Vector3& b) {
    return (a == *middle ? 9 : (a - *middle).norm()) < (b == *middle ? 9 : (b - *middle).norm());
  });
  const Vector3 half = 0.5 * (*other - *middle), centre = *middle + half;
  const Vector3 up = Vector3(centre.x(), centre.y(), 0).normalized().cross(half);
  *middle = centre - up;
  *other = centre + up;
  const FoundTubes found = found_in(scrambled(atoms, 0.002, 2));
  ASSERT_EQ(found.tubes.size(), 1u);
  const FoundTube& tube = found.tubes[0];
  EXPECT_EQ(name(tube.chirality), "(10,10)");
  EXPECT_EQ(tube.pentagons, 2);
  EXPECT_EQ(tube.heptagons, 2);
  EXPECT_LT(misfit(found, tube), 0.02);
}

TEST(FindTubes, TellsTubesApartThatTouch) {
  const Chirality a{10, 10}, b{8, 2};
  std::vector<Vector3> atoms = lattice_atoms(a, 4);
  for (const Vector3& x : lattice_atoms(b, 4))
    atoms.push_back(x + Vector3(tube_radius(a) + tube_radius(b) + 0.3, 0, 0));
  // And one inside the other.
  for (const Vector3& x : lattice_atoms({5, 5}, 4)) atoms.push_back(x);
  const FoundTubes found = found_in(scrambled(atoms, 0.005, 4));
  std::vector<std::string> names;
  for (const FoundTube& tube : found.tubes) names.push_back(name(tube.chirality));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"(10,10)", "(5,5)", "(8,2)"}));
}

// An endless tube in a tilted box, wrapped into it, and at its edge.
TEST(FindTubes, CutsAnEndlessTubeOpen) {
  for (const Chirality c : {Chirality{10, 10}, {9, 0}, {8, 2}}) {
    const TubeCell cell = tube_cell(c, translation_vector(c));
    const int repeats = static_cast<int>(std::ceil(5 / cell.length));
    AtomBox box;
    box.edges << 3, 0.7, 0, 0, 3, 0, 0, 0, repeats * cell.length;
    box.periodic = {true, true, true};
    std::vector<Vector3> atoms;
    for (int k = 0; k < repeats; ++k)
      for (const Vector3& x : cell.atoms) {
        Vector3 part = box.inverse() * (x + Vector3(0.1, -0.2, 0.04 + k * cell.length));
        for (int d = 0; d < 3; ++d) part[d] -= std::floor(part[d]);
        atoms.push_back(box.edges * part);
      }
    std::mt19937 random(1);
    std::shuffle(atoms.begin(), atoms.end(), random);
    const FoundTubes found = found_in(atoms, box);
    ASSERT_EQ(found.tubes.size(), 1u) << name(c);
    EXPECT_TRUE(found.tubes[0].endless);
    EXPECT_EQ(name(found.tubes[0].chirality), name(c));
    EXPECT_EQ(found.tubes[0].atoms.size(), atoms.size());
    EXPECT_LT(misfit(found, found.tubes[0]), 1e-6) << "the images hang together";
  }
}

// Buckminsterfullerene with an axis through two pentagons along z, in edges of 0.142 nm.
std::vector<Vector3> fullerene() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  const Vector3 corners[] = {{0, 1, 3 * g}, {1, 2 + g, 2 * g}, {g, 2, g * g * g}};
  const Quaternion upright = Quaternion::FromTwoVectors(Vector3(0, 1, g), Vector3::UnitZ());
  std::vector<Vector3> out;
  for (const Vector3& corner : corners)
    for (int signs = 0; signs < 8; ++signs)
      for (int shift = 0; shift < 3; ++shift) {
        Vector3 x;
        for (int k = 0; k < 3; ++k) x[(k + shift) % 3] = corner[k] * ((signs >> k) % 2 ? -1 : 1);
        x = 0.071 * (upright * x);
        if (std::none_of(out.begin(), out.end(), [&](const Vector3& y) { return (x - y).norm() < 0.01; }))
          out.push_back(x);
      }
  return out;
}

// A (5,5) tube that is closed at both ends: its halves are caps of six pentagons each.
TEST(FindTubes, NamesCaps) {
  const std::vector<Vector3> ball = fullerene();
  ASSERT_EQ(ball.size(), 60u);
  const int rings = 24;
  const double rise = 0.123;
  std::vector<Vector3> atoms;
  for (const Vector3& x : ball) {
    atoms.push_back(x.z() < 0 ? x : Vector3(x + Vector3(0, 0, rings * rise)));
    // The rings next to the equator alternate along the tube.
    if (std::fabs(x.z()) > 0.1) continue;
    for (int k = 1; k <= rings; ++k)
      if ((k % 2 == 0) == (x.z() < 0)) atoms.push_back({x.x(), x.y(), -0.06 + k * rise});
  }
  const FoundTubes found = found_in(scrambled(atoms, 0.002, 9));
  ASSERT_EQ(found.tubes.size(), 1u);
  const FoundTube& tube = found.tubes[0];
  EXPECT_EQ(name(tube.chirality), "(5,5)");
  EXPECT_EQ(tube.pentagons, 12);
  EXPECT_EQ(tube.heptagons, 0);
  EXPECT_TRUE(tube.cap_below && tube.cap_above);
  EXPECT_GE(tube.atoms.size(), 10u * rings);
  EXPECT_EQ(tube.atoms.size() + static_cast<std::size_t>(tube.without_site), atoms.size());
}

// Tubes of one rope on both sides of a periodic box come together.
TEST(FindTubes, GathersTheTubesOfARopeAcrossTheBox) {
  AtomBox box;
  box.edges = 6 * Eigen::Matrix3d::Identity();
  box.edges(2, 2) = 12;
  box.periodic = {true, true, false};
  std::vector<Vector3> atoms;
  for (const double x : {-0.85, 0.85})
    for (Vector3 at : lattice_atoms({10, 10}, 4)) {
      at += Vector3(x, 3, 2);
      at.x() -= 6 * std::floor(at.x() / 6);
      atoms.push_back(at);
    }
  const FoundTubes found = found_in(atoms, box);
  ASSERT_EQ(found.tubes.size(), 2u);
  EXPECT_NEAR((found.tubes[0].centre - found.tubes[1].centre).norm(), 1.7, 1e-6);
}

std::string refusal(const std::vector<Vector3>& atoms, const AtomBox& box = {}) {
  try {
    found_in(atoms, box);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(FindTubes, RefusesWhatIsNoTube) {
  std::vector<Vector3> sheet;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      for (const double second : {0.0, 1.0 / 3})
        sheet.push_back(0.246 * Vector3(i + second + 0.5 * (j + second), std::sqrt(0.75) * (j + second), 0));
  EXPECT_NE(refusal(sheet).find("no carbon nanotube"), std::string::npos);

  std::vector<Vector3> twice = lattice_atoms({10, 10}, 3);
  twice.push_back(twice[40] + Vector3(0.01, 0, 0));
  EXPECT_NE(refusal(twice).find("overlap"), std::string::npos);

  AtomBox narrow;
  narrow.edges = 0.3 * Eigen::Matrix3d::Identity();
  narrow.periodic = {true, false, false};
  EXPECT_NE(refusal(lattice_atoms({10, 10}, 3), narrow).find("less than two bonds"), std::string::npos);

  // Bent to a ring of 40 cells.
  const Chirality c{5, 5};
  const TubeCell cell = tube_cell(c, translation_vector(c));
  const double around = 60 * cell.length, radius = around / (2 * units::pi);
  std::vector<Vector3> ring;
  for (int k = 0; k < 60; ++k)
    for (const Vector3& x : cell.atoms) {
      const double angle = (x.z() + k * cell.length) / radius;
      ring.push_back({(radius + x.x()) * std::cos(angle), (radius + x.x()) * std::sin(angle), x.y()});
    }
  EXPECT_NE(refusal(ring).find("bites its tail"), std::string::npos);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
