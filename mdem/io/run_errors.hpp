// Standard errors of the results of a run that follow from those of its inputs (scene/input_numbers.hpp).
//
// Each source is a parameter p, known to a relative standard error sigma. The run was repeated with p (1 +- h). To
// first order a result f then has the error
//
//   var f = sum_ij g_i rho_ij g_j,   g_i = sigma_i (f(p_i (1 + h)) - f(p_i (1 - h)))/2h
//
// with rho the correlations of the sources. Where the two runs do not lie on either side of the first, f is not
// linear in p; half of their distance from it is then added to g_i, and the result is marked.
//
// A parameter that is 0 and cannot be lower is only raised, by an absolute step: g = sigma (f(h) - f(0))/h.
//
// A second error follows from how far potentials lie apart (potential_spread.hpp), with C in the place of sigma rho
// sigma. Both are of the parameters alone: time step, elements, rate of loading and noise are not in them.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/log.hpp"

namespace ropewalk {

struct ErrorSource {
  std::string name;         // "GJ", or "GJ of cnt-5-5-tersoff" where there are several sets
  std::string plus, minus;  // directories of the runs, within that of the errors; no `minus`: it is only raised
  double sigma = 0;         // relative standard error; absolute where the value is 0
  double step = 0;          // h
  std::string key;          // key of the quantity, "bond.GJ"; empty: independent of all others
};

struct ResultError {
  double error = 0;
  double potential = 0;  // the error by the spread between potentials
  bool linear = true;
  std::vector<double> parts;  // g_i
  double value = 0;
};

class RunErrors {
 public:
  using Value = std::function<double(const LogRow&)>;
  using Result = std::function<double(const std::vector<LogRow>&)>;  // result of a log
  // Result of the run in this folder of `errors`, which need not have the rows of the others; "": of the run itself.
  using ResultOfRun = std::function<double(const std::string& folder)>;

  RunErrors() = default;
  // The logs of the runs are read from `directory`. Where they have other rows than `log`, the last ones are
  // compared, and the other rows have no error (NaN). Throws InputError.
  RunErrors(const std::string& directory, std::vector<ErrorSource> sources,
            std::vector<std::vector<double>> correlation, const std::vector<LogRow>& log);

  bool empty() const { return sources_.empty(); }
  const std::vector<ErrorSource>& sources() const { return sources_; }
  const std::vector<std::vector<double>>& correlation() const { return correlation_; }
  // The error of one value of row k of the log.
  ResultError of(std::size_t k, const Value& value) const;
  ResultError of(const Result& result) const;
  ResultError of_runs(const ResultOfRun& result) const;

 private:
  // `result` of source i, raised or lowered.
  ResultError combined(double middle, const std::function<double(std::size_t i, bool plus)>& result) const;

  std::vector<ErrorSource> sources_;
  std::vector<std::vector<double>> correlation_;
  std::vector<LogRow> log_;
  std::vector<std::pair<std::vector<LogRow>, std::vector<LogRow>>> runs_;  // plus and minus, as long as log_
};

// How far a value still moves at the end of a log: the largest distance of its last rows from a straight line
// through them. The last rows are a tenth of the log, at least eight. 0 for a log of fewer than four rows.
double movement(const std::vector<LogRow>& log, const RunErrors::Value& value);

// Whether the parameters act on a value at all: its error is more than rounding beside the largest value in the
// log, and more than noise where it is not linear in them.
bool has_influence(const ResultError& error, const std::vector<LogRow>& log, const RunErrors::Value& value);

// Whether it names a directory in another one, and none elsewhere.
bool is_plain_name(const std::string& folder);

// errors/errors.json in the directory of a run; none where it is missing.
RunErrors read_run_errors(const std::string& run_directory, const std::vector<LogRow>& log);
// Writes the file that read_run_errors reads, with the errors of all observables at the end.
// `results`: errors of what came of the run, by its name. `without_error`, `not_varied`: numbers that are not among
// the sources, in words.
std::string run_errors_json(const RunErrors& errors, const std::vector<LogRow>& log,
                            const std::vector<std::pair<std::string, ResultError>>& results,
                            const std::vector<std::string>& without_error,
                            const std::vector<std::string>& not_varied);
// As log.csv, with an error in the place of each value but those of step and time: `error` or `potential`.
std::string run_errors_csv(const RunErrors& errors, const std::vector<LogRow>& log, double ResultError::*which);

}  // namespace ropewalk
