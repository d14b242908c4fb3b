// `errors`: how the standard errors of the parameter sets carry through a run.
#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "campaign/error_runs.hpp"
#include "commands/commands.hpp"
#include "io/failure.hpp"
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
      "at the end", "value", "± fit", "± potential", "moves by", "the fit's from");
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
  const std::vector<VariedNumber> sources = varied_numbers(scene, prepared.topology.tubes());
  const ErrorRuns runs(dir, scene, prepared.time_step, a.again);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  std::vector<ProcessTask> tasks;
  std::vector<std::string> failed;
  std::size_t number = 0;
  if (!a.quiet)
    tell_as_is(fmt::format(
        "{} runs like this one, about {:.2g} min on {} cores\n", 2 * sources.size(),
        2 * static_cast<double>(sources.size()) * manifest.wall_seconds * manifest.threads / jobs / 60, jobs));
  for (const VariedNumber& source : sources)
    for (const bool plus : {true, false}) {
      ++number;
      const std::string name = plus ? source.error.plus : source.error.minus;
      tasks.push_back({[&, plus, number, name] {
                         if (!a.quiet) tell_as_is(fmt::format("{}/{} {}\n", number, 2 * sources.size(), name));
                         try {
                           if (!std::freopen("/dev/null", "w", stdout)) return 3;
                           return runs.run(source, plus);
                         } catch (const std::exception& e) {
                           return tell_failure(fmt::format("ropewalk errors: {}", name).c_str(), e);
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
  write_file_atomically(dir.path + "/errors/errors.json", run_errors_json(errors, log));
  write_file_atomically(dir.file("errors.csv"), run_errors_csv(errors, log, &ResultError::error));
  write_file_atomically(dir.file("errors-potential.csv"), run_errors_csv(errors, log, &ResultError::potential));
  write_report(dir, scene, prepared);
  if (a.json) {
    fmt::print("{}", run_errors_json(errors, log));
  } else {
    print_table(errors, log);
    fmt::print("Errors of every row: {} and {}; bands in {}\n", dir.file("errors.csv"),
               dir.file("errors-potential.csv"), dir.report());
  }
  return 0;
}

}  // namespace ropewalk
