// Every turn is taken once, by a team only where several threads have something to do.
#include "sim/threads/for_each.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace ropewalk {
namespace {
namespace UNIT {

struct Threads {
  explicit Threads(int threads) { omp_set_num_threads(threads); }
  ~Threads() { omp_set_num_threads(before); }
  const int before = omp_get_max_threads();
};

// Each loop over n, with the number of threads that its turns saw in a team: omp_get_level() is 1 in a team of one
// as well.
template <class Check>
void each_loop(int n, bool parallel, const Check& check) {
  const auto count = static_cast<std::size_t>(n);
  for (const bool uneven : {false, true}) {
    std::vector<std::atomic<int>> taken(count);
    std::atomic<int> in_teams{0};
    const auto turn = [&](std::size_t k) {
      ++taken[k];
      in_teams += omp_get_level();
    };
    uneven ? for_each_uneven(count, std::size_t{2}, parallel, turn) : for_each(count, parallel, turn);
    for (const auto& times : taken) EXPECT_EQ(times, 1) << n;
    check(in_teams.load());
  }
}

TEST(ForEach, OneThreadMakesNoTeam) {
  for (const int threads : {1, 3})
    for (const int n : {0, 1, 2, 64}) {
      const Threads set(threads);
      each_loop(n, threads == 1, [&](int in_teams) { EXPECT_EQ(in_teams, 0) << n << ' ' << threads; });
      in_team(threads == 1, [&] { EXPECT_EQ(omp_get_level(), 0); });
    }
}

TEST(ForEach, ThreadsShareTheTurns) {
  const Threads set(3);
  for (const int n : {3, 64}) each_loop(n, true, [&](int in_teams) { EXPECT_EQ(in_teams, n); });
  each_loop(1, true, [&](int in_teams) { EXPECT_EQ(in_teams, 0); });
  std::atomic<int> threads{0};
  in_team(true, [&] { ++threads; });
  EXPECT_EQ(threads, 3);
}

TEST(ForEach, LoopsOfATeamAreSharedByItAndDoneByOneThreadAlone) {
  for (const int count : {1, 3}) {
    const Threads set(count);
    std::vector<int> taken(100);
    in_team(true, [&] {
#pragma omp for schedule(static)
      for (std::size_t k = 0; k < taken.size(); ++k) ++taken[k];
#pragma omp barrier
#pragma omp for schedule(static)
      for (std::size_t k = 0; k < taken.size(); ++k) ++taken[taken.size() - 1 - k];
    });
    EXPECT_EQ(taken, std::vector<int>(100, 2)) << count;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
