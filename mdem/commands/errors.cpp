// `errors`: how the standard errors of a scene's inputs carry through a run.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <utility>

#include "campaign/error_runs.hpp"
#include "campaign/numeric_runs.hpp"
#include "campaign/repeated_run.hpp"
#include "commands/verb.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "report/runs_page.hpp"
#include "run/directory_lock.hpp"
#include "run/results.hpp"
#include "run/tell.hpp"
#include "scene/missing_forces.hpp"

namespace ropewalk {
namespace {

struct ErrorsArguments {
  std::string dir;
  bool numerics = false;  // with elements, time step, rate and other starts
  double mean_ps = 0;     // numerics: of means over so much time; 0: of the last row
  int jobs = 0;           // runs at a time; 0: one for each core
  bool again = false;
  bool json = false;
  bool quiet = false;
};

// No digit of a value beyond two of the error of its fit, or of what it still moves by.
std::string value_text(double value, double error) {
  if (!(error > 0)) return fmt::format("{:.6g}", value);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(error)));
  const double unit = std::pow(10.0, decimals);
  return decimals > 0 ? fmt::format("{:.{}f}", value, std::min(decimals, 9))
                      : fmt::format("{:.0f}", std::round(value * unit) / unit);
}

// Errors of what came of the run, by name.
template <class Error>
using NamedErrors = std::vector<std::pair<std::string, Error>>;

// The share of each input in the error of a result: "GJ 80 %, EA 12 %".
std::string shares_words(const ResultError& e, const RunErrors& errors) {
  double sum = 0;
  for (const double part : e.parts) sum += part * part;
  std::vector<std::pair<double, std::string>> shares;
  for (std::size_t i = 0; i < e.parts.size(); ++i)
    shares.emplace_back(e.parts[i] * e.parts[i] / sum, errors.sources()[i].name);
  std::sort(shares.rbegin(), shares.rend());
  std::string from;
  for (const auto& [share, name] : shares)
    if (share > 0.05) from += fmt::format("{}{} {:.0f} %", from.empty() ? "" : ", ", name, 100 * share);
  return from + (e.linear ? "" : "; not linear: an estimate of its size only");
}

void print_table(const RunErrors& errors, const NamedErrors<ResultError>& results, const std::vector<LogRow>& log) {
  fmt::print("These errors follow from the parameters alone, not from time step, elements, rate of loading or noise.\n");
  const auto head = [](const char* what, const char* moves) {
    fmt::print("{:<26} {:>14} {:>10} {:>11} {:>9}   {}\n", what, "value", "± inputs", "± potential", moves,
               "the inputs' from");
  };
  if (!results.empty()) head("of the run", "");
  for (const auto& [name, e] : results)
    if (!std::isfinite(e.error))
      fmt::print("{:<26} {:>14} not known: a repeated run has no such value\n", name, value_text(e.value, 0));
    else
      fmt::print("{:<26} {:>14} {:>10.2g} {:>11.2g} {:>9}   {}\n", name, value_text(e.value, e.error), e.error,
                 e.potential, "", shares_words(e, errors));
  head("at the end", "moves by");
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
    const double moves = movement(log, value);
    fmt::print("{:<26} {:>14} {:>10.2g} {:>11.2g} {:>9.2g}   {}\n", o.name,
               value_text(e.value, std::max(e.error, moves)), e.error, e.potential, moves, shares_words(e, errors));
  }
  if (!none.empty()) fmt::print("No influence beyond rounding on {}.\n", none);
}

// The advice that halves the error of results whose largest error comes from this source.
std::string remedy_of(const std::string& source, const NumericErrors& whole, const RunErrors& parameters) {
  for (const NumericSource& s : whole.runs().sources)
    if (s.name == source) return s.remedy;
  if (source == "statistics")
    return whole.runs().mean_ps > 0 ? "a mean over four times as long (--mean and run.duration_ps)"
                                    : "the mean of four runs from other starts (replicates = 4 in a sweep)";
  if (source == "potential") return "nothing in this model: interatomic potentials of carbon differ by so much";
  for (const ErrorSource& s : parameters.sources())
    if (s.name == source)
      return fmt::format("a value of {} with less than half of its standard error of {:.2g} %", source,
                         100 * s.sigma);
  return "";
}

