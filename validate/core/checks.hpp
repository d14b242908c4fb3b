// Makes the checks and the figure lines of cases.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace ropewalk::validate {

// The tolerance is a fraction of |reference|.
Check relative_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
// The tolerance is in the unit.
Check absolute_check(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
// The check, shown without deciding anything.
Check information(Check check);

// The curve of an oracle between two abscissae, as a line.
ChartLine theory_curve(std::string name, const std::function<double(double)>& curve, double from, double to,
                       int colour = 0);
// Numbers of the model, as points.
ChartLine model_points(std::string name, std::vector<double> x, std::vector<double> y, int colour = 1);

}  // namespace ropewalk::validate
