// Charts with logarithmic axes and named points.
#pragma once

#include "report/svg.hpp"

namespace ropewalk {

enum class Mark { dot, square, diamond, triangle, cross, star };
inline constexpr int marks = 6;

// How a line is drawn, or its points one by one.
struct PointStyle {
  Mark mark = Mark::dot;
  std::vector<std::string> titles;  // what a reader sees who points at it
  std::vector<bool> hollow;         // may be shorter than the line
  bool faint = false;               // pale, behind others
};

struct ScatterChart {
  LineChart chart;
  // Names beside the points of each line. Lists may be shorter than the lines, and names may be empty.
  std::vector<std::vector<std::string>> labels;
  std::vector<PointStyle> styles = {};  // one each for the first lines; marks are those of lines that are points
  // Names stand where they cover neither a named point nor another name. One without such a place is left out.
  bool names_keep_apart = false;
};

// The mark alone, for legends: an <svg> element of 16 pixels.
std::string mark_svg(Mark mark, int colour, bool hollow = false);

// An <svg> element; empty if no line has two points at different x.
std::string scatter_svg(const ScatterChart& scatter);

// The same as a file of its own, with its colours, on white.
std::string chart_file(const ScatterChart& scatter);

}  // namespace ropewalk
