// `errors`: how the standard errors of a scene's inputs carry through a run.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "campaign/error_runs.hpp"
#include "commands/commands.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "run/tell.hpp"

namespace ropewalk {
namespace {

// No digit of a value beyond two of the error of its fit, or of what it still moves by.
std::string value_text(double value, double error) {
  if (!(error > 0)) return fmt::format("{:.6g}", value);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(error)));
  const double unit = std::pow(10.0, decimals);
  return decimals > 0 ? fmt::format("{:.{}f}", value, std::min(decimals, 9))
                      : fmt::format("{:.0f}", std::round(value * unit) / unit);
}

void print_table(const RunErrors& errors, const std::vector<LogRow>& log) {
  fmt::print(
      "Errors of the parameters alone: nothing of time step, elements, rate of loading or noise is in them.\n"
      "{:<26} {:>14} {:>10} {:>11} {:>9}   {}\n",
      "at the end", "value", "± inputs", "± potential", "moves by", "the inputs' from");
  std::string none;
  for (std::size_t k = 0; k < observables().size(); ++k) {
    const Observable& o = observables()[k];
    if (o.name == "step" || o.name == "time_ps") continue;
    const RunErrors::Value value = [k](const LogRow& row) { return row.values()[k]; };
    const ResultError e = errors.of(log.size() - 1, value);
    if (!has_influence(e, log, value)) {
      if (e.error > 0) none += fmt::format("{}{}", none.empty() ? "" : ", ", o.name);
      continue;
    }
    double sum = 0;
    for (const double part : e.parts) sum += part * part;
    std::vector<std::pair<double, std::string>> shares;
    for (std::size_t i = 0; i < e.parts.size(); ++i)
      shares.emplace_back(e.parts[i] * e.parts[i] / sum, errors.sources()[i].name);
    std::sort(shares.rbegin(), shares.rend());
    std::string from;
    for (const auto& [share, name] : shares)
      if (share > 0.05) from += fmt::format("{}{} {:.0f} %", from.empty() ? "" : ", ", name, 100 * share);
    const double moves = movement(log, value);
    fmt::print("{:<26} {:>14} {:>10.2g} {:>11.2g} {:>9.2g}   {}{}\n", o.name,
               value_text(value(log.back()), std::max(e.error, moves)), e.error, e.potential, moves, from,
               e.linear ? "" : "; not linear: an estimate of its size only");
  }
  if (!none.empty()) fmt::print("No influence beyond rounding on {}.\n", none);
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

void print_left_out(const ErrorInputs& inputs) {
  if (!inputs.without_error.empty())
    fmt::print(
        "No error is stated of, and none carried from: {}.\nIn a scene's own tables it is stated as in {{ value = "
        "0.16, standard_error = 0.02 }}.\n",
        joined(inputs.without_error));
  if (!inputs.not_varied.empty()) fmt::print("Not varied: {}.\n", joined(inputs.not_varied));
}

}  // namespace

int errors_command(const ErrorsArguments& a) {
  const RunDirectory dir{a.dir};
  Scene scene = read_run_scene(dir);
  const Prepared prepared = prepare(scene);
  const Manifest manifest = read_manifest(dir.manifest());
  if (manifest.status != "finished")
    throw InputError({dir.path, 0, ""}, fmt::format("is a run that is {}", manifest.status),
                     "end it with `ropewalk resume`, or run the scene anew");
  const std::vector<LogRow> log = read_log(dir.log());
  if (log.empty()) throw InputError({dir.log(), 0, ""}, "has no rows", "run the scene anew");
  const ErrorInputs inputs = error_inputs(scene, prepared.topology.tubes());
  const std::vector<VariedNumber>& sources = inputs.varied;
  const ErrorRuns runs(dir, scene, prepared.time_step, a.again);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  std::vector<ProcessTask> tasks;
  std::vector<std::string> failed;
  std::size_t number = 0, count = 0;
  for (const VariedNumber& source : sources) count += source.error.minus.empty() ? 1 : 2;
  if (!a.quiet)
    tell_as_is(fmt::format("{} runs like this one, about {:.2g} min on {} cores\n", count,
                           static_cast<double>(count) * manifest.wall_seconds * manifest.threads / jobs / 60,
                           jobs));
  for (const VariedNumber& source : sources)
    for (const bool plus : {true, false}) {
      const std::string name = plus ? source.error.plus : source.error.minus;
      if (name.empty()) continue;
      ++number;
      tasks.push_back({[&, plus, number, name] {
                         if (!a.quiet) tell_as_is(fmt::format("{}/{} {}\n", number, count, name));
                         try {
                           if (!std::freopen("/dev/null", "w", stdout)) return 3;
                           return runs.run(source, plus);
                         } catch (const std::exception& e) {
                           return report_error(fmt::format("ropewalk errors: {}", name).c_str(), e);
                         }
                       },
                       [&failed, name](int status) {
                         if (status != 0)
                           failed.push_back(WIFEXITED(status) ? name : name + ": " + death_words(status));
                       }});
    }
  run_processes(tasks, jobs);
  if (!failed.empty())
    throw std::runtime_error(fmt::format(
        "{} of {} runs did not finish ({}): a run that fails by itself is too sensitive for an error to be "
        "given; else give the same command again, which keeps those that are finished",
        failed.size(), tasks.size(), failed.front()));
  std::vector<ErrorSource> described;
  for (const VariedNumber& s : sources) described.push_back(s.error);
  const RunErrors errors(dir.path + "/errors", described, correlation_of(sources, scene), log);
  const std::string json = run_errors_json(errors, log, inputs.without_error, inputs.not_varied);
  write_file_atomically(dir.path + "/errors/errors.json", json);
  write_file_atomically(dir.file("errors.csv"), run_errors_csv(errors, log, &ResultError::error));
  write_file_atomically(dir.file("errors-potential.csv"), run_errors_csv(errors, log, &ResultError::potential));
  write_report(dir, scene, prepared);
  if (a.json) {
    fmt::print("{}", json);
  } else {
    print_table(errors, log);
    print_left_out(inputs);
    fmt::print("Errors of every row: {} and {}; bands in {}\n", dir.file("errors.csv"),
               dir.file("errors-potential.csv"), dir.report());
  }
  return 0;
}

}  // namespace ropewalk
