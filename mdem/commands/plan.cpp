// `plan`: a model that a scene needs, and no more.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "campaign/pilot_runs.hpp"
#include "commands/commands.hpp"
#include "commands/plan_words.hpp"
#include "io/files.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/run_directory.hpp"
#include "run/run_time.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// A plan is worth a tenth of the runs that it is for, or 5 s. Where that is not enough to find one, all pilots
// together take a minute of each core.
constexpr double planning_part = 0.1, first_look = 5, least_planning = 60;  // -, s, s

double error_of(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  const bool percent = std::string(end) == "%";
  if (percent) value *= 0.01;
  if (end == text.c_str() || (*end && !percent) || !(value > 0) || !(value <= 1))
    throw InputError({"", 0, "--error"}, fmt::format("is \"{}\"", text), "write 2% or 0.02, up to 100%");
  return value;
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
  double affordable = a.pilot_seconds;
  if (!(affordable > 0)) {
    request.first_look = std::max(first_look, planning_part * a.runs * seconds);
    affordable = std::max(jobs * least_planning, request.first_look);
  }
  Plan plan = plan_scene(scene, request, seconds, affordable, std::ref(runs));
  print_pilots(plan, runs.seconds());
  Expectations promised;
  promised.asked = request.error;
  promised.seconds = seconds_of_run(plan.chosen, plan, path);
  const double by_default =
      plan.chosen.name == plan.standard.name ? promised.seconds : seconds_of_run(plan.standard, plan, path);
  // A smaller pilot may gain where the whole scene does not.
  constexpr double worth = 0.95;
  if (plan.standard.holds && promised.seconds > worth * by_default) {
    plan.chosen = plan.standard;
    promised.seconds = by_default;
  }
  promised.errors = plan.chosen.expect;
  print_choice(plan, request);
  if (promised.seconds > 0)
    fmt::print("processor time promised: {:.3g} s; with the default model {:.3g} s\n", promised.seconds,
               by_default);
  write_file_atomically(path, header_of(plan, request) + expectation_lines(promised) + plan.chosen.text);
  if (!a.finest.empty()) write_file_atomically(a.finest, plan.finest.text);
  fmt::print("{0} written. Go on with: ropewalk run {0} --out RUN; ropewalk plan --check RUN\n", path);
  return 0;
}

}  // namespace

int plan_command(const PlanArguments& a) {
  if (!a.check.empty() && !a.scene.empty())
    throw InputError({"", 0, "--check"}, "stands beside a scene", "plan a scene, or check a run");
  if (a.check.empty() && !a.against.empty())
    throw InputError({"", 0, "--against"}, "stands without --check", "name the planned run with --check");
  if (a.check.empty()) return make_plan(a);
  return check_plan(a);
}

}  // namespace ropewalk
