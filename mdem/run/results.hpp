// What came of a run, from its log.csv, limits.json and events.csv, with the errors that `ropewalk errors` found.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/numeric_errors.hpp"
#include "io/run_results.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

// None where there is no file.
std::vector<LimitRecord> limits_of(const RunDirectory& dir);
RunResults results_of(const RunDirectory& dir);
// The same, which also says at which clamp the first tube broke.
RunResults results_of(const RunDirectory& dir, const Prepared& prepared);

// Values of a run, and of the runs that repeat this run for its errors. Each run is read once.
class RepeatedValues {
 public:
  using Values = std::function<std::vector<double>(const RunDirectory&)>;

  RepeatedValues(const RunDirectory& run, Values values);
  RunErrors::ResultOfRun of(std::size_t k) const;  // the k-th of them

 private:
  std::string path_;
  Values values_;
  std::shared_ptr<std::map<std::string, std::vector<double>>> read_;  // values by the folder of the run
};

// The values that make up result_columns().
RepeatedValues repeated_results(const RunDirectory& run);
// Errors of the values of these columns, one for each; empty: none are known.
std::vector<WholeError> errors_of(const RunDirectory& run, const std::vector<OutputColumn>& columns,
                                  const RepeatedValues& values);
// The same of result_columns().
std::vector<WholeError> errors_of_results(const RunDirectory& run);

}  // namespace ropewalk
