// Where a quantity that still moves comes to rest: the end of its record, continued.
//
// Near a state of rest a damped motion is y = y0 + A exp(-t/tau). This is fitted to the third quarter of a record
// and to the last one. Farther away the motion is not linear in A, and each fit misses y0 by about A^2, so that the
// misses d3 and d4 of the two fits go as d4/d3 = q = exp(-2 w/tau), w the length of a quarter. Both limits then
// give
//
//   y0 = y4 - (y3 - y4) q/(1 - q)
//
// The stated error is |y0 - y4|. Estimates for seven tubes that creep under a couple, at viscosities of 20, 50 and
// 100, are 0.1 to 0.5 of this error away from the true rest (docs/theory.md).
#pragma once

#include <cmath>
#include <limits>
#include <vector>

namespace ropewalk {

struct Approach {
  double limit = 0;       // y0
  double drift = 0;       // error of the continuation
  double statistics = 0;  // standard error by the noise of the last quarter
  double to_go = 0;       // from y0 to the end of the record, smoothed
  double time = 0;        // tau; 0: it stands still but for its noise
  double swing = 0;       // largest difference of two residuals of the fit in the last quarter

  double error() const { return std::hypot(drift, statistics); }
  // The further time after which no more than `part` of the present distance is left.
  double wait(double part) const { return part < 1 && time > 0 ? -time * std::log(part) : 0; }
};

inline constexpr int least_rows_of_approach = 8;  // rows in a quarter

// Times are increasing and begin at 0. Residuals of neighbouring rows are alike, which `statistics` counts. With
// too few rows in one of both quarters the errors are infinite.
Approach approach_of(const std::vector<double>& t, const std::vector<double>& y);

}  // namespace ropewalk
