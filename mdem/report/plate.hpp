// A figure for a paper: states of one run side by side with their cross-sections, and curves with the times of the
// states marked. One SVG file on white.
#pragma once

#include <string>
#include <vector>

#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "report/report.hpp"

namespace ropewalk {

struct PlateInput {
  std::vector<RopeView> views;          // views in the order of time
  std::vector<ReportSection> sections;  // of the same frames; empty: none are drawn
  RopeShells shells;
  double tube_radius = 0;
  std::vector<LogRow> log;
  std::vector<LimitRecord> limits;  // of the run: curves are dotted from the first that it passed on
  std::vector<LogRow> errors;  // errors of its rows, drawn as bands; empty: not known
  // Charts below, each with one column or more of the same unit; empty: none.
  std::vector<std::vector<std::string>> curves;
  std::string x;  // a column of the log, over which the charts are drawn; empty: time
  RopeCamera camera;
  double width = 1040;  // pixels
};

std::string plate_svg(const PlateInput& input);

}  // namespace ropewalk
