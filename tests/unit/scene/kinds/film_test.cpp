// Films: how many tubes, where, and that none touches another.
#include "scene/kinds/film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/contact/line_parameters.hpp"
#include "model/error.hpp"
#include "scene/build.hpp"
#include "scene/scene_toml.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

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
  const double well =
      line_crossed_well(scene.parameters().law<LineParameters>()->density, 0.5 * units::pi).distance;
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
  const BuiltScene d = film(dense + "laid = \"resting\"\n"), e = film(dense + "laid = \"resting\"\n");
  EXPECT_EQ(d.state.position.z, e.state.position.z);
  EXPECT_EQ(d.state.orientation.w, e.state.orientation.w);
  EXPECT_NE(d.state.position.z, a.state.position.z);
}

// To the ends of the tubes, and not to the centres of their last elements.
TEST(Film, IsAsThickInElementsOfAnyLength) {
  std::vector<std::string> said;
  for (const char* length : {"element_length_nm = 1.3\n", "element_length_nm = 0.65\n"}) {
    Scene scene =
        film_scene("tubes = 10\nlength_nm = 15.6\nwidth_nm = 18\ndepth_nm = 18\nlaid = \"resting\"\n", length);
    const BuiltScene b = build(scene);
    said.push_back(scene.source->description(b.topology, b.state, 0));
  }
  EXPECT_EQ(said[0], said[1]);
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

constexpr double spaced = 1.7;

std::vector<FilmTube> laid_on_others(FilmSource::Laid laid) {
  FilmSource film;
  film.tubes = 400;
  film.length = 27.6;
  film.width = film.depth = 90;
  film.laid = laid;
  Random random(5);
  return lay_film(film, 20, 1.38, spaced, random);
}

// From above, one of the tubes ends at the spacing from another one.
bool has_an_end_beside(const std::vector<FilmTube>& tubes, std::size_t tube, double half) {
  const auto from_above = [](const Vector3& v) { return Vector3(v.x(), v.y(), 0); };
  const auto is_beside = [&](const FilmTube& ending, const FilmTube& other) {
    const Vector3 along = from_above(other.axis());
    for (const double end : {-half, half}) {
      const Vector3 to = from_above(ending.middle() + end * ending.axis() - other.middle());
      const double at = std::clamp(to.dot(along) / along.squaredNorm(), -half, half);
      if (std::fabs((to - at * along).norm() - spaced) < 1e-6) return true;
    }
    return false;
  };
  for (std::size_t o = 0; o < tube; ++o)
    if (is_beside(tubes[tube], tubes[o]) || is_beside(tubes[o], tubes[tube])) return true;
  return false;
}

// What holds each tube on the left and on the right of its middle, or under it. No earlier one is within the
// spacing.
TEST(Film, RestingTubesHaveASupportOnEitherSide) {
  const double half = 13.8;
  const std::vector<FilmTube> tubes = laid_on_others(FilmSource::Laid::resting);
  int on_plane = 0, beside = 0;
  for (std::size_t t = 0; t < tubes.size(); ++t) {
    const Vector3 middle = tubes[t].middle(), axis = tubes[t].axis();
    bool left = false, right = false;
    const auto held = [&](double along) {
      if (along < 1e-4) left = true;
      if (along > -1e-4) right = true;
    };
    for (const double end : {-half, half}) {
      const double height = middle.z() + end * axis.z();
      EXPECT_GT(height, -1e-9);
      if (height < 1e-6) held(end), ++on_plane;
    }
    for (std::size_t o = 0; o < t; ++o) {
      const Vector3 to = tubes[o].middle() - middle, other = tubes[o].axis();
      const double apart = segment_distance(middle, axis, tubes[o].middle(), other, half);
      EXPECT_GT(apart, spaced - 1e-6) << t << " and " << o;
      if (apart > spaced + 1e-6) continue;
      const double cosine = axis.dot(other);
      double along = (to.dot(axis) - cosine * to.dot(other)) / (1 - cosine * cosine);
      along = std::clamp(along, -half, half);
      const double on_other = std::clamp(cosine * along - to.dot(other), -half, half);
      held(std::clamp(to.dot(axis) + cosine * on_other, -half, half));
    }
    if (left && right) continue;
    ++beside;
    EXPECT_TRUE(has_an_end_beside(tubes, t, half)) << "tube " << t << " would fall";
  }
  EXPECT_LT(beside, 40);
  EXPECT_GT(on_plane, 20);
  EXPECT_LT(on_plane, 400);
}

TEST(Film, RestingTubesKeepTheirLengthAndTheBox) {
  const BuiltScene b = film(dense + "laid = \"resting\"\n");
  double steepest = 0;
  for (int t = 0; t < b.topology.tubes(); ++t)
    for (int i = b.topology.tube_begin[t]; i + 1 < b.topology.tube_begin[t + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Vector3 axis = axis_of(b.state.orientation[at]);
      EXPECT_LT((b.state.position[at + 1] - b.state.position[at] - element * axis).norm(), 1e-12);
      EXPECT_LE(std::fabs(b.state.position.x[at]), 30);
      EXPECT_LE(std::fabs(b.state.position.y[at]), 20);
      steepest = std::max(steepest, std::fabs(axis.z()));
    }
  EXPECT_GT(steepest, 0.1);
  Scene scene = film_scene(dense);
  EXPECT_NEAR(closest(rods(b), 10 * element), crossed_spacing(scene), 1e-8);
}

TEST(Film, BothWaysOfLayingTakeTheSamePlaces) {
  const auto resting = laid_on_others(FilmSource::Laid::resting), level = laid_on_others(FilmSource::Laid::level);
  for (std::size_t t = 0; t < level.size(); ++t) {
    EXPECT_EQ(resting[t].x, level[t].x);
    EXPECT_EQ(resting[t].angle, level[t].angle);
    EXPECT_EQ(level[t].tilt, 0);
  }
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
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\nlaid = \"hanging\"\n" + box), HasSubstr("film.laid"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\nwidth_nm = 60\n"), HasSubstr("film.depth_nm: is missing"));
  EXPECT_THAT(words("tubes = 10\nlength_nm = 20\n" + box + "[chain]\nelements = 5\n"),
              HasSubstr("chain: stands beside [film]"));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
