// Networks of straight tubes that are known by construction.
#include "observe/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/segments.hpp"
#include "model/units.hpp"
#include "scene/kinds/film.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using ::testing::ElementsAre;

struct Placed {
  Topology topology;
  State state;
};

// Ten elements of 1 nm each.
Placed placed(const std::vector<FilmTube>& tubes) {
  Placed p;
  p.topology.types[0].element_length = 1;
  put_tubes(tubes, 10, 1, p.topology, p.state);
  return p;
}

constexpr double along_y = 0.5 * units::pi;

// A row along x whose second tube lies across, one beside it that touches none, and one above the row.
const std::vector<FilmTube> row = {
    {-9.1, 0, 0, 0, 0}, {-3.5, 1, 0.8, along_y, 0}, {2.1, 0, 0, 0, 0}, {0, 20, 0, 0, 0}, {3, 0, 1.2, 0.3, 0}};

TEST(TubeNetwork, TubesTouchWithinTheDistance) {
  const Placed p = placed(row);
  EXPECT_THAT(touching_tubes(p.topology, p.state, 1.15), ElementsAre(TubePair(0, 1), TubePair(1, 2)));
  EXPECT_THAT(touching_tubes(p.topology, p.state, 1.25),
              ElementsAre(TubePair(0, 1), TubePair(0, 2), TubePair(1, 2), TubePair(2, 4)));
  EXPECT_THAT(touching_tubes(p.topology, p.state, 0.9), ElementsAre());
}

TEST(TubeNetwork, ClustersSpanWhatTheyReach) {
  const Placed p = placed(row);
  const TubeNetwork n = tube_network(p.topology, p.state, 1.15, {5, 5});
  EXPECT_DOUBLE_EQ(n.contacts, 2 * 2 / 5.0);
  EXPECT_DOUBLE_EQ(n.largest, 3 / 5.0);
  EXPECT_TRUE(n.spans_x);
  EXPECT_FALSE(n.spans_y);
  EXPECT_FALSE(tube_network(p.topology, p.state, 1.15, {7, 5}).spans_x) << "the last element is at 6.5";
  EXPECT_FALSE(tube_network(p.topology, p.state, 0.9, {5, 5}).spans_x) << "two clusters, each at one side";
  EXPECT_TRUE(tube_network(p.topology, p.state, 0.9, {20, 3.4}).spans_y) << "one tube by itself";
}

TEST(TubeNetwork, TellsWhenAClusterBeginsToSpan) {
  const Placed p = placed(row);
  TubeClusters clusters(p.topology, p.state, {5, 5});
  clusters.join({0, 1});
  EXPECT_EQ(clusters.largest(), 2);
  EXPECT_FALSE(clusters.spans_x());
  clusters.join({1, 2});
  EXPECT_TRUE(clusters.spans_x());
  clusters.join({0, 2});
  EXPECT_EQ(clusters.largest(), 3);
}

// Against all pairs of whole tubes.
TEST(TubeNetwork, FindsEveryPairOfAFilm) {
  FilmSource film;
  film.tubes = 200;
  film.length = 10;
  film.width = film.depth = 40;
  film.laid = FilmSource::Laid::resting;
  Random random(3);
  const std::vector<FilmTube> tubes = lay_film(film, 10, 1, 1.2, random);
  const Placed p = placed(tubes);
  std::vector<TubePair> all;
  for (int a = 0; a < 200; ++a)
    for (int b = a + 1; b < 200; ++b) {
      const FilmTube &i = tubes[static_cast<std::size_t>(a)], &j = tubes[static_cast<std::size_t>(b)];
      if (squared_segment_distance(j.middle() - i.middle(), i.axis(), j.axis(), 5, 5) < 1.5 * 1.5)
        all.emplace_back(a, b);
    }
  EXPECT_GT(all.size(), 200U);
  EXPECT_EQ(touching_tubes(p.topology, p.state, 1.5), all);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
