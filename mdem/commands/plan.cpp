// `plan`: a model that a scene needs, and no more; and whether a planned run kept its promise.
#include <fmt/format.h>
#include <omp.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "commands/colours.hpp"
#include "commands/commands.hpp"
#include "commands/processor_time.hpp"
#include "commands/run_directory.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/check.hpp"
#include "plan/planner.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

double error_of(const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  const bool percent = std::string(end) == "%";
  if (percent) value *= 0.01;
  if (end == text.c_str() || (*end && !percent) || !(value > 0) || !(value <= 1))
    throw InputError({"", 0, "--error"}, fmt::format("is \"{}\"", text), "write 2% or 0.02, up to 100%");
  return value;
}

struct Timing {
  double elements = 0, steps = 0;
  double each = 0;               // processor time of a step, s
  double frames = 0, frame = 0;  // how many, and the processor time of one
  double rows = 0, row = 0;      // of the log, likewise
  double total() const { return steps * each + frames * frame + rows * row; }
};

// From some steps of the scene itself, by one thread: threads that wait for one another spend processor time as
// well.
Timing time_of(Scene scene) {
  constexpr double enough = 0.3;  // s
  constexpr long most = 2000;
  const int threads = omp_get_max_threads();
  use_threads(1);
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  for (int k = 0; k < 5; ++k) s.step(false);
  const double began = processor_seconds();
  long count = 0;
  while (count < most && processor_seconds() - began < enough) {
    for (int k = 0; k < 5; ++k) s.step(false);
    count += 5;
  }
  Timing t;
  t.elements = p.topology.elements();
  t.each = (processor_seconds() - began) / static_cast<double>(count);
  use_threads(threads);
  constexpr double usual_frames = 40, usual_rows = 400;
  t.frames = scene.run.frames_every > 0 ? p.duration / scene.run.frames_every : usual_frames;
  t.rows = scene.run.log_every > 0 ? p.duration / scene.run.log_every : usual_rows;
  const double before_frame = processor_seconds();
  element_colours(p.topology, p.interaction, s.state());
  const double before_row = processor_seconds();
  t.frame = before_row - before_frame;
  look(make_observer(scene, p), scene, p.topology, s.state());
  t.row = processor_seconds() - before_row;
  t.steps = scene.run.mode == RunOptions::Mode::relax ? 0.0 : p.duration / p.time_step;
  return t;
}

void say_time(const char* what, const Timing& t) {
  const double ns = 1e9 * t.each / t.elements;
  if (t.steps > 0)
    fmt::print(
        "{}: {:.0f} elements, {:.0f} steps, {:.3g} s of processor time with log and frames ({:.0f} ns per "
        "element-step, "
        "timed here)\n",
        what, t.elements, t.steps, t.total(), ns);
  else
    fmt::print("{}: {:.0f} elements, {:.3g} s of processor time in 1000 steps of relaxation, timed here\n", what,
               t.elements, 1000 * t.each);
}

void say(const Plan& plan, const PlanRequest& request) {
  for (const std::string& line : plan.why) fmt::print("  {}\n", line);
  if (plan.stands_for.empty()) return;
  fmt::print("scene {} of the chart stands for this one; {} expected:\n", plan.stands_for,
             request.observables.empty() ? "errors" : "errors asked for,");
  for (const auto& [name, error] : plan.expected) {
    const auto atoms = plan.atoms.find(name);
    fmt::print("  {:16} {:6.2f} %{}\n", name, 100 * error,
               atoms == plan.atoms.end()
                   ? ""
                   : fmt::format("   (the default model against atoms: {:.2f} %)", 100 * atoms->second));
  }
  if (!plan.holds)
    fmt::print("no model of the chart holds {:g} %: this is the most accurate one for it\n", 100 * request.error);
  fmt::print("chart: {:.2f} of the default model's time, {:.0f} ns per element-step\n", plan.cost,
             plan.ns_per_element_step);
}

std::string out_path(const PlanArguments& a) {
  if (!a.out.empty()) return a.out;
  const fs::path scene(a.scene);
  return (scene.parent_path() / (scene.stem().string() + "-planned.toml")).string();
}

int make_plan(const PlanArguments& a) {
  if (a.scene.empty()) throw InputError({"", 0, "scene"}, "is missing", "name a scene file, or a run with --check");
  PlanRequest request;
  request.error = error_of(a.error);
  request.observables = a.observables;
  request.end_state = a.end_state;
  const std::string path = out_path(a);
  if (fs::exists(path)) throw InputError({path, 0, "-o"}, "exists", "choose another name with -o");
  const Scene scene = read_scene(a.scene);
  const Plan plan = plan_scene(scene, read_chart(a.chart.empty() ? data_directory() + "/chart" : a.chart), request);
  const Scene planned = scene_of_text(plan.text, path);
  say(plan, request);
  say_time("scene as it stands", time_of(scene));
  say_time("planned", time_of(planned));
  write_file_atomically(path, plan.text);
  fmt::print("{0} written. Go on with: ropewalk run {0} --out RUN; ropewalk plan --check RUN\n", path);
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
  const std::map<std::string, double> expected = expectations_of(scene.text);
  const SpotCheck check = spot_check(scene, prepared, simulation.state(), a.stretch);
  fmt::print("{}\n{:16} {:>12} {:>12} {:>9} {:>9}\n", check.how, "", "as planned", "finer", "error", "expected");
  for (const auto& [name, pair] : check.observables) {
    const auto promise = expected.find(name);
    fmt::print("{:16} {:12.6g} {:12.6g} {:7.2f} % {:>9}\n", name, pair.planned, pair.finer, 100 * pair.error(),
               promise == expected.end() ? "-" : fmt::format("{:.2f} %", 100 * promise->second));
  }
  for (const auto& [name, error] : expected)
    if (!check.observables.count(name)) fmt::print("{:16} is not part of this check\n", name);
  if (expected.empty()) fmt::print("the scene was not planned: nothing was expected\n");
  return 0;
}

}  // namespace

int plan_command(const PlanArguments& a) {
  if (!a.check.empty() && !a.scene.empty())
    throw InputError({"", 0, "--check"}, "stands beside a scene", "plan a scene, or check a run");
  return a.check.empty() ? make_plan(a) : check_run(a);
}

}  // namespace ropewalk
