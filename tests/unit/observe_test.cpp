// Observables on states made by hand, whose geometry is known in closed form.
#include "observe/observe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "io/log.hpp"
#include "model/units.hpp"
#include "observe/centre_line.hpp"
#include "observe/delaunay.hpp"
#include "observe/loading.hpp"
#include "observe/means.hpp"
#include "observe/rope_shape.hpp"
#include "observe/spacing.hpp"
#include "observe/voids.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Eigen::Vector2d;
using testing::Each;

constexpr double spacing = 1.713;         // nm
constexpr double element_length = 1.356;  // nm
const double one_cell = 0.5 * std::sqrt(3.0) * spacing * spacing;

struct Rope {
  Topology topology;
  State state;
};

Topology equal_tubes(int tubes, int elements) {
  Topology t;
  t.types[0].element_length = element_length;
  t.types[0].radius = 0.678;
  for (int k = 0; k < tubes; ++k) t.add_tube(elements);
  return t;
}

// Corner k of the hexagon (or other polygon) of unit circumradius.
Vector2d corner(int k, int sectors) {
  const double a = 2.0 * units::pi * k / sectors;
  return {std::cos(a), std::sin(a)};
}

// Centre, then shell by shell: shell s has s tubes per sector on the straight lines between its corners.
// Six sectors: the hexagonal lattice. Five or seven: one disclination at the centre.
std::vector<Vector2d> shells_of(int shells, int sectors, double d) {
  std::vector<Vector2d> points{Vector2d::Zero()};
  for (int s = 1; s <= shells; ++s)
    for (int k = 0; k < sectors; ++k)
      for (int i = 0; i < s; ++i) points.push_back(d * ((s - i) * corner(k, sectors) + i * corner(k + 1, sectors)));
  return points;
}

std::vector<Vector2d> hexagonal(int shells) { return shells_of(shells, 6, spacing); }

std::vector<Vector2d> without(std::vector<Vector2d> points, std::vector<int> gone) {
  std::sort(gone.rbegin(), gone.rend());
  for (const int k : gone) points.erase(points.begin() + k);
  return points;
}

// at(point, s): position of the element s of the tube at this lattice point.
using Placing = std::function<Vector3(const Vector2d&, int)>;

Rope place(const std::vector<Vector2d>& lattice, int elements, const Placing& at) {
  Rope rope{equal_tubes(static_cast<int>(lattice.size()), elements), State()};
  rope.state = State(rope.topology.elements());
  for (std::size_t t = 0; t < lattice.size(); ++t)
    for (int s = 0; s < elements; ++s) rope.state.position.set(t * elements + s, at(lattice[t], s));
  return rope;
}

double height(int s, int elements) { return (s - 0.5 * (elements - 1)) * element_length; }

Rope straight_rope(const std::vector<Vector2d>& lattice, int elements = 12) {
  return place(lattice, elements,
               [=](const Vector2d& p, int s) { return Vector3(p.x(), p.y(), height(s, elements)); });
}

// Turned rigidly about z by `rate` (rad/nm).
Rope twisted_rope(const std::vector<Vector2d>& lattice, int elements, double rate) {
  return place(lattice, elements, [=](const Vector2d& p, int s) {
    const double z = height(s, elements);
    const Vector2d q = Eigen::Rotation2Dd(rate * z) * p;
    return Vector3(q.x(), q.y(), z);
  });
}

void add_noise(Rope& rope, double amplitude, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-amplitude, amplitude);
  for (std::size_t i = 0; i < rope.state.size(); ++i)
    rope.state.position.add(i, {noise(random), noise(random), noise(random)});
}

// The rope's cross-section carried along a curve without turning about it, then turned by `twist` in all.
Rope bent_rope(const std::vector<Vector2d>& lattice, const std::vector<Vector3>& curve, double twist) {
  const int n = static_cast<int>(curve.size());
  std::vector<Vector3> tangent, x;
  for (int s = 0; s < n; ++s) {
    tangent.push_back((curve[std::min(s + 1, n - 1)] - curve[std::max(s - 1, 0)]).normalized());
    x.push_back(s == 0 ? tangent[0].unitOrthogonal()
                       : Vector3(Quaternion::FromTwoVectors(tangent[s - 1], tangent[s]) * x[s - 1]));
  }
  return place(lattice, n, [&](const Vector2d& p, int s) {
    const Vector2d q = Eigen::Rotation2Dd(twist * s / (n - 1)) * p;
    return Vector3(curve[s] + q.x() * x[s] + q.y() * tangent[s].cross(x[s]));
  });
}

// windings negative: left-handed. The ends lie on the axis.
std::vector<Vector3> helix(int elements, double length, double amplitude, double windings) {
  std::vector<Vector3> curve;
  for (int s = 0; s < elements; ++s) {
    const double u = static_cast<double>(s) / (elements - 1), phase = 2.0 * units::pi * windings * u + 0.7;
    const double r = amplitude * std::sin(units::pi * u);
    curve.emplace_back(r * std::cos(phase), r * std::sin(phase), length * u);
  }
  return curve;
}

RopeShells shells_where(int tubes, int internal_tubes) {
  RopeShells shells;
  for (int t = 0; t < tubes; ++t) {
    shells.internal.push_back(t < internal_tubes);
    shells.outermost.push_back(t >= internal_tubes);
  }
  return shells;
}

CrossSection middle_of(const Rope& rope, const RopeShells& shells, double neighbour_radius = 0.0) {
  return cross_section(rope.topology, rope.state, shells, rope.topology.length_of(0) / 2, neighbour_radius,
                       spacing);
}

CrossSection middle_of(const Rope& rope) { return middle_of(rope, rope_shells(rope.topology, rope.state, 0.0)); }

RopeObservation observe_rope(const Rope& rope, const RopeShells& shells, const Validity& validity = {}) {
  return observe(rope.topology, rope.state, shells, {validity}, 0.0, spacing);
}

int sum(const std::vector<char>& flags) {
  int n = 0;
  for (const char f : flags) n += f;
  return n;
}

double area(const std::vector<Vector2d>& p, const Triangle& t) {
  const Vector2d u = p[t[1]] - p[t[0]], v = p[t[2]] - p[t[0]];
  return 0.5 * (u.x() * v.y() - u.y() * v.x());
}

std::vector<Vector2d> random_points(int n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(0.0, 10.0);
  std::vector<Vector2d> points(n);
  for (Vector2d& p : points) p = {in(random), in(random)};
  return points;
}

// --- Delaunay triangulation

