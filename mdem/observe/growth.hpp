// Exponential growth of a positive quantity: a straight line through its logarithms.
#pragma once

#include <cstddef>
#include <vector>

namespace ropewalk {

struct Growth {
  double rate = 0;   // 1/ps
  double error = 0;  // standard error; infinite with fewer than four values
  std::size_t values = 0;
};

// Least squares of ln(y) against t (ps). Values that are not positive are left out. Residuals of neighbouring rows
// are alike; with the correlation r of neighbours there are n (1 - r)/(1 + r) independent ones.
Growth growth_of(const std::vector<double>& t, const std::vector<double>& y);

}  // namespace ropewalk
