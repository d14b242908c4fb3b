#include "sim/threads/scratch.hpp"

#include <gtest/gtest.h>

namespace ropewalk {
namespace {
namespace UNIT {

TEST(Scratch, HasNoMoreThanAnEighthToSpare) {
  std::vector<int> v;
  for (const std::size_t n : {1000u, 1001u, 1600u, 1500u, 900u, 8000u, 7999u, 0u, 40u}) {
    set_size(v, n);
    EXPECT_EQ(v.size(), n);
    EXPECT_LE(v.capacity(), n + n / 8 + 64);
  }
}

TEST(Scratch, IsNotMadeAnewForALittleLess) {
  std::vector<int> v;
  set_size(v, 1000);
  const int* const where = v.data();
  for (const std::size_t n : {950u, 1000u, 900u}) {
    set_size(v, n);
    EXPECT_EQ(v.data(), where);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
