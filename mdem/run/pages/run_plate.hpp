// A figure of states of a run, for papers and pages.
#pragma once

#include <string>
#include <vector>

#include "report/plate.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

struct PlateOptions {
  std::vector<double> at;  // ps; empty: `usual` times, evenly over the run
  std::size_t usual = 4;
  std::string from = "side";  // camera_from()
  std::string colour;         // a word of colour_words(); empty: bending moment where frames have it
  bool sections = false;
  std::vector<std::vector<std::string>> curves;  // columns of the log: each group makes one chart
  std::string x;                                 // PlateInput::x
  double width = 1040, highest = 200;            // width of the figure and largest height of each state, pixels
};

// Throw InputError where the run has no frames, or none near a time. plate_of: for figures of several runs that are
// to have one scale of colours; run_plate: as SVG.
PlateInput plate_of(const RunDirectory& dir, const PlateOptions& options);
std::string run_plate(const RunDirectory& dir, const PlateOptions& options);

}  // namespace ropewalk