TEST(Delaunay, CircumcirclesAreEmptyAndTheHullIsFilled) {
  std::vector<Vector2d> points = random_points(60);
  points.insert(points.end(), {{-1, -1}, {11, -1}, {11, 11}, {-1, 11}});  // the hull: a square of 144
  const auto triangles = delaunay(points);
  EXPECT_EQ(triangles.size(), 2 * points.size() - 2 - 4);  // Euler
  double total = 0.0;
  for (const Triangle& t : triangles) {
    total += area(points, t);
    const Vector2d a = points[t[0]], b = points[t[1]], c = points[t[2]];
    for (const Vector2d& p : points) {
      Eigen::Matrix3d m;
      int row = 0;
      for (const Vector2d& q : {a, b, c}) m.row(row++) << (q - p).x(), (q - p).y(), (q - p).squaredNorm();
      EXPECT_LT(m.determinant(), 1e-9);  // positive: p within the circle of a counter-clockwise triangle
    }
  }
  EXPECT_NEAR(total, 144.0, 1e-9);
}

TEST(Delaunay, PointsOnOneCircleAreTriangulated) {
  const std::vector<Vector2d> square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto triangles = delaunay(square);
  ASSERT_EQ(triangles.size(), 2u);
  EXPECT_NEAR(area(square, triangles[0]) + area(square, triangles[1]), 1.0, 1e-12);
  std::vector<Vector2d> ring;
  for (int k = 0; k < 24; ++k) ring.push_back(corner(k, 24));
  EXPECT_EQ(delaunay(ring).size(), 22u);
}

TEST(Delaunay, StraightHullHasNoTrianglesWithoutArea) {
  for (const double angle : {0.0, 0.3, 1.0}) {
    std::vector<Vector2d> points = hexagonal(5);
    for (Vector2d& p : points) p = Eigen::Rotation2Dd(angle) * p;  // rounding takes the sides off their lines
    const auto triangles = delaunay(points);
    EXPECT_EQ(triangles.size(), 150u);
    for (const Triangle& t : triangles) EXPECT_NEAR(area(points, t), 0.5 * one_cell, 1e-9);
  }
}

TEST(Delaunay, DegenerateInputGivesNoTrianglesAndNoOutput) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  EXPECT_TRUE(delaunay({}).empty());
  EXPECT_TRUE(delaunay({{0, 0}, {1, 0}, {0, 1}}).empty());
  EXPECT_TRUE(delaunay({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}).empty());
  EXPECT_TRUE(delaunay({{0, 0}, {1, 0}, {2, 0}, {3, 0}}).empty());
  EXPECT_TRUE(delaunay(std::vector<Vector2d>(6, Vector2d(1, 2))).empty());
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    std::vector<Vector2d> points = random_points(30);
    points[17].y() = bad;
    EXPECT_TRUE(delaunay(points).empty());
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(Delaunay, CountsEdgesOncePerPair) {
  EXPECT_THAT(edge_counts({{0, 1, 2}, {0, 2, 3}}, 5), testing::ElementsAre(3, 2, 3, 2, 0));
}

// --- Shells, neighbours, packing charge

TEST(ObservedShells, InternalTubesOfTheHexagonalRope) {
  for (const double radius : {0.0, 2.34}) {
    const Rope rope = straight_rope(hexagonal(5));
    const RopeShells shells = rope_shells(rope.topology, rope.state, radius);
    EXPECT_EQ(sum(shells.internal), 61);
    EXPECT_EQ(sum(shells.outermost), 30);
    EXPECT_TRUE(shells.internal[60]);
    EXPECT_TRUE(shells.outermost[61]);
  }
}

TEST(ObservedShells, ToleratePerturbation) {
  Rope rope = straight_rope(hexagonal(5));
  add_noise(rope, 0.1);
  EXPECT_EQ(sum(rope_shells(rope.topology, rope.state, 0.0).internal), 61);
}

TEST(ObservedShells, TubesWithFiveNeighboursAreNotInternal) {
  const Rope rope = straight_rope(without(hexagonal(5), {0}));
  const RopeShells shells = rope_shells(rope.topology, rope.state, 0.0);
  EXPECT_EQ(sum(shells.internal), 54);  // 61 less the missing one and the six around it
  EXPECT_TRUE(shells.outermost[0]);
}

TEST(ObservedSection, ContactsOfHexagonalRopes) {
  for (int shells = 1; shells <= 5; ++shells) {
    const Rope rope = straight_rope(hexagonal(shells));
    const double tubes = rope.topology.tubes();
    EXPECT_EQ(middle_of(rope).contacts, std::lround(3.0 * tubes - std::sqrt(12.0 * tubes - 3.0)));
  }
  EXPECT_EQ(middle_of(straight_rope(hexagonal(1))).contacts, 12);
  EXPECT_EQ(middle_of(straight_rope(hexagonal(5))).contacts, 240);
}

TEST(ObservedSection, UntwistedRopeIsFreeOfDefects) {
  for (const double noise : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.05})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      Rope rope = straight_rope(hexagonal(5));
      add_noise(rope, noise, seed);
      const CrossSection section = middle_of(rope);
      ASSERT_EQ(section.points.size(), 91u);
      EXPECT_THAT(std::vector<int>(section.delaunay.begin(), section.delaunay.begin() + 61), Each(6));
      EXPECT_THAT(std::vector<int>(section.neighbours.begin(), section.neighbours.begin() + 61), Each(6));
      EXPECT_EQ(section.charge, 0);
      EXPECT_EQ(section.charge_delaunay, 0);
      EXPECT_EQ(section.voids, 0) << noise;
      EXPECT_EQ(section.void_area, 0.0);
    }
}

// One sector of 60 degrees taken out (put in) and the others sheared to 72 (51.4): nearest neighbours are then
// between 0.92 and 1.08 (0.93 and 1.07) spacings apart.
TEST(ObservedSection, FiveFoldDisclinationHasChargeOne) {
  const Rope rope = straight_rope(shells_of(5, 5, 0.92 * spacing));
  const CrossSection section = middle_of(rope, shells_where(76, 51));
  EXPECT_EQ(section.delaunay[0], 5);
  EXPECT_EQ(section.charge_delaunay, 1);
  EXPECT_EQ(section.charge, 1);
  EXPECT_EQ(section.voids, 0);
}

TEST(ObservedSection, SevenFoldDisclinationHasChargeMinusOne) {
  const Rope rope = straight_rope(shells_of(5, 7, 1.07 * spacing));
  const CrossSection section = middle_of(rope, shells_where(106, 71));
  EXPECT_EQ(section.delaunay[0], 7);
  EXPECT_EQ(section.charge_delaunay, -1);
  EXPECT_EQ(section.charge, -1);
}

