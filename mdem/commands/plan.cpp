// `plan`: a model that a scene needs, and no more; and whether a planned run kept its promise.
#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "commands/commands.hpp"
#include "commands/point_runs.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "plan/check.hpp"
#include "plan/outcome.hpp"
#include "plan/planner.hpp"
#include "run/plan_check.hpp"
#include "run/processor_time.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_time.hpp"
#include "run/tell.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Processor time for all pilots together, unless the user gives one: the larger of a tenth of the run's and a
// minute of each core.
constexpr double planning_part = 0.1, least_planning = 60;

double error_of(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  const bool percent = std::string(end) == "%";
  if (percent) value *= 0.01;
  if (end == text.c_str() || (*end && !percent) || !(value > 0) || !(value <= 1))
    throw InputError({"", 0, "--error"}, fmt::format("is \"{}\"", text), "write 2% or 0.02, up to 100%");
  return value;
}

// Runs pilots side by side, each in a process of its own with one thread.
class PilotRuns {
 public:
  PilotRuns(std::string scene_path, int jobs)
      : path_(std::move(scene_path)),
        jobs_(jobs),
        folder_((fs::temp_directory_path() / fmt::format("ropewalk-plan-{}", getpid())).string()) {
    fs::create_directories(folder_);
  }
  PilotRuns(const PilotRuns&) = delete;
  ~PilotRuns() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

  std::vector<PilotEnd> operator()(const std::vector<PilotTask>& tasks) {
    std::vector<PilotEnd> ends(tasks.size());
    std::vector<ProcessTask> processes;
    for (std::size_t k = 0; k < tasks.size(); ++k) {
      const std::string run = fmt::format("{}/{}", folder_, count_++);
      processes.push_back({[this, run, &task = tasks[k]] { return work(run, task); },
                           [this, run, &task = tasks[k], &end = ends[k]](int status) {
                             end = read(run, status);
                             seconds_ += end.seconds;
                             if (isatty(STDERR_FILENO)) tell_as_is(fmt::format("\r\033[Kpilot: {}", task.name));
                           }});
    }
    run_processes(processes, jobs_, &stop_signal);
    if (isatty(STDERR_FILENO)) tell_as_is("\r\033[K");
    if (stop_signal)
      throw InputError({path_, 0, ""}, "planning was stopped by a signal", "nothing was written; start it again");
    return ends;
  }
  double seconds() const { return seconds_; }

 private:
  int work(const std::string& run, const PilotTask& task) const {
    return in_a_process(run + ".txt", false, [&] {
      const int code = run_or_resume({run}, scene_of_text(task.text, path_), task.until, "warn");
      write_file_atomically(run + ".seconds", fmt::format("{:.6g}", processor_seconds()));
      return code;
    });
  }

  // What a failed run said last, without the place of its files, which are gone.
  static std::string last_line(std::string said) {
    while (!said.empty() && said.back() == '\n') said.pop_back();
    const std::size_t begin = said.find_last_of('\n');
    if (begin != std::string::npos) said.erase(0, begin + 1);
    const std::string name = "ropewalk: ";
    if (said.rfind(name, 0) == 0) said.erase(0, name.size());
    return said.substr(0, said.find(". State written to"));
  }

  static PilotEnd read(const std::string& run, int status) {
    PilotEnd end;
    constexpr int not_at_rest = 4;
    if (!WIFEXITED(status)) {
      end.failure = death_words(status);
    } else if (WEXITSTATUS(status) != 0 && WEXITSTATUS(status) != not_at_rest) {
      const std::string said = read_file(run + ".txt");
      end.failure = last_line(said);
    } else {
      end.seconds = std::strtod(read_file(run + ".seconds").c_str(), nullptr);
      end.log = read_log(RunDirectory{run}.log());
    }
    return end;
  }

  std::string path_;
  int jobs_;
  std::string folder_;
  int count_ = 0;
  double seconds_ = 0;
};

void say_models(const Plan& plan) {
  std::vector<std::string> columns;
  for (const auto& [name, error] : plan.standard.error) columns.push_back(name);
  fmt::print("{:<58} {:>7}", "model", "time");
  for (const std::string& name : columns) fmt::print(" {:>{}}", name, std::max<std::size_t>(9, name.size()));
  fmt::print("\n");
  const auto line = [&](const PlannedModel& m, const std::map<std::string, double>& errors) {
    fmt::print("{:<58} {:>7.2f}", m.name.substr(0, 58), m.seconds / plan.standard.seconds);
    for (const std::string& name : columns) {
      const auto at = errors.find(name);
      fmt::print(" {:>{}}", at == errors.end() ? "-" : fmt::format("{:.2f} %", 100 * at->second),
                 std::max<std::size_t>(9, name.size()));
    }
    fmt::print("{}\n", m.failure.empty() ? (m.holds ? "  holds" : "") : "  failed: " + m.failure);
  };
  line(plan.finest, {});
  line(plan.standard, plan.standard.error);
  for (const PlannedModel& m : plan.tried) line(m, m.error);
}

