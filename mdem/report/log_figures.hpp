// Charts of columns of the log. The horizontal axis is the time, the step, or another column such as the rotation.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/report.hpp"

namespace ropewalk {

using LogValue = std::function<double(const LogRow&)>;
LogValue logged(const std::string& column);
ChartAxis column_axis(const std::string& column);

struct Trace {
  std::string name;
  LogValue value;
  int colour = 0;
  bool dashed = false;
  LogValue half_width = {};  // half width of a band about it
};

struct Panel {
  std::string title;
  std::string caption;  // HTML
  ChartAxis axis;
  std::vector<Trace> traces;
  bool steps = false;
  bool since_start = false;  // the chart shows changes, the table the values themselves
  std::string against = {};  // a column of the log; empty: the clock
};

// A relaxation has steps, but no time.
struct Clock {
  ChartAxis axis;
  std::string column;  // column of the log

  bool counts_steps() const { return column == "step"; }
};
Clock clock_of(const std::vector<LogRow>& log);

// All that is known of the error of a value in this row of the log; 0: nothing is.
double error_of(const ReportInput& in, std::size_t row, const LogValue& value);
double total_energy(const LogRow& r);  // eV
std::vector<double> values_of(const std::vector<LogRow>& log, const LogValue& value);

// Hatches the chart, whose horizontal axis has the values `x` of the rows, where the run is beyond a limit, and names
// it. Returns the first row beyond; the size of the log: none is.
std::size_t mark_beyond(const std::vector<LogRow>& log, const std::vector<LimitRecord>& limits,
                        const std::vector<double>& x, LineChart& chart);

// A <figure> with chart, caption and table.
std::string log_figure(const ReportInput& in, const Panel& panel, Figures& figures);
std::string not_drawn(const std::string& title);
// Two of them side by side.
std::string pair_of(const std::string& a, const std::string& b);

}  // namespace ropewalk