TEST(ObservedSection, OnlyInternalTubesCarryCharge) {
  const Rope rope = straight_rope(hexagonal(5));
  EXPECT_EQ(middle_of(rope, shells_where(91, 0)).charge, 0);
  // One corner tube (three neighbours, by distance and on the hull) taken for an internal one.
  RopeShells corner_too = shells_where(91, 61);
  corner_too.internal[61] = 1;
  EXPECT_EQ(middle_of(rope, corner_too).charge, 3);
  EXPECT_EQ(middle_of(rope, corner_too).charge_delaunay, 3);
}

TEST(ObservedSection, DistanceCountLosesATubeThatMovesAwayAndDelaunayDoesNot) {
  auto lattice = hexagonal(1);
  lattice[1] *= 1.5;
  const CrossSection section = middle_of(straight_rope(lattice), shells_where(7, 1));
  EXPECT_EQ(section.charge, 1);
  EXPECT_EQ(section.charge_delaunay, 0);
  EXPECT_EQ(middle_of(straight_rope(lattice), shells_where(7, 1), 1.6 * spacing).charge, 0);
}

TEST(ObservedSection, DistanceIncludesTheAdjacentElementsAndNoFurther) {
  // Two tubes that approach each other along z, upwards or downwards, by 0.2 spacings per element.
  const auto approach = [](double in_section, double per_element) {
    return place({{0, 0}, {1, 0}}, 9, [=](const Vector2d& p, int s) {
      return Vector3(p.x() * spacing * (in_section - per_element * (s - 4)), 0, height(s, 9));
    });
  };
  for (const double per_element : {0.2, -0.2}) {
    EXPECT_EQ(middle_of(approach(1.5, per_element)).contacts, 1);  // 1.3 at the next element; the limit is 1.366
    EXPECT_EQ(middle_of(approach(1.7, per_element)).contacts, 0);  // 1.5 there, and 1.3 only one further on
  }
}

TEST(ObservedSection, TubesThatSlidAlongThemselvesArePiercedInThePlane) {
  // Two opposite tubes of the surface, by 2.4 elements: the centre line moves up by 2/19 of that.
  const double rate = 0.15, slip = 2.4 * element_length;
  const Vector2d outer = 2.0 * spacing * corner(0, 6);
  const Rope rope = place(hexagonal(2), 31, [=](const Vector2d& p, int s) {
    const bool slid = (p - outer).norm() < 1e-9 || (p + outer).norm() < 1e-9;
    const double z = height(s, 31) + (slid ? slip : 0.0);
    const Vector2d q = Eigen::Rotation2Dd(rate * z) * p;
    return Vector3(q.x(), q.y(), z);
  });
  const CrossSection section = middle_of(rope, shells_where(19, 7));
  const auto lattice = hexagonal(2);
  const Eigen::Rotation2Dd turn(rate * slip * 2.0 / 19.0);  // projection would turn the two by 0.49 rad
  for (std::size_t t = 0; t < lattice.size(); ++t)
    EXPECT_LT((section.points[t] - turn * lattice[t]).norm(), 0.03) << t;  // bonds are chords of the helices
}

TEST(ObservedSection, PointsLieInThePlaneNormalToTheLocalAxis) {
  // The rope leans by 30 degrees in xz; its tubes keep their distances in the plane normal to it.
  const Eigen::AngleAxisd lean(units::pi / 6.0, Vector3::UnitY());
  const auto lattice = hexagonal(5);
  for (const int elements : {1, 2, 12}) {  // of one element the axis is all there is
    Rope rope = place(lattice, elements, [&](const Vector2d& p, int s) {
      return Vector3(lean * Vector3(p.x(), p.y(), height(s, elements)));
    });
    for (std::size_t i = 0; i < rope.state.size(); ++i) rope.state.orientation.set(i, Quaternion(lean));
    const CrossSection section = middle_of(rope);
    for (std::size_t t = 0; t < lattice.size(); ++t) EXPECT_LT((section.points[t] - lattice[t]).norm(), 1e-9);
    EXPECT_EQ(section.voids, 0);
  }
}

TEST(ObservedSection, EndsAndIndicesBeyondThemAreSafe) {
  const Rope rope = twisted_rope(hexagonal(2), 9, 0.1);
  const RopeShells shells = shells_where(19, 7);
  for (const int section : {-5, 0, 8, 40})
    EXPECT_EQ(cross_section(rope.topology, rope.state, shells, section, 0.0, spacing).charge_delaunay, 0);
}

// --- Voids

TEST(Voids, MissingCentreTubeIsOneVoidOfOneCell) {
  const CrossSection section = middle_of(straight_rope(without(hexagonal(5), {0})));
  EXPECT_EQ(section.voids, 1);
  EXPECT_NEAR(section.void_area, one_cell, 1e-9);
}

// Tubes nearer than in the untwisted rope: the void of one missing tube is one of their own cells, never less than
// none.
TEST(Voids, InAPressedRopeHaveTheAreaOfItsOwnCells) {
  for (const double pressed : {0.95, 0.8}) {
    auto lattice = without(hexagonal(5), {0});
    for (Vector2d& p : lattice) p *= pressed;
    const CrossSection section = middle_of(straight_rope(lattice));
    EXPECT_EQ(section.voids, 1);
    EXPECT_NEAR(section.void_area, pressed * pressed * one_cell, 1e-9);
  }
}

TEST(Voids, AnyMissingInternalTubeCountsWithNoiseToo) {
  for (int gone = 0; gone < 61; ++gone) {  // 37 .. 60 lie just below the surface
    Rope rope = straight_rope(without(hexagonal(5), {gone}));
    add_noise(rope, 1e-3, gone);
    const CrossSection section = middle_of(rope);
    EXPECT_EQ(section.voids, 1) << gone;
    EXPECT_NEAR(section.void_area, one_cell, 0.02);
  }
}

TEST(Voids, MissingSurfaceTubeIsABay) {
  for (int gone = 61; gone < 91; ++gone) {
    Rope rope = straight_rope(without(hexagonal(5), {gone}));
    add_noise(rope, 1e-3, gone);
    EXPECT_EQ(middle_of(rope).voids, 0) << gone;
  }
}