void say_pilots(const Plan& plan, const PilotRuns& runs) {
  fmt::print("pilots: {}, {:.3g} s of processor time in all; differences from the finest model\n",
             plan.pilots.empty() ? "the whole scene" : plan.pilots, runs.seconds());
  say_models(plan);
  if (!plan.scatter.empty()) {
    fmt::print("{:<58} {:>7}", "by chance, one standard deviation", "");
    for (const auto& [name, error] : plan.standard.error) {
      const auto at = plan.scatter.find(name);
      fmt::print(" {:>{}}", at == plan.scatter.end() ? "-" : fmt::format("{:.2f} %", 100 * at->second),
                 std::max<std::size_t>(9, name.size()));
    }
    fmt::print("\n");
  }
  for (const std::string& remark : plan.remarks) fmt::print("{}\n", remark);
}

void say_choice(const Plan& plan, const PlanRequest& request) {
  fmt::print("planned for {:g} %: {}. Errors promised:\n", 100 * request.error, plan.chosen.name);
  for (const auto& [name, error] : plan.chosen.expect) fmt::print("  {:20} {:6.2f} %\n", name, 100 * error);
  for (const std::string& line : plan.chosen.why) fmt::print("  {}\n", line);
}

// Processor time of the whole run: that of the pilot where it was one. Else the steps of the whole take as long as
// those of the pilot, but for the ratio of the two at their starts. 0: not known.
double time_of(const PlannedModel& m, const Plan& plan, const std::string& path) {
  if (plan.pilots.empty()) return m.seconds;
  const RunTime whole = time_run(m.text, path), pilot = time_run(m.pilot_text, path);
  if (whole.steps <= 0 || pilot.steps <= 0) return 0;
  Scene scene = scene_of_text(m.pilot_text, path);
  const double part = plan.until >= 0 ? plan.until / prepare(scene).duration : 1;
  const double least = 0.2 * pilot.each;
  const double each = std::max(least, (m.seconds - pilot.outputs) / (part * pilot.steps));
  return whole.outputs + whole.steps * each * whole.at_start / pilot.at_start;
}

std::string out_path(const PlanArguments& a) {
  if (!a.out.empty()) return a.out;
  const fs::path scene(a.scene);
  return (scene.parent_path() / (scene.stem().string() + "-planned.toml")).string();
}

std::string header_of(const Plan& plan, const PlanRequest& request) {
  return fmt::format("# Planned for an error of {:g} % by pilots of {}: {}.\n", 100 * request.error,
                     plan.pilots.empty() ? "the whole scene" : plan.pilots, plan.chosen.name);
}

int make_plan(const PlanArguments& a) {
  if (a.scene.empty()) throw InputError({"", 0, "scene"}, "is missing", "name a scene file, or a run with --check");
  PlanRequest request;
  request.error = error_of(a.error);
  request.observables = a.observables;
  request.end_state = a.end_state;
  const std::string path = out_path(a);
  if (fs::exists(path)) throw InputError({path, 0, "-o"}, "exists", "choose another name with -o");
  if (!a.finest.empty()) refuse_existing(a.finest, "--finest", false);
  Scene scene = read_scene(a.scene);
  refuse_cooling(scene, prepare(scene));
  for (const std::string& grade : grades_of(scene)) fmt::print("parameters {}\n", grade);
  listen_to_stop_signals();
  const RunTime standard = time_run(default_text(scene), path);
  constexpr double guessed_steps = 5000;  // of a relaxation
  const double seconds = standard.steps > 0 ? standard.total() : standard.outputs + guessed_steps * standard.each;
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  PilotRuns runs(scene.path, jobs);
  const double affordable =
      a.pilot_seconds > 0 ? a.pilot_seconds : std::max(jobs * least_planning, planning_part * seconds);
  Plan plan = plan_scene(scene, request, seconds, affordable, std::ref(runs));
  say_pilots(plan, runs);
  Expectations promised;
  promised.asked = request.error;
  promised.seconds = time_of(plan.chosen, plan, path);
  const double by_default =
      plan.chosen.name == plan.standard.name ? promised.seconds : time_of(plan.standard, plan, path);
  // A smaller pilot may gain where the whole scene does not.
  constexpr double worth = 0.95;
  if (plan.standard.holds && promised.seconds > worth * by_default) {
    plan.chosen = plan.standard;
    promised.seconds = by_default;
  }
  promised.errors = plan.chosen.expect;
  say_choice(plan, request);
  if (promised.seconds > 0)
    fmt::print("processor time promised: {:.3g} s; with the default model {:.3g} s\n", promised.seconds,
               by_default);
  write_file_atomically(path, header_of(plan, request) + expectation_lines(promised) + plan.chosen.text);
  if (!a.finest.empty()) write_file_atomically(a.finest, plan.finest.text);
  fmt::print("{0} written. Go on with: ropewalk run {0} --out RUN; ropewalk plan --check RUN\n", path);
  return 0;
}

