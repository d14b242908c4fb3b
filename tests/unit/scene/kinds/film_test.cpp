// Films: how many tubes, where, and that none touches another.
#include "scene/kinds/film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "model/error.hpp"
#include "scene/build.hpp"
#include "scene/scene_toml.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

using ::testing::HasSubstr;

Scene film_scene(const std::string& film, const std::string& more = "",
                 const std::string& parameters = "\"cnt-10-10-tersoff\"") {
  return scene_of_text("format = \"ropewalk-scene-1\"\nparameters = " + parameters + "\n" + more + "[film]\n" +
                           film + "[run]\nduration_ps = 1\n",
                       "film.toml");
}

BuiltScene film(const std::string& keys, const std::string& more = "",
                const std::string& parameters = "\"cnt-10-10-tersoff\"") {
  Scene scene = film_scene(keys, more, parameters);
  return build(scene);
}

// The distance of two segments, tried along one of them: the distance to a segment is convex along another one.
double segment_distance(const Vector3& x, const Vector3& u, const Vector3& y, const Vector3& v, double half) {
  const auto from_point = [&](double s) {
    const Vector3 p = x + s * u;
    const double t = std::min(std::max((p - y).dot(v), -half), half);
    return (p - y - t * v).norm();
  };
  double a = -half, b = half;
  for (int k = 0; k < 200; ++k) {
    const double one = a + (b - a) / 3, two = b - (b - a) / 3;
    (from_point(one) < from_point(two) ? b : a) = from_point(one) < from_point(two) ? two : one;
  }
  return from_point(0.5 * (a + b));
}

struct Rod {
  Vector3 middle, axis;
};

std::vector<Rod> rods(const BuiltScene& b) {
  std::vector<Rod> out;
  for (int t = 0; t < b.topology.tubes(); ++t) {
    const auto first = static_cast<std::size_t>(b.topology.tube_begin[t]);
    const auto last = static_cast<std::size_t>(b.topology.tube_begin[t + 1] - 1);
    out.push_back({0.5 * (b.state.position[first] + b.state.position[last]), axis_of(b.state.orientation[first])});
  }
  return out;
}

double closest(const std::vector<Rod>& rods, double half) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < rods.size(); ++a)
    for (std::size_t b = a + 1; b < rods.size(); ++b) {
      const double reach = 2 * half + 5;
      if ((rods[a].middle - rods[b].middle).squaredNorm() > reach * reach) continue;
      least = std::min(least, segment_distance(rods[a].middle, rods[a].axis, rods[b].middle, rods[b].axis, half));
    }
  return least;
}

constexpr double element = 1.3775870846515064;  // nm, of the set
const std::string dense = "tubes = 150\nlength_nm = 27.6\nwidth_nm = 60\ndepth_nm = 40\n";

TEST(Film, HasWhatIsAskedForInsideTheBox) {
  const BuiltScene b = film(dense);
  ASSERT_EQ(b.topology.tubes(), 150);
  EXPECT_EQ(b.topology.elements(), 150 * 20);
  for (int i = 0; i < b.topology.elements(); ++i) {
    const Vector3 x = b.state.position[static_cast<std::size_t>(i)];
    EXPECT_LE(std::fabs(x.x()), 30);
    EXPECT_LE(std::fabs(x.y()), 20);
    EXPECT_GE(x.z(), 0);
  }
  double along_x = 0;
  for (const Rod& r : rods(b)) {
    EXPECT_NEAR(r.axis.z(), 0, 1e-14);
    EXPECT_NEAR(r.axis.norm(), 1, 1e-14);
    along_x += r.axis.x() * r.axis.x();
  }
  EXPECT_NEAR(along_x / 150, 0.5, 0.1);  // every direction alike: the mean of 150 cos^2 has a spread of 0.03
}

