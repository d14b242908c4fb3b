// Charts with logarithmic axes and named points.
#pragma once

#include "report/svg.hpp"

namespace ropewalk {

struct ScatterChart {
  LineChart chart;
  bool x_decades = false, y_decades = false;  // logarithmic axes; points that are not positive are left out
  // Names beside the points of each line. Lists may be shorter than the lines, and names may be empty.
  std::vector<std::vector<std::string>> labels;
};

// An <svg> element; empty if no line has two points at different x.
std::string scatter_svg(const ScatterChart& scatter);

// The same as a file of its own, with its colours, on white.
std::string chart_file(const ScatterChart& scatter);

}  // namespace ropewalk