TEST(Voids, AdjacentVacanciesMergeAndDistantOnesDoNot) {
  const CrossSection merged = middle_of(straight_rope(without(hexagonal(5), {0, 1})));
  EXPECT_EQ(merged.voids, 1);
  EXPECT_NEAR(merged.void_area, 2.0 * one_cell, 1e-9);
  const CrossSection apart = middle_of(straight_rope(without(hexagonal(5), {0, 19})));  // 19: corner of shell 3
  EXPECT_EQ(apart.voids, 2);
  EXPECT_NEAR(apart.void_area, 2.0 * one_cell, 1e-9);
}

TEST(Voids, PocketOpenToTheOutsideIsNone) {
  // A slit from the surface to the centre: the tubes of one row.
  const CrossSection section = middle_of(straight_rope(without(hexagonal(5), {0, 1, 7, 19, 37, 61})));
  EXPECT_EQ(section.voids, 0);
  EXPECT_EQ(section.void_area, 0.0);
}

// A wall of close-packed tubes wound at 50 degrees about a hollow: three shells, staggered, one tube every
// spacing/cos beta along the azimuth. In the plane its triangles look 1.56 times too wide; it is packed all the
// same, and the only void is the hollow.
TEST(Voids, SteepTubesInContactAreNoVoid) {
  const double beta = 50.0 * units::degree;
  const int around = 80;
  const double inner = around * spacing / std::cos(beta) / (2.0 * units::pi);
  std::vector<Vector2d> points;
  std::vector<Vector3> lifted, tangents;
  for (int shell = 0; shell < 3; ++shell)
    for (int k = 0; k < around; ++k) {
      const double azimuth = 2.0 * units::pi * (k + 0.5 * (shell % 2)) / around;
      const Vector2d radial(std::cos(azimuth), std::sin(azimuth));
      points.push_back((inner + shell * 0.5 * std::sqrt(3.0) * spacing) * radial);
      lifted.emplace_back(points.back().x(), points.back().y(), 0.0);
      tangents.emplace_back(-std::sin(beta) * radial.y(), std::sin(beta) * radial.x(), std::cos(beta));
    }
  const auto triangles = delaunay(points);
  const Voids voids = find_voids(triangles, lifted, tangents, spacing);
  EXPECT_EQ(voids.count, 1);
  const std::vector<Vector3> upright(points.size(), Vector3::UnitZ());
  const double wall = 4.0 * around * 0.25 * std::sqrt(3.0) * spacing * spacing;  // its packed triangles
  EXPECT_GT(find_voids(triangles, lifted, upright, spacing).area, voids.area + 0.3 * wall);
}

// --- Twist

TEST(ObservedTwist, BetaOfARigidlyTwistedRope) {
  const int elements = 61;
  for (const double rate : {0.04, -0.04}) {
    const Rope rope = twisted_rope(hexagonal(5), elements, rate);
    const RopeShells shells = shells_where(91, 61);
    // Tangents are central differences: the chord of a helix of pitch 2 pi/rate over two elements.
    double expected = 0.0;
    const auto lattice = hexagonal(5);
    for (int t = 61; t < 91; ++t)
      expected += std::atan(lattice[t].norm() * std::sin(std::abs(rate) * element_length) / element_length) / 30.0;
    const RopeObservation seen = observe_rope(rope, shells);
    EXPECT_NEAR(seen.beta, expected, 1e-12);
    EXPECT_NEAR(seen.beta, std::atan(0.04 * 4.67 * spacing), 0.01);  // continuous: tan beta = rate rho
    EXPECT_NEAR(seen.geometric_twist, rate * (elements - 1) * element_length, 1e-9);
    EXPECT_EQ(seen.physical_twist, 0.0);
    EXPECT_EQ(seen.windings, 0.0);
    EXPECT_LT(seen.amplitude, 1e-9);
    EXPECT_NEAR(seen.length, (elements - 1) * element_length, 1e-9);
  }
}

TEST(ObservedTwist, BetaIsTakenInTheMiddleThird) {
  // Twisted in the middle third only.
  const int elements = 60;
  const auto angle = [](int s) { return 0.05 * std::clamp(s, 18, 41); };
  const Rope rope = place(hexagonal(1), elements, [&](const Vector2d& p, int s) {
    const Vector2d q = Eigen::Rotation2Dd(angle(s)) * p;
    return Vector3(q.x(), q.y(), height(s, elements));
  });
  const RopeObservation seen = observe_rope(rope, shells_where(7, 1));
  EXPECT_NEAR(seen.beta, std::atan(spacing * std::sin(0.05) / element_length), 1e-12);
  EXPECT_NEAR(seen.geometric_twist, 0.05 * 23, 1e-9);
}

TEST(ObservedTwist, GeometricTwistCountsWholeTurns) {
  const Rope rope = twisted_rope(hexagonal(2), 121, -0.2);
  EXPECT_NEAR(observe_rope(rope, shells_where(19, 7)).geometric_twist, -0.2 * 120 * element_length, 1e-9);
}

TEST(ObservedTwist, GeometricTwistLeavesOutTubesOnTheAxis) {
  // The tube in the middle wanders about the axis the other way round, at 0.1 spacings.
  Rope rope = twisted_rope(hexagonal(1), 31, 0.1);
  for (int s = 0; s < 31; ++s)
    rope.state.position.set(s, {0.1 * spacing * std::cos(s), -0.1 * spacing * std::sin(s), height(s, 31)});
  EXPECT_NEAR(observe_rope(rope, shells_where(7, 1)).geometric_twist, 0.1 * 30 * element_length, 0.01);
}

TEST(ObservedTwist, PhysicalTwistIsThatOfTheFrames) {
  for (const double per_bond : {0.05, -0.03}) {
    Rope rope = straight_rope(hexagonal(1), 41);
    for (int t = 0; t < 7; ++t)
      for (int s = 0; s < 41; ++s) {
        const Eigen::AngleAxisd spin(0.3 * t + per_bond * s * (t == 0 ? 2.0 : 1.0), Vector3::UnitZ());
        rope.state.orientation.set(t * 41 + s, Quaternion(spin));
      }
    const RopeObservation seen = observe_rope(rope, shells_where(7, 1));
    EXPECT_NEAR(seen.physical_twist, per_bond * 40 * 8.0 / 7.0, 1e-12);
    EXPECT_NEAR(seen.largest_bond_twist, 2.0 * std::abs(per_bond), 1e-12);
    EXPECT_NEAR(seen.geometric_twist, 0.0, 1e-12);
  }
}

