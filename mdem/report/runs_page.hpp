// Several runs in one figure: curves of their logs with bands over replicates, and their last states side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/run_results.hpp"
#include "report/page.hpp"
#include "report/svg.hpp"

namespace ropewalk {

// Means over the last part of a run, or of replicates, in the columns of the log.
struct RunMeans {
  double over_ps = 0;
  LogRow value;
  LogRow error;           // error by blocks (io/log_mean.hpp), for replicates by their scatter; nan: none
  LogRow correlation_ps;  // the mean over replicates
  LogRow needed_ps;       // where the time is too short for an error; else 0
};
// Means over the end of logs, none of which is empty.
RunMeans means_of(const std::vector<std::vector<LogRow>>& logs, double over_ps);

// One run, or the mean over replicates that differ in their seed alone.
struct RunCurve {
  std::string name;
  std::vector<LogRow> log;
  // Row by row: the standard error of the mean, or what is known of a single run (rows_of_errors()); empty:
  // nothing.
  std::vector<LogRow> error;
  std::size_t replicates = 1;
  std::string remark;                    // how it ended
  std::vector<LimitRecord> limits = {};  // limits of the run, or of the replicate that passed a limit first
  std::optional<RopeView> view = {};     // last frame of the first replicate
  double tube_radius = 0;                // nm
  std::optional<RunMeans> means = {};    // in the table of ends, in the place of the last rows
};

// Whether no time passes in its rows, as in the log of a relaxation.
bool stands_still(const std::vector<LogRow>& log);

// Throws InputError where these logs, the first of which is in `path`, have no mean over the last so many ps:
// relaxations, and runs that are all shorter.
void refuse_mean_over(double over_ps, const std::vector<std::vector<LogRow>>& logs, const std::string& path);

// Means of logs with rows at the same times, as far as the shortest reaches. Of relaxations, whose rows have no
// time, the last rows alone.
RunCurve mean_of(std::string name, const std::vector<std::vector<LogRow>>& logs);

// A value to compare with, drawn across the chart.
struct ReferenceLevel {
  double value = 0;
  std::string name;
};

struct RunsFigure {
  std::string x = "time_ps";   // columns of the log
  std::vector<std::string> y;  // a chart each; empty: those that vary, out of the usual ones
  std::vector<ReferenceLevel> levels;
  bool y_decades = false;
};

// `first`: HTML that the page begins with, behind its title. `figures` has counted the figures in this HTML.
// Throws std::invalid_argument where a column does not exist.
std::string runs_page(const std::string& title, const std::vector<RunCurve>& runs, const RunsFigure& figure,
                      Figures figures = {}, const std::string& first = "");
// The chart of the first y alone, as a file on white. Empty where there is nothing to draw.
std::string runs_svg(const std::vector<RunCurve>& runs, const RunsFigure& figure);
// x, then y and its error for each run: what the charts show. Where the runs have means, a line for each run with
// y, its error and its correlation time.
std::string runs_csv(const std::vector<RunCurve>& runs, const RunsFigure& figure);

}  // namespace ropewalk
