// The error of a run by what should not matter in it, beside that of its inputs (io/run_errors.hpp).
//
// Statistics. The run was repeated from other starts, with other random numbers. With the value x_0 of the run and
// x_1 ... x_m of these, the error of a single run is
//
//   s^2 = sum (x_i - mean)^2/m
//
// or, for a mean over time, that of blocks (observe/time_mean.hpp) where it is larger.
//
// Numerics. The run was repeated with one setting refined, such as elements of half the length. Where the error of
// a result goes as the power p of the setting, the difference d of the two runs is 1 - 2^-p of it, so that the
// error is d/(1 - 2^-p): 4/3 d for p = 2, 2 d for p = 1. Where d is below 2 sqrt(2) s, two errors of the difference
// of two runs, it cannot be told from their scatter: the error is then an upper bound, and the statistics decide.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "io/log.hpp"
#include "io/run_errors.hpp"

namespace ropewalk {

struct NumericSource {
  std::string name;    // "elements"
  std::string folder;  // folder of the run with the refined setting, within that of the errors
  double times = 1;    // 1/(1 - 2^-p)
  double pace = 1;     // the run takes so many times as long, in ps
  std::string change;  // "elements of 0.68 nm in the place of 1.36 nm"
  std::string remedy;  // what would halve this error: "element_length_nm = 0.96"
};

// What was repeated, as errors/numerics.json has it.
struct NumericRuns {
  std::vector<NumericSource> sources;
  std::vector<std::string> starts;   // folders of the runs from other starts
  std::vector<std::string> remarks;  // a sentence each, such as what could not be repeated, and why
  double mean_ps = 0;                // results are means over the last so many ps; 0: the last row
};

struct WholeError {
  double value = 0;
  double statistics = 0, numerics = 0, parameters = 0, potential = 0;
  std::vector<double> parts;  // parts of the numerics, by source
  bool bound = false;         // most of them is an upper bound
  int without = 0;            // repeated runs that do not have the result; the error is then not known
  std::string decides;        // what is largest: "statistics", "potential", "elements", "GJ"; empty: nothing is
  // Correlation time of a mean; nan: it is no mean. needed_ps: time for an error by blocks, where the run is too short.
  double correlation_ps = std::numeric_limits<double>::quiet_NaN();
  double needed_ps = std::numeric_limits<double>::quiet_NaN();

  double total() const;  // nan: not known
};

class NumericErrors {
 public:
  using Value = RunErrors::Value;

  NumericErrors() = default;
  // The logs are read from `directory`, that of the errors. `parameters` may be empty. Throws InputError.
  NumericErrors(const std::string& directory, NumericRuns runs, RunErrors parameters, std::vector<LogRow> log);

  bool empty() const { return runs_.sources.empty() && runs_.starts.empty(); }
  const NumericRuns& runs() const { return runs_; }
  // Error of one value in row k of the log.
  WholeError of(std::size_t k, const Value& value) const;
  // Error of the result: of its mean over the last runs().mean_ps, or of its last row.
  WholeError at_end(const Value& value) const;
  // Error of what came of the run, such as its largest torque. `is_time`: it is a time, which a run at half the rate
  // has twice.
  WholeError of_runs(const RunErrors::ResultOfRun& result, bool is_time) const;

 private:
  using Blocks = std::function<void(WholeError&)>;
  WholeError of(const RunErrors::Result& result, const Blocks& blocks) const;
  WholeError combined(double value, const std::vector<double>& starts, const std::vector<double>& refined,
                      const ResultError& parameters, const Blocks& blocks) const;

  NumericRuns runs_;
  RunErrors parameters_;
  std::vector<LogRow> log_;
  std::vector<std::vector<LogRow>> refined_, starts_;  // as long as log_
};

// errors/numerics.json in the directory of a run; empty where it is missing.
NumericErrors read_numeric_errors(const std::string& run_directory, const std::vector<LogRow>& log);
// Writes the file that read_numeric_errors() reads, with the errors of all observables at the end. `results`: errors
// of what came of the run, by its name.
std::string numeric_errors_json(const NumericErrors& errors, const std::vector<LogRow>& log,
                                const std::vector<std::pair<std::string, WholeError>>& results);
// As log.csv, with an error in the place of each value but those of step and time.
std::string whole_errors_csv(const NumericErrors& errors, const std::vector<LogRow>& log,
                             const std::function<double(const WholeError&)>& which);

// The errors that are known of every row of a run, all together, in the columns of the log; empty: none is.
std::vector<LogRow> rows_of_errors(const std::string& run_directory, const std::vector<LogRow>& log);

}  // namespace ropewalk