TEST(ObservedTwist, PhysicalTwistOfABentTubeIsNotItsBend) {
  // A quarter circle in xz; each frame is the last one turned in the plane, then spun about the axis.
  Topology topology = equal_tubes(1, 31);
  State state(31);
  const double step = 0.5 * units::pi / 30.0, per_bond = 0.04;
  for (int s = 0; s < 31; ++s) {
    const Quaternion bend(Eigen::AngleAxisd(step * s, Vector3::UnitY()));
    const Quaternion spin(Eigen::AngleAxisd(per_bond * s, Vector3::UnitZ()));
    state.orientation.set(s, bend * spin);
    const double r = element_length / step;
    state.position.set(s, {r * (1.0 - std::cos(step * s)), 0.0, r * std::sin(step * s)});
  }
  const RopeObservation seen = observe(topology, state, {}, {Validity{}}, 0.0, 0.0);
  EXPECT_NEAR(seen.physical_twist, per_bond * 30, 1e-3);
}

// --- Shape

TEST(ObservedShape, RadiiOfASpindle) {
  const auto scale = [](int s) { return 1.0 - 0.2 * std::sin(units::pi * s / 30.0); };
  const Rope rope = place(hexagonal(5), 31, [&](const Vector2d& p, int s) {
    return Vector3(p.x() * scale(s), p.y() * scale(s), height(s, 31));
  });
  const RopeObservation seen = observe_rope(rope, shells_where(91, 61));
  EXPECT_NEAR(seen.radius_end, 5.0 * spacing + 0.678, 1e-9);
  EXPECT_NEAR(seen.radius_mid, 4.0 * spacing + 0.678, 1e-9);
  ASSERT_EQ(seen.radius_profile.size(), 31u);
  EXPECT_NEAR(seen.radius_profile[5], 5.0 * spacing * 0.9 + 0.678, 1e-9);
  ASSERT_EQ(seen.centre_line.size(), 31u);
  EXPECT_LT((seen.centre_line[30] - Vector3(0, 0, height(30, 31))).norm(), 1e-9);
}

TEST(ObservedShape, HelixOfTwoWindings) {
  for (const int shells : {1, 5})
    for (const double windings : {2.0, -2.0}) {
      Rope rope = bent_rope(hexagonal(shells), helix(119, 151.0, 6.0, windings), 0.0);
      add_noise(rope, 0.1);
      const RopeObservation seen = observe_rope(rope, rope_shells(rope.topology, rope.state, 0.0));
      EXPECT_NEAR(seen.windings, windings, 0.2);
      EXPECT_NEAR(seen.amplitude, 6.0, 0.1);
      EXPECT_NEAR(seen.length, 160.0, 1.0);
      EXPECT_EQ(seen.middle.charge_delaunay, 0);
      EXPECT_EQ(seen.middle.contacts, shells == 1 ? 12 : 240);
      EXPECT_EQ(seen.middle.voids, 0);
    }
}

TEST(ObservedShape, GeometricTwistOfAHelixIsFreeOfItsWrithe) {
  for (const double twist : {0.0, 2.5, -9.0}) {
    const Rope rope = bent_rope(hexagonal(2), helix(119, 151.0, 6.0, 2.0), twist);
    EXPECT_NEAR(observe_rope(rope, shells_where(19, 7)).geometric_twist, twist, 0.02);
  }
}

TEST(ObservedShape, GeometricTwistIsExactInSharpBends) {
  // A pair of tubes aslant to the plane of a bend of 0.25 rad per element: nothing averages out.
  std::vector<Vector3> arc;
  for (int s = 0; s < 7; ++s) arc.emplace_back(20.0 * std::cos(0.25 * s), 0.0, 20.0 * std::sin(0.25 * s));
  for (const double slant : {0.4, 0.8, 1.2}) {
    const Vector2d p = 2.0 * spacing * Vector2d(std::cos(slant), std::sin(slant));
    EXPECT_NEAR(observe_rope(bent_rope({p, -p}, arc, 0.0), shells_where(2, 0)).geometric_twist, 0.0, 1e-12);
    EXPECT_NEAR(observe_rope(bent_rope({p, -p}, arc, 0.6), shells_where(2, 0)).geometric_twist, 0.6, 1e-12);
  }
}

TEST(ObservedShape, WindingsOfHelicesWithFreeEnds) {
  // Constant radius: the chord runs along the side of the helix, aslant where the turns are not whole.
  for (const double turns : {1.5, 2.0, 2.25, 2.5, 3.0, 5.0}) {
    std::vector<Vector3> line;
    for (int s = 0; s < 200; ++s) {
      const double phase = 2.0 * units::pi * turns * s / 199.0;
      line.emplace_back(1.2 * s, 5.0 * std::cos(phase), 5.0 * std::sin(phase));
    }
    const LineHelix seen = helix_of(line);
    EXPECT_NEAR(seen.windings, turns, 0.15);
    EXPECT_NEAR(seen.radius, 5.0, turns < 2 ? 1.0 : 0.25);
    EXPECT_NEAR(seen.pitch, 1.2 * 199 / turns, 0.1 * 1.2 * 199 / turns);
  }
}

TEST(ObservedShape, StraightEndsAreNoPartOfTheHelix) {
  // Two turns in the middle third.
  std::vector<Vector3> line;
  for (int s = 0; s < 300; ++s) {
    const double u = std::clamp((s - 100) / 99.0, 0.0, 1.0), phase = 4.0 * units::pi * u;
    const double r = 5.0 * std::sin(units::pi * u);
    line.emplace_back(r * std::cos(phase), r * std::sin(phase), 1.2 * s);
  }
  const LineHelix seen = helix_of(line);
  EXPECT_NEAR(seen.windings, 2.0, 0.2);
  EXPECT_NEAR(seen.radius, 5.0 / std::sqrt(2.0), 0.1);
  EXPECT_NEAR(seen.pitch, 60.0, 6.0);
}

TEST(ObservedShape, PlaneBowHasAmplitudeAndNoWindings) {
  for (const int half_waves : {1, 2, 3}) {
    std::vector<Vector3> line;
    for (int s = 0; s < 101; ++s)
      line.emplace_back(4.0 * std::sin(units::pi * half_waves * s / 100.0), 0.0, 1.3 * s);
    const Rope rope = bent_rope(hexagonal(1), line, 0.0);
    const RopeObservation seen = observe_rope(rope, shells_where(7, 1));
    EXPECT_NEAR(seen.amplitude, 4.0, 0.01);
    EXPECT_NEAR(seen.windings, 0.0, 1e-9);
    EXPECT_TRUE(std::isnan(seen.pitch)) << "a bow makes no turn";
  }
}

