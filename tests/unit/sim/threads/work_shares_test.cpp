// Every piece of work is done once, whoever does it.
#include "sim/threads/work_shares.hpp"

#include <gtest/gtest.h>

namespace ropewalk {
namespace {
namespace UNIT {

TEST(WorkShares, EveryPieceIsTakenOnce) {
  WorkShares shares;
  for (const int pieces : {0, 1, 2, 7, 64})
    for (const int threads : {1, 2, 3, 5}) {
      shares.deal(pieces, threads);
      std::vector<std::atomic<int>> taken(static_cast<std::size_t>(pieces));
#pragma omp parallel num_threads(threads)
      for (int piece; (piece = shares.take(omp_get_thread_num())) >= 0;) ++taken[static_cast<std::size_t>(piece)];
      for (const auto& times : taken) EXPECT_EQ(times, 1) << pieces << " pieces, " << threads << " threads";
    }
}

TEST(WorkShares, AThreadBeginsWithItsOwnAndThenTakesTheRest) {
  WorkShares shares;
  shares.deal(6, 2);
  std::vector<int> order;
  for (int piece; (piece = shares.take(1)) >= 0;) order.push_back(piece);
  EXPECT_EQ(order, (std::vector<int>{3, 4, 5, 2, 1, 0}));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
