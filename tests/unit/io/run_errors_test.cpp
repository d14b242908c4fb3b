// How far the end of a log still moves.
#include "io/run_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ropewalk {
namespace {
namespace UNIT {

std::vector<LogRow> log_of(int rows, const std::function<double(double)>& torque) {
  std::vector<LogRow> log(static_cast<std::size_t>(rows));
  for (int k = 0; k < rows; ++k) {
    log[static_cast<std::size_t>(k)]["time_ps"] = k;
    log[static_cast<std::size_t>(k)]["torque_upper_nN_nm"] = torque(k);
  }
  return log;
}

double torque(const LogRow& row) { return row["torque_upper_nN_nm"]; }

TEST(Movement, IsThatAboutALine) {
  EXPECT_NEAR(movement(log_of(200, [](double t) { return 16 + 0.032 * std::sin(0.7 * t); }), torque), 0.032, 0.004);
  EXPECT_NEAR(movement(log_of(200, [](double t) { return 16 + 0.5 * t; }), torque), 0, 1e-12);  // a ramp
  // Movement before the last tenth of the log does not count.
  EXPECT_NEAR(movement(log_of(200, [](double t) { return t < 100 ? std::sin(t) : 16; }), torque), 0, 1e-12);
  EXPECT_EQ(movement(log_of(3, [](double t) { return std::sin(t); }), torque), 0);
}

TEST(Influence, IsMoreThanRounding) {
  const auto of = [](double error) { return ResultError{error, 0, true, {}}; };
  const std::vector<LogRow> nothing = log_of(9, [](double) { return 0.0; }),
                            large = log_of(9, [](double t) { return 1e4 * t; });
  EXPECT_FALSE(has_influence(of(9e-12), nothing, torque));
  EXPECT_TRUE(has_influence(of(1e-6), nothing, torque)) << "of a value that happens to be 0 at the end";
  EXPECT_FALSE(has_influence(of(1e-6), large, torque));
  EXPECT_TRUE(has_influence(of(1e-3), large, torque));
  EXPECT_FALSE(has_influence(of(std::nan("")), large, torque));
  const auto bent = [](double error) { return ResultError{error, 0, false, {}}; };
  const std::vector<LogRow> swings = log_of(200, [](double t) { return 0.1 * std::sin(t); });
  EXPECT_FALSE(has_influence(bent(1e-8), nothing, torque)) << "zero by symmetry";
  EXPECT_FALSE(has_influence(bent(0.05), swings, torque)) << "as much as it swings by itself";
  EXPECT_TRUE(has_influence(bent(0.5), swings, torque));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
