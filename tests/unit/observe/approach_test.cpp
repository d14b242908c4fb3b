// Where a record goes to, and how well that is known.
#include "observe/approach.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace ropewalk {
namespace {
namespace UNIT {

struct Record {
  std::vector<double> t, y;
  Record(double end, int rows, const std::function<double(double)>& of) {
    for (int k = 0; k <= rows; ++k) t.push_back(end * k / rows), y.push_back(of(t.back()));
  }
  Approach approach() const { return approach_of(t, y); }
};

TEST(Approach, ContinuesAnExponential) {
  for (const double time : {30.0, 100.0, 400.0}) {
    const Approach a = Record(400, 400, [&](double t) { return 5 + 3 * std::exp(-t / time); }).approach();
    EXPECT_NEAR(a.limit, 5, 2e-4) << time;
    EXPECT_NEAR(a.to_go, 3 * std::exp(-400 / time), 2e-4) << time;
    EXPECT_NEAR(a.time, time, 0.01 * time) << time;
    EXPECT_NEAR(a.wait(0.5), time * std::log(2), 0.01 * time);
  }
}

// dy/dt = -(y + b y^2)/tau, whose solution is known: far from rest one exponential misses it, on both sides, and
// the error covers that.
TEST(Approach, HasAnErrorThatCoversAMotionThatIsNotLinear) {
  for (const double b : {-0.4, 0.3, 1.0})
    for (const double end : {150.0, 250.0, 400.0, 800.0}) {
      const double from = 1, tau = 150;
      const Approach a = Record(end, 400, [&](double t) {
                           const double e = from * std::exp(-t / tau);
                           return 2 + e / (1 + b * (from - e));
                         }).approach();
      EXPECT_LT(std::fabs(a.limit - 2), std::max(a.error(), 1e-5)) << b << " " << end;
      EXPECT_LT(a.error(), 2.5 * std::fabs(a.to_go) + 1e-3) << b << " " << end;
    }
}

// Correlated noise about a constant, and about an exponential: the mean over many records of the square of the miss
// over its error is 1.
TEST(Approach, KnowsItsNoise) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const double amplitude : {0.0, 20.0}) {
    const int records = 60;
    int within_two = 0;
    for (int k = 0; k < records; ++k) {
      double noise = 0;
      const Approach a = Record(400, 400, [&](double t) {
                           noise = 0.7 * noise + std::sqrt(1 - 0.49) * normal(random);
                           return amplitude * std::exp(-t / 150) + noise;
                         }).approach();
      within_two += std::fabs(a.limit) < 2 * a.error();
    }
    EXPECT_GT(within_two, 0.85 * records) << amplitude;
  }
}

// At the turn of an overshoot nothing moves, and yet it is no rest.
TEST(Approach, DoesNotTakeATurnForRest) {
  const Approach a =
      Record(60, 100, [](double t) { return 102 + 20 * std::exp(-t / 700) - 90 * std::exp(-t / 6); }).approach();
  EXPECT_GT(a.error(), 1);
}

TEST(Approach, AsksForRows) {
  EXPECT_TRUE(std::isinf(Record(400, 20, [](double) { return 1.0; }).approach().error()));
  EXPECT_FALSE(std::isinf(Record(400, 40, [](double) { return 1.0; }).approach().error()));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
