// A figure of states of a run, for papers and pages.
#pragma once

#include <string>
#include <vector>

#include "run/run_directory.hpp"

namespace ropewalk {

struct PlateOptions {
  std::vector<double> at;  // ps; empty: `usual` times, evenly over the run
  std::size_t usual = 4;
  std::string from = "side";  // camera_from()
  bool sections = false;
  std::vector<std::vector<std::string>> curves;  // columns of the log: each group makes one chart
  std::string x;                                 // PlateInput::x
  double width = 1040, highest = 200;            // pixels, of the figure and of each state
};

// As SVG. Throws InputError where the run has no frames, or none near a time.
std::string run_plate(const RunDirectory& dir, const PlateOptions& options);

}  // namespace ropewalk