TEST(ObservedShape, AmplitudeBelowOneSpacingHasNoWindings) {
  const Rope low = bent_rope(hexagonal(1), helix(119, 151.0, 0.95 * spacing, 2.0), 0.0);
  EXPECT_EQ(observe_rope(low, shells_where(7, 1)).windings, 0.0);
  EXPECT_TRUE(std::isnan(observe_rope(low, shells_where(7, 1)).pitch));
  const Rope high = bent_rope(hexagonal(1), helix(119, 151.0, 1.05 * spacing, 2.0), 0.0);
  EXPECT_NEAR(observe_rope(high, shells_where(7, 1)).windings, 2.0, 0.2);
}

// --- Validity

TEST(ObservedValidity, CountsBondsBeyondTheLimits) {
  Rope rope = straight_rope({{0, 0}}, 20);
  // Every element past 5 leans by 0.2 rad (one bond bent), past 10 is spun by 0.1 (one bond twisted), past 12
  // moved up by 5 % and past 15 down by 5 % again (one bond in tension, one in compression).
  for (int s = 0; s < 20; ++s) {
    const Quaternion lean(Eigen::AngleAxisd(s > 5 ? 0.2 : 0.0, Vector3::UnitX()));
    const Quaternion spin(Eigen::AngleAxisd(s > 10 ? -0.1 : 0.0, Vector3::UnitZ()));
    rope.state.orientation.set(s, lean * spin);
    if (s > 12 && s <= 15) rope.state.position.add(s, {0, 0, 0.05 * element_length});
  }
  const auto counts = [&](const Validity& validity) {
    const RopeObservation seen = observe_rope(rope, {}, validity);
    return std::vector<int>{seen.kinked, seen.overtwisted, seen.overstretched};
  };
  const double curvature = 0.2 / element_length, torsion = 0.678 * 0.1 / element_length;
  EXPECT_EQ(counts({0.99 * curvature, 0.99 * torsion, 0.049}), (std::vector<int>{1, 1, 2}));
  EXPECT_EQ(counts({1.01 * curvature, 1.01 * torsion, 0.051}), (std::vector<int>{0, 0, 0}));
  EXPECT_EQ(counts({0.0, 0.0, 0.0}), (std::vector<int>{0, 0, 0}));
  EXPECT_NEAR(observe_rope(rope, {}).largest_bond_twist, 0.1, 1e-12);
}

// --- Plied ropes

// `ropes` ropes of seven tubes round a curve, their middles `radius` from it, turned by `twist` in all as one body.
Rope plied(int ropes, const std::vector<Vector3>& curve, double radius, double twist) {
  std::vector<Vector2d> lattice;
  for (int k = 0; k < ropes; ++k)
    for (const Vector2d& p : hexagonal(1))
      lattice.push_back(Eigen::Rotation2Dd(2 * units::pi * k / ropes) * (p + Vector2d(radius, 0)));
  Rope rope = bent_rope(lattice, curve, twist);
  for (int k = 0; k <= ropes; ++k) rope.topology.groups.rope_begin.push_back(7 * k);
  return rope;
}

RopeObservation observe_plies(const Rope& rope) {
  return observe(rope.topology, rope.state, rope_shells(rope.topology, rope.state, 0.0), {Validity{}}, 0.0,
                 spacing);
}

TEST(ObservedPlies, AngleIsThatOfTheirHelices) {
  constexpr int n = 61;
  constexpr double radius = 2.6;
  std::vector<Vector3> line, circle;
  for (int s = 0; s < n; ++s) {
    const double z = s * element_length, bend = 60;
    line.emplace_back(0, 0, z);
    circle.emplace_back(bend * (1 - std::cos(z / bend)), 0, bend * std::sin(z / bend));
  }
  for (const double rate : {0.02, 0.1, -0.1}) {
    const double twist = rate * (n - 1) * element_length, theta = std::atan(radius * rate);
    EXPECT_NEAR(observe_plies(plied(2, line, radius, twist)).ply_angle, theta, 1e-9) << rate;
    EXPECT_NEAR(observe_plies(plied(3, line, radius * 1.2, twist)).ply_angle, std::atan(1.2 * radius * rate), 1e-9);
    EXPECT_NEAR(observe_plies(plied(2, circle, radius, twist)).ply_angle, theta, 2e-3 * std::fabs(theta)) << "bent";
  }
  EXPECT_TRUE(std::isnan(observe_plies(plied(1, line, 0, 1)).ply_angle)) << "one rope";
}

// The angle to the axis of the whole is none of a rope's own: these tubes lean by less to the middle of their rope.
TEST(ObservedPlies, TwistAndPackingAreThoseOfEachRope) {
  std::vector<Vector3> line;
  for (int s = 0; s < 61; ++s) line.emplace_back(0, 0, s * element_length);
  const double rate = 0.1, twist = rate * 60 * element_length;
  const Rope rope = plied(2, line, std::sqrt(7.0) / 2 * spacing, twist);
  const RopeObservation o = observe_plies(rope);
  Rope one = rope;
  one.topology.groups.rope_begin.clear();
  EXPECT_LT(o.beta, 0.7 * observe_plies(one).beta);
  EXPECT_NEAR(o.beta, std::atan(rate * spacing), 0.15 * o.beta) << "by inclination of the rope";
  EXPECT_NEAR(o.geometric_twist, twist, 1e-6 * twist) << "of all about the axis";
  EXPECT_EQ(o.middle.contacts, 24);
  EXPECT_EQ(o.middle.charge, 0);
  EXPECT_EQ(o.middle.charge_delaunay, 0);
  EXPECT_EQ(o.middle.voids, 0);
  const RopeShells shells = rope_shells(rope.topology, rope.state, 0.0);
  EXPECT_EQ(sum(shells.internal), 2) << "the core of each";
  EXPECT_EQ(o.middle.neighbours[0] + o.middle.neighbours[7], 12);
}

// --- Scenes that are no rope

TEST(ObservedNoRope, TubesOfUnequalLengthsGiveTheQuantitiesOfTubes) {
  Topology topology = equal_tubes(2, 8);
  topology.add_tube(5);
  State state(topology.elements());
  for (int i = 0; i < topology.elements(); ++i) {
    const int t = topology.tube_of(i), s = i - topology.tube_begin[t];
    state.position.set(i, {spacing * t, 0, element_length * s});
    state.orientation.set(i, Quaternion(Eigen::AngleAxisd(0.1 * s, Vector3::UnitZ())));
  }
  const RopeShells shells = rope_shells(topology, state, 0.0);
  EXPECT_EQ(sum(shells.internal), 0);
  EXPECT_EQ(sum(shells.outermost), 3);
  const RopeObservation seen = observe(topology, state, shells, {Validity{0, 0.01, 0}}, 0.0, spacing);
  EXPECT_NEAR(seen.physical_twist, 0.1 * (7 + 7 + 4) / 3.0, 1e-12);
  EXPECT_EQ(seen.overtwisted, 18);
  for (const double none : {seen.beta, seen.geometric_twist, seen.length, seen.radius_mid, seen.radius_end,
                            seen.amplitude, seen.windings, seen.middle.void_area})
    EXPECT_TRUE(std::isnan(none));
  EXPECT_TRUE(seen.centre_line.empty());
  EXPECT_TRUE(seen.radius_profile.empty());
  EXPECT_TRUE(seen.middle.points.empty());
  EXPECT_EQ(seen.middle.contacts, 0);
}

