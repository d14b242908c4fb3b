// Tasks in processes of their own: io/processes.hpp.
#include "io/processes.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

namespace ropewalk {
namespace {
namespace UNIT {

int summed_by_threads() {
  int sum = 0;
#pragma omp parallel num_threads(2) reduction(+ : sum)
  sum += 1;
  return sum;
}

// A child that waited for threads of its parent would be ended by its alarm.
TEST(Processes, HaveThreadsOfTheirOwnAfterTheirParentHadSome) {
  int finished = 0, status = -1;
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(summed_by_threads(), 2);
    run_processes({{[] {
                      alarm(20);
                      return summed_by_threads() == 2 ? 0 : 1;
                    },
                    [&](int s) {
                      ++finished;
                      status = s;
                    }}},
                  1);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(finished, 2);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
