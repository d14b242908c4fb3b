// Charts with logarithmic axes and named points.
#pragma once

#include "report/svg.hpp"

namespace ropewalk {

struct ScatterChart {
  LineChart chart;
  bool x_decades = false, y_decades = false;  // logarithmic: what is not positive is left out
  // Of the points of each line, beside them; may be shorter, may hold empty ones.
  std::vector<std::vector<std::string>> labels;
};

// An <svg> element; empty where no line has two points at different x.
std::string scatter_svg(const ScatterChart& scatter);

}  // namespace ropewalk
