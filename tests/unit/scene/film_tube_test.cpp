// A tube that comes to rest on others.
#include "scene/film_tube.hpp"

#include <gtest/gtest.h>

#include "model/units.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

constexpr double right_angle = 0.5 * units::pi;

FilmTube let_down_at(double x, double angle, const std::vector<FilmTube>& others, double length, double spacing) {
  FilmTube tube;
  tube.x = x;
  tube.angle = angle;
  let_down(tube, others, length, spacing);
  return tube;
}

TEST(FilmTube, ProjectedDistance) {
  const FilmTube flat{0, 0, 0, 0, 0};
  EXPECT_EQ(projected_distance2(flat, {0.5, 0.5, 3, right_angle, 0}, 4), 0);
  EXPECT_NEAR(projected_distance2(flat, {1, 2, 3, 0, 0}, 4), 4, 1e-12);
  EXPECT_NEAR(projected_distance2(flat, {5, 2, 3, 0, 0}, 4), 1 + 4, 1e-12);
  EXPECT_NEAR(projected_distance2(flat, {0.5, 3, 0, right_angle, 0}, 4), 1, 1e-12);
}

TEST(FilmTube, AloneLiesOnThePlane) {
  const FilmTube tube = let_down_at(0, 1, {{30, 0, 0, 0, 0}}, 20, 2);
  EXPECT_EQ(tube.z, 0);
  EXPECT_EQ(tube.tilt, 0);
}

// One end stays on the plane, and the axis passes the one below at the spacing.
TEST(FilmTube, LeansOnOne) {
  const double length = 20, spacing = 2, s = 3;
  for (const double side : {-1.0, 1.0}) {
    const FilmTube tube = let_down_at(0, 0, {{side * s, 0, 0, right_angle, 0}}, length, spacing);
    const double tilt = side * tube.tilt;
    EXPECT_GT(tilt, 0);
    EXPECT_NEAR((s + 0.5 * length * std::cos(tilt)) * std::sin(tilt), spacing, 1e-9);
    EXPECT_NEAR(tube.z, 0.5 * length * std::sin(tilt), 1e-9);
  }
}

TEST(FilmTube, BridgesTwoOfUnequalHeight) {
  const FilmTube tube = let_down_at(
      0, 0, {{-4, 0, 1, right_angle, 0}, {6, 0, 3, right_angle, 0}, {1, 0, 0.5, right_angle, 0}}, 20, 1);
  EXPECT_NEAR(std::tan(tube.tilt), 0.2, 1e-9);
  EXPECT_NEAR(tube.z, 1 + 4 * 0.2 + 1 / std::cos(tube.tilt), 1e-9);
}

// The lower tube is tilted across the upper one: the distance of the axes is not the difference of their heights.
TEST(FilmTube, LiesOnATiltedOne) {
  const double tilt = 0.5, spacing = 1;
  const FilmTube tube = let_down_at(0, 0, {{0, 0, 4, right_angle, tilt}}, 10, spacing);
  EXPECT_NEAR(tube.tilt, 0, 1e-9);
  EXPECT_NEAR(tube.z, 4 + spacing / std::cos(tilt), 1e-9);
}

// Two tubes lie side by side, nearer than the spacing, and do not cross. Then an end of one tube points at the
// other.
TEST(FilmTube, LiesInTheGrooveAndOnAnEnd) {
  const FilmTube groove = let_down_at(0, 0, {{0, 1.5, 0, 0, 0}, {0, -1.5, 0, 0, 0}}, 20, 2.5);
  EXPECT_NEAR(groove.z, 2, 1e-9);
  EXPECT_NEAR(groove.tilt, 0, 1e-9);
  const FilmTube capped = let_down_at(0, 0, {{10.6, 0, 0, right_angle, 0}}, 20, 1);
  const Vector3 end = capped.middle() + 10 * capped.axis();
  EXPECT_NEAR((end - Vector3(10.6, 0, 0)).norm(), 1, 1e-9);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
