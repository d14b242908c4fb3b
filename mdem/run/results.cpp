#include "run/results.hpp"

#include <filesystem>
#include <utility>

#include "run/events_file.hpp"
#include "scene/watch.hpp"

namespace ropewalk {

std::vector<LimitRecord> limits_of(const RunDirectory& dir) {
  return std::filesystem::exists(dir.limits()) ? read_limits(dir.limits()).limits : std::vector<LimitRecord>();
}

RunResults results_of(const RunDirectory& dir) {
  return run_results(read_log(dir.log()), limits_of(dir), tube_breaks(dir.events()));
}

RunResults results_of(const RunDirectory& dir, const Prepared& p) {
  RunResults r = results_of(dir);
  TubeBreak& first = r.first_break;
  if (r.tubes_broken > 0 && first.tube < p.topology.tubes() && first.element < p.topology.length_of(first.tube))
    first.held_by = holder_in_words(p.topology, held_by(p.loads, p.topology),
                                    p.topology.tube_begin[static_cast<std::size_t>(first.tube)] + first.element);
  return r;
}

RepeatedValues::RepeatedValues(const RunDirectory& run, Values values)
    : path_(run.path), values_(std::move(values)), read_(new std::map<std::string, std::vector<double>>()) {}

RunErrors::ResultOfRun RepeatedValues::of(std::size_t k) const {
  return [*this, k](const std::string& folder) {
    const auto found = read_->find(folder);
    if (found != read_->end()) return found->second.at(k);
    const RunDirectory run{folder.empty() ? path_ : path_ + "/errors/" + folder};
    return read_->emplace(folder, values_(run)).first->second.at(k);
  };
}

RepeatedValues repeated_results(const RunDirectory& run) {
  return {run, [](const RunDirectory& dir) { return result_values(results_of(dir)); }};
}

std::vector<WholeError> errors_of(const RunDirectory& run, const std::vector<OutputColumn>& columns,
                                  const RepeatedValues& values) {
  const std::vector<LogRow> log = read_log(run.log());
  NumericErrors errors = read_numeric_errors(run.path, log);
  if (errors.empty()) {
    RunErrors parameters = read_run_errors(run.path, log);
    if (parameters.empty()) return {};
    errors = NumericErrors(run.path + "/errors", {}, std::move(parameters), log);
  }
  std::vector<WholeError> out;
  for (std::size_t k = 0; k < columns.size(); ++k)
    out.push_back(errors.of_runs(values.of(k), std::string(columns[k].unit) == "ps"));
  return out;
}

std::vector<WholeError> errors_of_results(const RunDirectory& run) {
  return errors_of(run, result_columns(), repeated_results(run));
}

}  // namespace ropewalk
