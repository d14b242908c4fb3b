#include "model/segments.hpp"

#include <gtest/gtest.h>

#include "unit/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

// A grid never finds a smaller distance, and one almost as small.
TEST(Segments, DistanceIsTheSmallest) {
  Random random(3);
  constexpr int grid = 200;
  for (int sample = 0; sample < 400; ++sample) {
    const Vector3 n_i = random.direction();
    // Also parallel and nearly parallel ones.
    const double tilt = sample % 4 == 0 ? 0.0 : sample % 4 == 1 ? 1e-7 : 1.0;
    const Vector3 n_j =
        (sample % 8 < 4 ? 1 : -1) * (n_i + tilt * random.uniform(0, 3) * random.direction()).normalized();
    const Vector3 s = random.uniform(0, 3) * random.direction();
    const double half_i = random.uniform(0, 1), half_j = random.uniform(0, 1);
    const double found = std::sqrt(squared_segment_distance(s, n_i, n_j, half_i, half_j));
    double smallest = 1e9;
    for (int k = 0; k <= grid; ++k)
      for (int l = 0; l <= grid; ++l)
        smallest = std::fmin(
            smallest, (s + (2.0 * l / grid - 1) * half_j * n_j - (2.0 * k / grid - 1) * half_i * n_i).norm());
    EXPECT_LE(found, smallest + 1e-8) << sample;
    EXPECT_GE(found, smallest - 0.02) << sample;
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