// One of two tubes begins at the other end: elements of equal number are nowhere near each other.
TEST(ObservedNoRope, TubesThatRunAgainstEachOtherHaveNoCentreLine) {
  for (const bool turned : {false, true}) {
    Rope rope = straight_rope({{0, 0}, {spacing, 0}}, 8);
    for (std::size_t i = 8; turned && i < 16; ++i) {
      rope.state.position.z[i] *= -1;
      rope.state.orientation.set(i, Quaternion(0, 1, 0, 0));
    }
    const RopeShells shells = rope_shells(rope.topology, rope.state, 0.0);
    const RopeObservation seen = observe(rope.topology, rope.state, shells, {Validity{}}, 0.0, spacing);
    const LoadingReference from = loading_reference(rope.topology, rope.state, shells, tube_ends(rope.topology),
                                                    spacing, 1.2 * spacing, nullptr);
    EXPECT_EQ(std::isnan(seen.beta), turned);
    EXPECT_EQ(std::isnan(seen.length), turned);
    EXPECT_EQ(std::isnan(loading(rope.topology, rope.state, from).slip), turned);
    const Loading now = loading(rope.topology, rope.state, from);
    const LogRow row({rope.topology, rope.state, seen, now, RopeSize{}, EnergyAccount{}});
    for (const char* none : {"Q", "Q_delaunay", "contacts", "voids", "void_area_nm2", "beta_deg", "slip_nm"})
      EXPECT_EQ(std::isnan(row[none]), turned) << none;
  }
}

TEST(ObservedNoRope, OneTubeIsItsOwnCentreLine) {
  const Rope rope = straight_rope({{0, 0}}, 20);
  const RopeShells shells = rope_shells(rope.topology, rope.state, 0.0);
  const RopeObservation seen = observe(rope.topology, rope.state, shells, {Validity{}}, 0.0, 0.0);
  EXPECT_EQ(seen.beta, 0.0);
  EXPECT_EQ(seen.geometric_twist, 0.0);
  EXPECT_EQ(seen.windings, 0.0);
  EXPECT_NEAR(seen.length, 19 * element_length, 1e-9);
  EXPECT_NEAR(seen.radius_mid, 0.678, 1e-12);
  EXPECT_EQ(seen.middle.points.size(), 1u);
  EXPECT_EQ(seen.middle.contacts + seen.middle.charge + seen.middle.charge_delaunay + seen.middle.voids, 0);
}

TEST(ObservedNoRope, TinyAndFlatScenesAreSafe) {
  for (const int tubes : {0, 1, 2, 3, 7})
    for (const int elements : {1, 2, 3}) {
      auto lattice = hexagonal(1);
      lattice.resize(tubes);
      const Rope rope = straight_rope(lattice, elements);
      const RopeObservation seen = observe_rope(rope, rope_shells(rope.topology, rope.state, 0.0));
      EXPECT_EQ(seen.middle.charge, 0);
      EXPECT_EQ(seen.middle.charge_delaunay, 0);
      EXPECT_EQ(seen.middle.contacts, tubes == 7 ? 12 : tubes == 3 ? 3 : tubes == 2 ? 1 : 0);
      EXPECT_TRUE(std::isfinite(seen.beta + seen.geometric_twist + seen.windings + seen.radius_mid));
    }
  std::vector<Vector2d> row;
  for (int t = 0; t < 6; ++t) row.emplace_back(spacing * t, 0);
  RopeShells claimed = shells_where(6, 3);  // tubes that have left a rope and lie in a plane
  const CrossSection section = middle_of(straight_rope(row), claimed);
  EXPECT_EQ(section.contacts, 5);
  EXPECT_EQ(section.charge_delaunay, 0);
  EXPECT_EQ(section.voids, 0);
}

TEST(TubeSpacing, IsThatOfInnerTubesAndTheirNeighbours) {
  const Rope rope = straight_rope(hexagonal(2));
  const RopeShells shells = rope_shells(rope.topology, rope.state, 0);
  EXPECT_NEAR(tube_spacing(rope.topology, rope.state, shells), spacing, 1e-12);
  // Slid along itself a tube is as far away as before.
  Rope slid = rope;
  for (int e = slid.topology.tube_begin[3]; e < slid.topology.tube_begin[4]; ++e)
    slid.state.position.add(static_cast<std::size_t>(e), {0, 0, 0.4 * element_length});
  EXPECT_NEAR(tube_spacing(slid.topology, slid.state, shells), spacing, 1e-12);
  // Two tubes need no shells; one has no neighbour.
  const Rope pair = straight_rope({{0, 0}, {2.1, 0}}), lone = straight_rope({{0, 0}});
  EXPECT_NEAR(tube_spacing(pair.topology, pair.state, {}), 2.1, 1e-12);
  EXPECT_EQ(tube_spacing(lone.topology, lone.state, {}), 0);
}

// --- Writhe and shapes

TEST(Writhe, IsThatOfHelicesAndLoops) {
  EXPECT_NEAR(writhe_of(helix(80, 100, 0, 3)), 0, 1e-9);
  // Two turns more of a helix have 1 - sin(angle of pitch) each, right-handed positive.
  constexpr double radius = 3, pitch = 12;
  const auto turns = [](int count, double hand) {
    std::vector<Vector3> line;
    for (int k = 0; k <= 120; ++k) {
      const double phase = 2 * units::pi * count * k / 120;
      line.emplace_back(radius * std::cos(phase), hand * radius * std::sin(phase), pitch * count * k / 120);
    }
    return line;
  };
  const double each = 1 - pitch / std::hypot(pitch, 2 * units::pi * radius);
  for (const double hand : {1.0, -1.0}) {
    EXPECT_NEAR(0.5 * (writhe_of(turns(6, hand)) - writhe_of(turns(4, hand))), hand * each, 0.05 * each);
    EXPECT_EQ(turned_back(turns(6, hand)), 0);
  }
  EXPECT_NEAR(writhe_of(helix(90, 120, 5, 3)), -writhe_of(helix(90, 120, 5, -3)), 1e-9);
  EXPECT_EQ(writhe_of({}), 0);
  EXPECT_EQ(writhe_of({{0, 0, 0}, {0, 0, 1}}), 0);
}

