// Near elements that the grid finds, against all pairs, for every instruction set.
#include "sim/neighbours/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/contact/line/engine.hpp"
#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

// Places at random in a box (nm) at `corner`.
Vec3Array scattered(std::size_t count, const Vector3& box, const Vector3& corner) {
  test::Random random(7);
  Vec3Array p(count);
  for (std::size_t i = 0; i < count; ++i)
    p.set(i, corner + (0.5 * (random.direction() + Vector3::Ones())).cwiseProduct(box));
  return p;
}

void expect_found(const Vec3Array& p, double reach) {
  const CellGrid grid(p, reach);
  std::vector<int> found;
  std::size_t pairs = 0;
  for (int i = 0; i < static_cast<int>(p.size()); ++i) {
    const int after = i + i % 3;
    const std::size_t count = grid.find(i, after, found);
    std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    std::vector<int> truth;
    for (std::size_t j = static_cast<std::size_t>(after) + 1; j < p.size(); ++j)
      if ((p[j] - p[static_cast<std::size_t>(i)]).norm() < reach) truth.push_back(static_cast<int>(j));
    ASSERT_EQ(std::vector<int>(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count)), truth) << i;
    pairs += count;
  }
  EXPECT_GT(pairs, p.size());
}

TEST(CellGrid, FindsWhatIsNearAlongAnySideForEveryInstructionSet) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(use_instructions(name));
    for (int longest = 0; longest < 3; ++longest) {
      Vector3 box(9, 14, 11);
      box[longest] = 40;
      expect_found(scattered(700, box, {-3, 5, 0}), 3);
      // Far away, where single precision resolves less than the distances that decide.
      expect_found(scattered(700, box, {2e6, -1e7, 5e5}), 3);
    }
    // One far from all others: places are known to the nanometre only.
    Vec3Array far = scattered(500, {20, 20, 20}, {0, 0, 0});
    far.set(499, {0, 3e7, 0});
    expect_found(far, 4);
    // One cell, and fewer members than a vector has lanes.
    expect_found(scattered(9, {2, 2, 2}, {0, 0, 0}), 3);
  }
  use_instructions(instruction_sets().front());
}

TEST(CellGrid, NothingIsNearWhatIsNotFinite) {
  Vec3Array p = scattered(300, {10, 10, 10}, {0, 0, 0});
  p.set(17, {1, std::numeric_limits<double>::quiet_NaN(), 1});
  p.set(18, {1, std::numeric_limits<double>::infinity(), 1});
  const CellGrid grid(p, 3);
  std::vector<int> found;
  EXPECT_EQ(grid.find(17, -1, found), 0u);
  EXPECT_EQ(grid.find(18, -1, found), 0u);
  for (int i = 0; i < 300; ++i) {
    const std::size_t count = grid.find(i, -1, found);
    for (std::size_t k = 0; k < count; ++k) EXPECT_TRUE(found[k] != 17 && found[k] != 18) << i;
    if (i != 17 && i != 18) {
      EXPECT_GT(count, 0u) << i;  // itself, at least
    }
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
