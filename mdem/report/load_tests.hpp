// Ropes that were loaded until they failed: tables and figures with means and errors over runs that differ in their
// seed, or of a single run with the errors that `ropewalk errors` found.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/outputs.hpp"
#include "io/run_results.hpp"
#include "report/page.hpp"

namespace ropewalk {

// One run.
struct LoadTest {
  LogRow at;                   // the row that the column of the horizontal axis is taken from
  std::vector<double> values;  // those of LoadTestKind::columns
  bool to_half = false;        // the run went on until the load had fallen to half of the largest
  std::vector<LimitRecord> limits = {};
  std::vector<double> errors = {};  // of the values, nan where none is known; empty: none is
  std::string why_none = {};        // why the first value is nan
};

// Runs that differ in their seed alone.
struct LoadTestGroup {
  std::string name;
  std::string line;  // groups with the same text are points of one line
  std::vector<LoadTest> tests;
};

struct LoadTestKind {
  const char* heading;
  const char* words;                                        // HTML above the table
  const char* drawn;                                        // what the first column is, in a figure
  const char* unit;                                         // unit of the first column
  std::vector<OutputColumn> columns;                        // the first is drawn
  bool yarn_law = false;                                    // over beta_deg with cos^2 of that angle
  std::vector<std::pair<double, std::string>> levels = {};  // to compare the first column with, and their names
  std::string left_out = {};  // runs that are in no group, and why; empty: none are
  double yarn_diameter = 0;   // nm; beside the column of the horizontal axis turns per metre of such a yarn; 0: none
};

// Columns: run, replicates, to_half, --x, turns_per_m where there is a yarn_diameter, then each of the kind with
// its standard error, then limit_columns() of the replicate that passed a limit first, and why_none.
std::string load_tests_csv(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                           const std::string& x);
// The first column over the column `x` of the log, from 0, without groups that have none. With `yarn_law` over beta_deg with the cos^2 of that
// angle, which is the law of yarns of long fibres (J. W. S. Hearle, P. Grosberg, S. Backer, Structural Mechanics of
// Fibers, Yarns, and Fabrics, Wiley 1969). Empty: no line has two points.
std::string load_tests_svg(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                           const std::string& x);
// The part of a page: the table and that chart. `lines`: what the names of the lines are, "tube_length_nm, per_nm".
std::string load_tests_part(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                            const std::string& x, const std::string& lines, Figures& figures);

}  // namespace ropewalk