// Results without an error beyond rounding are left out.
void print_whole_errors(const NumericErrors& whole, const NamedErrors<WholeError>& results,
                        const RunErrors& parameters, const std::vector<LogRow>& log) {
  constexpr double rounding = 1e-9, noise = 1e-5;  // relative to the largest value and to 1 in its unit
  const double mean_ps = whole.runs().mean_ps;
  const auto head = [](const std::string& what) {
    fmt::print("{:<26} {:>14} {:>12} {:>11} {:>12} {:>11}   {}\n", what, "value", "± statistics", "± numerics",
               "± parameters", "± potential", "decided by");
  };
  std::map<std::string, std::vector<std::string>> deciders;
  std::string too_short;
  double needed = 0;
  const auto line = [&](const std::string& name, const WholeError& e) {
    if (e.without > 0)
      return fmt::print("{:<26} {:>14} not known: {} of the repeated runs have no such value\n", name,
                        value_text(e.value, 0), e.without);
    deciders[e.decides].push_back(name);
    fmt::print(
        "{:<26} {:>14} {:>12.2g} {:>11} {:>12.2g} {:>11.2g}   {}\n", name, value_text(e.value, e.total()),
        e.statistics, fmt::format("{}{:.2g}", e.bound ? "≤ " : "", e.numerics), e.parameters, e.potential,
        e.decides +
            (std::isfinite(e.correlation_ps) ? fmt::format("; correlated over {:.2g} ps", e.correlation_ps) : ""));
    if (!std::isfinite(e.needed_ps)) return;
    too_short += (too_short.empty() ? "" : ", ") + name;
    needed = std::max(needed, e.needed_ps);
  };
  if (!results.empty()) head("of the run");
  for (const auto& [name, e] : results) line(name, e);
  head(mean_ps > 0 ? fmt::format("mean of the last {:.4g} ps", mean_ps) : "at the end");
  for (std::size_t k = 0; k < observables().size(); ++k) {
    const Observable& o = observables()[k];
    if (o.group == ObservableGroup::time || o.name == "time_step_fs") continue;
    const WholeError e = whole.at_end([k](const LogRow& row) { return row.values()[k]; });
    double largest = 1;
    for (const LogRow& row : log)
      if (const double v = row.values()[k]; std::isfinite(v)) largest = std::max(largest, std::fabs(v));
    const bool zero = std::fabs(e.value) <= e.total() && e.total() <= noise * largest;
    if (std::isfinite(e.value) && e.total() > rounding * largest && !zero) line(o.name, e);
  }
  for (const auto& [source, names] : deciders)
    if (!source.empty())
      fmt::print("{} decide{} {} of them. What would halve it: {}.\n", source, source.back() == 's' ? "" : "s",
                 names.size(), remedy_of(source, whole, parameters));
  for (const NumericSource& s : whole.runs().sources) fmt::print("{}: {}.\n", s.name, s.change);
  if (!whole.runs().starts.empty())
    fmt::print("statistics: scatter of this run and {} from other starts.\n", whole.runs().starts.size());
  if (!too_short.empty())
    fmt::print("The mean is over too short a time to estimate its own error (about {:.2g} ps would do): {}.\n",
               needed, too_short);
  for (const std::string& why : whole.runs().remarks) fmt::print("{}.\n", why);
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

void print_left_out(const ErrorInputs& inputs) {
  if (!inputs.without_error.empty())
    fmt::print(
        "Taken as exact, since no error is stated: {}.\nIn the tables of a scene it is stated as in {{ value = "
        "0.16, standard_error = 0.02 }}.\n",
        joined(inputs.without_error));
  if (!inputs.not_varied.empty()) fmt::print("Not varied: {}.\n", joined(inputs.not_varied));
}

// Runs side by side; throws where one of them does not finish.
class Repeats {
 public:
  Repeats(int jobs, bool quiet) : jobs_(jobs), quiet_(quiet) {}

  void add(const std::string& name, double cost, std::function<int()> run) {
    cost_ += cost;
    tasks_.push_back({name, std::move(run)});
  }
  // `one`: processor time of the run that is repeated, s.
  void say_cost(double one) const {
    tell_as_is(fmt::format("{} runs, which cost as much as {:.2g} like this one: about {:.2g} min on {} cores\n",
                           tasks_.size(), cost_, cost_ * one / jobs_ / 60, jobs_));
  }
  void go() {
    std::vector<ProcessTask> processes;
    std::vector<std::string> failed;
    std::size_t number = 0;
    for (const auto& [task_name, run] : tasks_) {
      const std::string name = task_name;
      processes.push_back({[&, name, run = run, number = ++number] {
                             if (!quiet_) tell_as_is(fmt::format("{}/{} {}\n", number, tasks_.size(), name));
                             try {
                               if (!std::freopen("/dev/null", "w", stdout)) return 3;
                               return run();
                             } catch (const std::exception& e) {
                               return report_error(fmt::format("ropewalk errors: {}", name).c_str(), e);
                             }
                           },
                           [&failed, name](int status) {
                             if (status != 0)
                               failed.push_back(WIFEXITED(status) ? name : name + ": " + death_words(status));
                           }});
    }
    run_processes(processes, jobs_);
    if (!failed.empty())
      throw std::runtime_error(fmt::format(
          "{} of {} runs did not finish ({}): a run that fails by itself is too sensitive for an error to be "
          "given; else give the same command again, which keeps those that are finished",
          failed.size(), tasks_.size(), failed.front()));
  }

 private:
  int jobs_;
  bool quiet_;
  double cost_ = 0;
  std::vector<std::pair<std::string, std::function<int()>>> tasks_;
};

// The run whose errors are asked for.
struct FinishedRun {
  RunDirectory dir;
  Scene scene;
  Prepared prepared;
  Manifest manifest;
  std::vector<LogRow> log;

  explicit FinishedRun(const std::string& path)
      : dir{path}, scene(read_run_scene(dir)), prepared(prepare(scene)), manifest(read_manifest(dir.manifest())) {
    refuse_missing_forces(scene.missing_forces, dir.path);
    if (manifest.status == "taken from atoms")
      throw InputError({dir.path, 0, ""}, "was not run: its elements were taken from atoms",
                       "run a scene that begins with its final.csv");
    if (manifest.status != "finished")
      throw InputError({dir.path, 0, ""}, fmt::format("is a run that is {}", manifest.status),
                       "end it with `ropewalk resume`, or run the scene anew");
    log = read_log(dir.log());
    if (log.empty()) throw InputError({dir.log(), 0, ""}, "has no rows", "run the scene anew");
  }
};

double size_of(const ResultError& e) { return e.error + e.potential; }
double size_of(const WholeError& e) { return e.total(); }

// Errors of the results that the run has and that another run may change. Where a repeated run has no such result,
// the error is not finite.
template <class Error>
NamedErrors<Error> errors_of_results(const FinishedRun& run,
                                     const std::function<Error(const RunErrors::ResultOfRun&, bool is_time)>& of) {
  const RepeatedValues values = repeated_results(run.dir);
  const std::vector<OutputColumn> columns = result_columns();
  NamedErrors<Error> out;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (const Error e = of(values.of(k), std::string(columns[k].unit) == "ps"); std::isfinite(e.value) && size_of(e) != 0)
      out.emplace_back(columns[k].name, e);
  return out;
}

// Writes the errors of the results that follow from the errors of the inputs.
RunErrors write_input_errors(const FinishedRun& run, const ErrorInputs& inputs, NamedErrors<ResultError>& results,
                             std::string& json) {
  const std::string directory = run.dir.path + "/errors";
  std::vector<ErrorSource> sources;
  for (const VariedNumber& s : inputs.varied) sources.push_back(s.error);
  RunErrors errors(directory, sources, correlation_of(inputs.varied, run.scene), run.log);
  results = errors_of_results<ResultError>(
      run, [&](const RunErrors::ResultOfRun& result, bool) { return errors.of_runs(result); });
  json = run_errors_json(errors, run.log, results, inputs.without_error, inputs.not_varied);
  write_file_atomically(directory + "/errors.json", json);
  write_file_atomically(run.dir.file("errors.csv"), run_errors_csv(errors, run.log, &ResultError::error));
  write_file_atomically(run.dir.file("errors-potential.csv"),
                        run_errors_csv(errors, run.log, &ResultError::potential));
  return errors;
}

NumericErrors write_numeric_errors(const FinishedRun& run, NumericRuns what, RunErrors parameters,
                                   NamedErrors<WholeError>& results, std::string& json) {
  const std::string directory = run.dir.path + "/errors";
  const NumericErrors errors(directory, std::move(what), std::move(parameters), run.log);
  results = errors_of_results<WholeError>(run, [&](const RunErrors::ResultOfRun& result, bool is_time) {
    return errors.of_runs(result, is_time);
  });
  json = numeric_errors_json(errors, run.log, results);
  write_file_atomically(directory + "/numerics.json", json);
  write_file_atomically(run.dir.file("errors-numerics.csv"),
                        whole_errors_csv(errors, run.log, [](const WholeError& e) { return e.numerics; }));
  write_file_atomically(run.dir.file("errors-statistics.csv"),
                        whole_errors_csv(errors, run.log, [](const WholeError& e) { return e.statistics; }));
  return errors;
}

int errors_command(const ErrorsArguments& a) {
  const FinishedRun run(a.dir);
  const DirectoryLock lock(run.dir.path);  // two at a time would each refuse the runs of the other
  const int tubes = run.prepared.topology.tubes();
  const ErrorInputs inputs = a.numerics ? inputs_with_errors(run.scene, tubes) : error_inputs(run.scene, tubes);
  NumericPlan plan;
  if (a.numerics) plan = numeric_plan(run.dir, run.scene, run.prepared, run.log);
  plan.what.mean_ps = a.mean_ps;
  if (a.mean_ps > 0) refuse_mean_over(a.mean_ps, {run.log}, run.dir.log());
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  Repeats repeats(jobs, a.quiet);
  const ErrorRuns runs(run.dir, run.scene, run.prepared, a.again);
  for (const VariedNumber& source : inputs.varied)
    for (const bool plus : {true, false})
      if (const std::string& name = plus ? source.error.plus : source.error.minus; !name.empty())
        repeats.add(name, 1, [&runs, &source, plus] { return runs.run(source, plus); });
  const RunInputs as_it_was = inputs_of(run.dir, run.scene, run.prepared);
  for (const NumericRun& r : plan.runs)
    repeats.add(r.words, r.cost, [&run, &a, &as_it_was, &r] {
      RunInputs changed = as_it_was;
      changed.scene = r.scene;
      if (changed.until_ps > 0) changed.until_ps *= r.times;
      return repeat_run(run.dir, run.scene, r.folder, changed, a.again);
    });
  if (!a.quiet) repeats.say_cost(run.manifest.wall_seconds * run.manifest.threads);
  repeats.go();
  std::string json;
  RunErrors errors;
  NamedErrors<ResultError> by_inputs;
  if (!inputs.varied.empty()) errors = write_input_errors(run, inputs, by_inputs, json);
  if (a.numerics) {
    NamedErrors<WholeError> results;
    const NumericErrors whole = write_numeric_errors(run, plan.what, errors, results, json);
    if (!a.json) print_whole_errors(whole, results, errors, run.log);
  } else if (!a.json) {
    print_table(errors, by_inputs, run.log);
  }
  write_report(run.dir, run.scene, run.prepared);
  if (a.json) {
    fmt::print("{}", json);
    return 0;
  }
  print_left_out(inputs);
  std::string files = run.dir.file("errors.csv") + ", " + run.dir.file("errors-potential.csv");
  if (errors.empty()) files.clear();
  if (a.numerics)
    files += fmt::format("{}{}, {}", files.empty() ? "" : ", ", run.dir.file("errors-numerics.csv"),
                         run.dir.file("errors-statistics.csv"));
  fmt::print("Errors of every row: {}; bands in {}\n", files, run.dir.report());
  return 0;
}

// Threads of each of so many runs at a time; 0 runs: one for each core.
int threads_beside(int jobs) { return jobs > 0 ? std::max(1, omp_get_num_procs() / jobs) : 1; }

}  // namespace

void add_errors(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ErrorsArguments>();
  CLI::App* c = app.add_subcommand("errors",
                                   "Error bars of a finished run, from the standard errors of its parameter sets, "
                                   "friction files and scene numbers; it "
                                   "repeats the run");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  CLI::Option* numerics = c->add_flag("--numerics", a->numerics,
                                      "Add the numerical errors: repeat the run with half the element length, half "
                                      "the time step and half the rate, and "
                                      "from other random starts");
  c->add_option("--mean", a->mean_ps, "Errors of means over the last so many ps instead of the last row")
      ->check(number_within(Bounds::positive()))
      ->needs(numerics);
  c->add_option("-j,--jobs", a->jobs, "Runs at a time [default: one for each core]")->check(whole_number(1));
  c->add_flag("--again", a->again, "Repeat finished runs as well");
  c->add_flag("--json", a->json, "JSON");
  c->add_flag("--quiet", a->quiet, "No progress lines");
  c->callback([a, &program] {
    wait_briefly(program.argv, threads_beside(a->jobs));
    program.code = errors_command(*a);
  });
}

}  // namespace ropewalk