// A line that turns once round in a plane, and whose two strands pass each other at the distance `apart`.
std::vector<Vector3> loop(int elements, double apart) {
  std::vector<Vector3> line{Vector3::Zero()};
  for (int s = 1; s < elements; ++s) {
    const double u = static_cast<double>(s) / elements, in_loop = std::clamp((u - 0.3) / 0.4, 0.0, 1.0);
    const double angle = 2 * units::pi * in_loop;
    const double aside = in_loop > 0 && in_loop < 1 ? apart / (0.4 * elements) : 0;
    line.push_back(line.back() +
                   Vector3(element_length * std::sin(angle), aside, element_length * std::cos(angle)));
  }
  return line;
}

struct Deformed {
  std::string name;
  Rope rope;
};

// Rope of 37 tubes and 90 elements in each shape.
std::vector<Deformed> shapes() {
  constexpr int n = 90;
  const std::vector<Vector2d> lattice = hexagonal(3);
  const auto tubes = static_cast<int>(lattice.size());
  const auto scaled = [&](const std::function<double(double)>& by) {
    return place(lattice, n, [=](const Vector2d& p, int s) {
      const Vector2d q = Eigen::Rotation2Dd(0.02 * s) * p * by(s / (n - 1.0));
      return Vector3(q.x(), q.y(), height(s, n));
    });
  };
  // In its middle all tubes stand on a ring, in the order of their azimuth at the ends.
  std::vector<int> order(lattice.size());
  for (int t = 0; t < tubes; ++t) order[static_cast<std::size_t>(t)] = t;
  const auto azimuth = [&](int t) {
    return std::atan2(lattice[static_cast<std::size_t>(t)].y(), lattice[static_cast<std::size_t>(t)].x());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return azimuth(a) < azimuth(b); });
  std::vector<int> rank(lattice.size());
  for (int k = 0; k < tubes; ++k) rank[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])] = k;
  int next = 0;
  Rope cage{equal_tubes(tubes, n), State()};
  cage.state = State(static_cast<std::size_t>(cage.topology.elements()));
  for (int t = 0; t < tubes; ++t)
    for (int s = 0; s < n; ++s, ++next) {
      const double part = std::sin(units::pi * s / (n - 1.0)), ring = 1.05 * spacing * tubes / (2 * units::pi);
      const double angle = 2 * units::pi * rank[static_cast<std::size_t>(t)] / tubes;
      const Vector2d q = (1 - part) * lattice[static_cast<std::size_t>(t)] +
                         part * ring * Vector2d(std::cos(angle), std::sin(angle));
      cage.state.position.set(static_cast<std::size_t>(next), {q.x(), q.y(), height(s, n)});
    }
  return {
      {"straight", twisted_rope(lattice, n, 0.03)},
      {"straight", bent_rope(lattice, helix(n, 120, 1.5, 2), 2)},  // as voids move a line
      {"spindle", scaled([](double u) { return 1 + 0.25 * std::sin(units::pi * u); })},
      {"cage", cage},
      {"helix", bent_rope(lattice, helix(n, 120, 6, 2), 4)},
      {"helix", bent_rope(lattice, helix(n, 120, 12, -2), 0)},
      {"brush",
       scaled([](double u) { return 1 + 4 * std::pow(std::max(0.0, std::fabs(2 * u - 1) - 0.8) / 0.2, 2); })},
      {"snarl", bent_rope(lattice, loop(n, 13), 3)},
      {"snarl", bent_rope(lattice, loop(n, -13), 3)},
  };
}

TEST(RopeShapes, AreNamedAsTheyWereMade) {
  const Rope start = straight_rope(hexagonal(3), 90);
  const RopeShells shells = rope_shells(start.topology, start.state, 0.0);
  const double radius = observe_rope(start, shells).radius_mid;
  for (const Deformed& d : shapes()) {
    const RopeObservation seen = observe_rope(d.rope, shells);
    const RopeShape shape = rope_shape({seen.middle_amplitude, seen.writhe, seen.turned_back, seen.radius_mid,
                                        seen.radius_end, seen.middle.void_area},
                                       radius);
    EXPECT_EQ(name_of(shape), d.name) << "amplitude " << seen.middle_amplitude << ", writhe " << seen.writhe
                                      << ", back " << seen.turned_back << ", radius " << seen.radius_mid << " and "
                                      << seen.radius_end << ", voids " << seen.middle.void_area;
  }
  // A brush whose bent ends move the whole line, which `amplitude` takes for a helix.
  Rope brush = shapes()[6].rope;
  for (std::size_t i = 0; i < brush.state.size(); ++i) {
    const int s = static_cast<int>(i) % 90;
    if (s < 9) brush.state.position.add(i, {0.9 * (9 - s), 0, 0});
  }
  const RopeObservation seen = observe_rope(brush, shells);
  EXPECT_GT(seen.amplitude, 4);
  EXPECT_LT(seen.middle_amplitude, 0.01);
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rope_shape({none, none, none, none, none, none}, none), RopeShape::straight);
}

// Rows of runs of the published set: 19 tubes under 39 nN nm at 2 nN nm/ps, 190 nm; 91 tubes, 41 nm, at 64 and 35
// nN nm.
TEST(RopeShapes, OfRunsAreWhatTheirPicturesShow) {
  EXPECT_EQ(rope_shape({1.2, 0.3, 0, 4.15, 14.54, 0}, 4.10), RopeShape::brush);
  EXPECT_EQ(rope_shape({0.2, 0, 0, 17.37, 13.85, 58.9}, 9.24), RopeShape::cage);
  EXPECT_EQ(rope_shape({0.02, 0, 0, 11.67, 11.08, 1.35}, 9.24), RopeShape::spindle);
  EXPECT_EQ(rope_shape({7, 0.4, 0, 4.55, 4.38, 0}, 4.10), RopeShape::helix);
}

TEST(Means, AreThoseOfAllLooks) {
  Means means;
  for (const double x : {1.0, 2.0, 6.0}) means.add({{"x", x}, {"square", x * x}});
  EXPECT_DOUBLE_EQ(means.values().at("x"), 3);
  EXPECT_DOUBLE_EQ(means.values().at("square"), 41.0 / 3);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
