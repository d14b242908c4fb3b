#include "sim/state/tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Scene {
  Topology topology = test::published_topology();
  Vec3Array position;
  std::vector<double> cost;

  // Tubes along z at the places of a square.
  Scene(int side, int elements) : position(static_cast<std::size_t>(side * side * elements)) {
    test::Random random(4);
    for (int t = 0; t < side * side; ++t) {
      topology.add_tube(elements);
      for (int e = 0; e < elements; ++e)
        position.set(static_cast<std::size_t>(topology.tube_begin[t] + e),
                     Vector3(1.7 * (t % side), 1.7 * (t / side), test::element_length * e));
    }
    for (int i = 0; i < topology.elements(); ++i) cost.push_back(random.uniform(1, 3));
  }
};

TEST(TubeParts, HoldEveryElementOnceInTheOrderOfTheTubes) {
  Topology topology = test::published_topology();
  for (const int elements : {1, TubeParts::most, TubeParts::most + 1, 3 * TubeParts::most - 1, 2})
    topology.add_tube(elements);
  TubeParts parts;
  for (int times = 0; times < 2; ++times) parts.cut(topology);
  ASSERT_EQ(parts.count(), 1 + 1 + 2 + 3 + 1);
  int next = 0;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int k = parts.begin(t); k < parts.begin(t + 1); ++k) {
      EXPECT_EQ(parts[k].tube, t);
      EXPECT_EQ(parts[k].begin, next);
      EXPECT_GT(parts[k].end, next);
      EXPECT_LE(parts[k].end - next, TubeParts::most);
      next = parts[k].end;
    }
  EXPECT_EQ(next, topology.elements());
}

TEST(TubeParts, AreTakenTogetherInBlocksThatFollowEachOther) {
  Topology topology = test::published_topology();
  for (const int elements : {100, 100, 60, 3, TubeParts::max_block, 1, TubeParts::most, 2 * TubeParts::most, 5})
    topology.add_tube(elements);
  const TubeParts parts(topology);
  ASSERT_EQ(parts.block_begin(0), 0);
  ASSERT_EQ(parts.block_begin(parts.blocks()), parts.count());
  EXPECT_EQ(parts.blocks(), 9);  // 100, 100, 60 and 3, 128, 1, three whose parts are too long for company, 5
  for (int block = 0; block < parts.blocks(); ++block) {
    const int first = parts.block_begin(block), last = parts.block_begin(block + 1);
    ASSERT_LT(first, last);
    if (last - first > 1) {
      EXPECT_LE(parts[last - 1].end - parts[first].begin, TubeParts::max_block);
    }
    for (int k = first; k < last; ++k) {
      EXPECT_EQ(parts.block_of(k), block);
      EXPECT_EQ(parts.part_of(parts[k].begin, parts[k].tube), k);
      EXPECT_EQ(parts.part_of(parts[k].end - 1, parts[k].tube), k);
    }
  }
}

TEST(Tiles, HoldEveryElementOnceAtEqualCost) {
  const Scene scene(8, 200);
  for (const auto& [count, first] :
       {std::pair(1, CutBy::index), std::pair(2, CutBy::index), std::pair(7, CutBy::index),
        std::pair(16, CutBy::index), std::pair(2, CutBy::position), std::pair(16, CutBy::position)}) {
    const auto tiles = cut_into_tiles(scene.topology, scene.position, scene.cost, count, first);
    ASSERT_EQ(tiles.size(), static_cast<std::size_t>(count));
    std::vector<int> times(scene.cost.size(), 0);
    double total = 0, most = 0;
    for (const auto& tile : tiles) {
      double of_tile = 0;
      for (std::size_t k = 0; k < tile.size(); ++k) {
        if (k > 0 && tile[k - 1].tube == tile[k].tube) {
          EXPECT_LT(tile[k - 1].end, tile[k].begin);
        }
        EXPECT_GE(tile[k].begin, scene.topology.tube_begin[tile[k].tube]);
        EXPECT_LE(tile[k].end, scene.topology.tube_begin[tile[k].tube + 1]);
        for (int i = tile[k].begin; i < tile[k].end; ++i) {
          ++times[static_cast<std::size_t>(i)];
          of_tile += scene.cost[static_cast<std::size_t>(i)];
        }
      }
      total += of_tile;
      most = std::max(most, of_tile);
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
    EXPECT_LT(most, 1.2 * total / count);
  }
}

// A tile of 12800 / 16 elements is as wide as it is long, as far as pieces and tubes allow.
TEST(Tiles, AreCompact) {
  const Scene scene(8, 200);
  for (const auto& tile : cut_into_tiles(scene.topology, scene.position, scene.cost, 16, CutBy::index)) {
    Vector3 low = Vector3::Constant(1e9), high = -low;
    for (const Segment& s : tile)
      for (int i = s.begin; i < s.end; ++i) {
        low = low.cwiseMin(scene.position[static_cast<std::size_t>(i)]);
        high = high.cwiseMax(scene.position[static_cast<std::size_t>(i)]);
      }
    EXPECT_LT((high - low).maxCoeff(), 0.6 * 200 * test::element_length);
  }
}

// The first cut: halves of the tubes, or of the length of all.
TEST(Tiles, AreFirstCutAsAskedFor) {
  const Scene scene(3, 200);
  const auto longest = [&](CutBy first) {
    int elements = 0;
    for (const auto& tile : cut_into_tiles(scene.topology, scene.position, scene.cost, 2, first))
      for (const Segment& s : tile) elements = std::max(elements, s.end - s.begin);
    return elements;
  };
  EXPECT_EQ(longest(CutBy::index), 200);
  EXPECT_LT(longest(CutBy::position), 150);
}

TEST(Tiles, TakeFewElementsAndLostOnes) {
  Scene scene(1, 5);
  EXPECT_EQ(cut_into_tiles(scene.topology, scene.position, scene.cost, 4, CutBy::index).size(), 4u);
  Scene lost(4, 100);
  for (double& x : lost.position.x) x = std::numeric_limits<double>::quiet_NaN();
  int elements = 0;
  for (const auto& tile : cut_into_tiles(lost.topology, lost.position, lost.cost, 8, CutBy::position))
    for (const Segment& s : tile) elements += s.end - s.begin;
  EXPECT_EQ(elements, lost.topology.elements());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
