// Makes the figures of cases and their lines.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/case.hpp"

namespace ropewalk::validate {

CaseFigure case_figure(std::string title, ChartAxis x, ChartAxis y, std::string caption,
                       std::vector<ChartLine> lines = {});

// The curve of an oracle between two abscissae, as a line.
ChartLine theory_curve(std::string name, double from, double to, const std::function<double(double)>& curve);
ChartLine theory_curve(std::string name, double from, double to, int colour,
                       const std::function<double(double)>& curve);
// Numbers of the model, as points.
ChartLine model_points(std::string name, std::vector<double> x, std::vector<double> y, int colour = 1);

}  // namespace ropewalk::validate