void say_check(const PlanCheck& check, const Expectations& plan) {
  fmt::print("{}\n{:20} {:>12} {:>12} {:>10} {:>10}\n", check.against, "", "as planned", "finer", "error",
             "promised");
  double largest = 0;
  bool held = true;
  for (const auto& [name, c] : check.found) {
    const auto promise = plan.errors.find(name);
    const bool promised = promise != plan.errors.end();
    fmt::print("{:20} {:12.6g} {:12.6g} {:8.2f} % {:>10}\n", name, c.planned, c.finer, 100 * c.error,
               promised ? fmt::format("{:.2f} %", 100 * promise->second) : "-");
    if (!promised) continue;
    largest = std::max(largest, c.error);
    held = held && c.error <= std::max(promise->second, plan.asked);
  }
  for (const auto& [name, error] : plan.errors)
    if (!check.found.count(name)) fmt::print("{:20} is not part of this check\n", name);
  if (plan.errors.empty())
    fmt::print("the scene was not planned: nothing was promised\n");
  else
    fmt::print("{:g} % asked for, at most {:.2f} % seen: {}\n", 100 * plan.asked, 100 * largest,
               held ? "held" : "not held");
}

void say_time(const RunDirectory& dir, const Expectations& plan) {
  if (plan.seconds <= 0) return;
  const Manifest m = read_manifest(dir.manifest());
  fmt::print("{:.3g} s of processor time promised; the run took {:.3g} s on {} thread{}\n", plan.seconds,
             m.wall_seconds, m.threads, m.threads == 1 ? "" : "s");
}

// On the terminal, in the run's directory and in its report.
void tell_check(const RunDirectory& dir, Scene scene, const PlanCheck& check) {
  const Expectations plan = expectations_of(scene.text);
  say_check(check, plan);
  say_time(dir, plan);
  if (plan.errors.empty()) return;
  write_plan_check(dir, check);
  const Prepared prepared = prepare(scene);
  write_report(dir, scene, prepared);
}

// The logs of two runs of one scene.
int check_against(const PlanArguments& a) {
  const RunDirectory dir{a.check}, other{a.against};
  const Scene scene = read_run_scene(dir), finer = read_run_scene(other);
  const Expectations plan = expectations_of(scene.text);
  std::vector<std::string> names;
  for (const auto& [name, error] : plan.errors) names.push_back(name);
  if (names.empty()) names = usual_observables();
  const auto outcome = [&](const RunDirectory& run, const Scene& s) {
    const std::vector<LogRow> log = read_log(run.log());
    if (log.empty()) throw InputError({run.log(), 0, ""}, "has no rows", "run the scene first");
    return outcome_of(log, names, s.run.mode == RunOptions::Mode::relax);
  };
  const Outcome planned = outcome(dir, scene), reference = outcome(other, finer);
  PlanCheck check{"the end of another run, means over the last quarter", {}};
  for (const auto& [name, error] : differences(planned, reference))
    check.found[name] = {planned.of.at(name).value, reference.of.at(name).value, error};
  tell_check(dir, scene, check);
  return 0;
}

int check_run(const PlanArguments& a) {
  const RunDirectory dir{a.check};
  Scene scene = read_run_scene(dir);
  const RunCheckpoint checkpoint = read_checkpoint(dir);
  const Prepared prepared = prepare(scene);
  Simulation simulation = start(scene, prepared);
  try {
    simulation.restore(checkpoint.simulation);
  } catch (const std::runtime_error& e) {
    throw InputError({dir.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  const SpotCheck spot = spot_check(scene, prepared, simulation.state(), a.stretch);
  PlanCheck check{spot.how, {}};
  for (const auto& [name, pair] : spot.observables) check.found[name] = {pair.planned, pair.finer, pair.error()};
  tell_check(dir, scene, check);
  return 0;
}

}  // namespace

int plan_command(const PlanArguments& a) {
  if (!a.check.empty() && !a.scene.empty())
    throw InputError({"", 0, "--check"}, "stands beside a scene", "plan a scene, or check a run");
  if (a.check.empty() && !a.against.empty())
    throw InputError({"", 0, "--against"}, "stands without --check", "name the planned run with --check");
  if (a.check.empty()) return make_plan(a);
  return a.against.empty() ? check_run(a) : check_against(a);
}

}  // namespace ropewalk
