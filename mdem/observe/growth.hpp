// Straight lines, and exponential growth: the line through the logarithms of a positive quantity.
#pragma once

#include <optional>
#include <vector>

namespace ropewalk {

// y = a + b x by least squares, with standard errors; these are NaN with two points.
struct StraightLine {
  double a = 0, b = 0, a_error = 0, b_error = 0;
};
// None where no two x differ.
std::optional<StraightLine> line_through(const std::vector<double>& x, const std::vector<double>& y);

struct Growth {
  double rate = 0;   // 1/ps
  double error = 0;  // standard error; infinite with fewer than four values
};

// Least squares of ln(y) against t (ps). Values that are not positive are left out. Residuals of neighbouring rows
// are alike; with the correlation r of neighbours there are n (1 - r)/(1 + r) independent ones.
Growth growth_of(const std::vector<double>& t, const std::vector<double>& y);

}  // namespace ropewalk