TEST(Film, ElementsFollowTheirAxis) {
  const BuiltScene b = film(dense);
  for (int t = 0; t < b.topology.tubes(); ++t)
    for (int i = b.topology.tube_begin[t]; i + 1 < b.topology.tube_begin[t + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vector3 step = b.state.position[at + 1] - b.state.position[at];
      EXPECT_LT((step - element * axis_of(b.state.orientation[at])).norm(), 1e-12);
    }
}

TEST(Film, NothingIsCloserThanTheSpacingAndTubesRestOnOthers) {
  for (const char* spacing : {"1.6", "2.5"}) {
    const BuiltScene b = film(dense + "spacing_nm = " + spacing + "\n");
    EXPECT_NEAR(closest(rods(b), 10 * element), std::stod(spacing), 1e-9);
  }
  EXPECT_GE(closest(rods(film("tubes = 60\nlength_nm = 20\nwidth_nm = 100\ndepth_nm = 21\nspacing_nm = 1.7\n")),
                    0.5 * 15 * element),
            1.7 - 1e-9);
}

// The crossed well of the law.
TEST(Film, SpacingIsThatOfCrossedTubes) {
  Scene scene = film_scene(dense);
  const double well = line_crossed_well(scene.parameters().line->density, 0.5 * units::pi).distance;
  EXPECT_NEAR(crossed_spacing(scene), well, 1e-9);
  EXPECT_NEAR(closest(rods(build(scene)), 10 * element), well, 1e-9);
  Scene paper =
      film_scene("tubes = 20\nlength_nm = 13.56\nwidth_nm = 20\ndepth_nm = 20\n", "", "\"cnt-10-10-paper\"");
  EXPECT_NEAR(closest(rods(build(paper)), 0.5 * 13.56), crossed_spacing(paper), 1e-9);
  EXPECT_GT(crossed_spacing(paper), 2 * 0.678);
}

TEST(Film, IsThatOfItsSeed) {
  const BuiltScene a = film(dense), b = film(dense), c = film(dense + "[start]\nseed = 2\n");
  EXPECT_EQ(a.state.position.x, b.state.position.x);
  EXPECT_EQ(a.state.position.z, b.state.position.z);
  EXPECT_NE(a.state.position.x, c.state.position.x);
}

TEST(Film, OneLayerStaysOne) {
  const BuiltScene b = film("tubes = 1\nlength_nm = 20\nwidth_nm = 21\ndepth_nm = 21\n");
  EXPECT_EQ(b.state.position.z[0], 0);
}

TEST(Film, MixedTubesKeepTheWidestSpacing) {
  const BuiltScene b = film("tubes = 3\nlength_nm = 20\nwidth_nm = 21\ndepth_nm = 21\n", "tube_types = [0, 1, 0]\n",
                            "[\"cnt-10-10-tersoff\", \"cnt-5-5-tersoff\"]");
  EXPECT_EQ(b.topology.tube_type[1], 1);
  EXPECT_GT(closest(rods(b), 0.5 * 15 * element), 2 * 0.6887);
}

TEST(Film, ProjectedDistance) {
  const FilmTube flat{0, 0, 0, 0};
  EXPECT_EQ(projected_distance2(flat, {0.5, 0.5, 3, 0.5 * units::pi}, 4), 0);
  EXPECT_NEAR(projected_distance2(flat, {1, 2, 3, 0}, 4), 4, 1e-12);
  EXPECT_NEAR(projected_distance2(flat, {5, 2, 3, 0}, 4), 1 + 4, 1e-12);
  EXPECT_NEAR(projected_distance2(flat, {0.5, 3, 0, 0.5 * units::pi}, 4), 1, 1e-12);
}

TEST(Film, WrongKeysAreRefused) {
  const auto words = [](const std::string& keys) -> std::string {
    try {
      film(keys);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string box = "width_nm = 60\ndepth_nm = 40\n";
  EXPECT_THAT(words("tubes = 10\nlength_nm = 50\n" + box),
              HasSubstr("film.depth_nm: is 40 nm, and the tubes are 49.5931 nm long; take a box"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 2\n" + box), HasSubstr("at least 2 elements"));
  EXPECT_THAT(words("tubes = 100000\nlength_nm = 20\n" + box), HasSubstr("take a larger box or fewer tubes"));
  EXPECT_THAT(words("tubes = 10000000\nlength_nm = 20\n" + box), HasSubstr("are allowed"));
  EXPECT_THAT(words("tubes = 0\nlength_nm = 20\n" + box), HasSubstr("film.tubes"));
  EXPECT_THAT(words("length_nm = 20\n" + box), HasSubstr("film.tubes: is missing"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\nspacing_nm = 0.5\n" + box), HasSubstr("film.spacing_nm"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\nwidth_nm = 60\n"), HasSubstr("film.depth_nm: is missing"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\n" + box + "[chain]\nelements = 5\n"),
              HasSubstr("chain: stands beside [film]"));
}

}  // namespace
}  // namespace ropewalk
