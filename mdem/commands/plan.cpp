// `plan`: a model that a scene needs, and no more; and whether a planned run kept its promise.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "commands/commands.hpp"
#include "io/data_files.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/check.hpp"
#include "plan/planner.hpp"
#include "run/run_directory.hpp"
#include "run/run_time.hpp"
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

void say_time(const char* what, const RunTime& t) {
  const double ns = 1e9 * t.each / t.elements;
  if (t.steps > 0)
    fmt::print(
        "{}: {:.0f} elements, {:.0f} steps, {:.3g} s of processor time "
        "({:.3g} s in steps of {:.0f} ns per element; timed here)\n",
        what, t.elements, t.steps, t.total(), t.steps * t.each, ns);
  else
    fmt::print(
        "{}: {:.0f} elements, {:.3g} s of processor time for 1000 steps of relaxation and {:.3g} s besides, timed "
        "here; how many steps is not known\n",
        what, t.elements, 1000 * t.each, t.outputs);
}

// A model that costs no less than the default serves nobody who needs no more accuracy than that has.
std::string cheaper_text(const Plan& plan, const std::string& path) {
  RunTime planned;
  try {
    planned = time_run(plan.text, path);
  } catch (const NumericalError& e) {  // knobs were tried one by one in the chart, not together
    if (!plan.standard_holds) throw;
    fmt::print("planned: {}\nthe default model is taken: it meets the tolerance\n", e.what());
    return plan.standard_text;
  }
  say_time("planned", planned);
  if (plan.stands_for.empty() || plan.text == plan.standard_text) return plan.text;
  const RunTime standard = time_run(plan.standard_text, path);
  say_time("default model", standard);
  // Of two relaxations one may not be known.
  const bool known = planned.steps > 0 && standard.steps > 0;
  if (!known || !default_serves(plan, planned.total(), standard.total())) return plan.text;
  fmt::print(
      "the default model is taken: it meets the tolerance, and the planned one would save less than a tenth here. "
      "Errors expected:\n");
  for (const auto& [name, error] : plan.standard_expected) fmt::print("  {:16} {:6.2f} %\n", name, 100 * error);
  return plan.standard_text;
}

void say(const Plan& plan, const PlanRequest& request) {
  for (const std::string& line : plan.why) fmt::print("  {}\n", line);
  if (plan.stands_for.empty()) return;
  if (!plan.driven_otherwise.empty()) fmt::print("{}\n", plan.driven_otherwise);
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
    fmt::print("no model of the chart meets {:g} %: this is the most accurate one\n", 100 * request.error);
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
  Scene scene = read_scene(a.scene);
  refuse_cooling(scene, prepare(scene));
  for (const std::string& grade : grades_of(scene)) fmt::print("parameters {}\n", grade);
  const Plan plan = plan_scene(scene, read_chart(a.chart.empty() ? data_directory() + "/chart" : a.chart), request);
  say(plan, request);
  write_file_atomically(path, cheaper_text(plan, path));
  fmt::print("{0} written. Go on with: ropewalk run {0} --out RUN; ropewalk plan --check RUN\n", path);
  return 0;
}

void say_whether_held(const SpotCheck& check, const Expectations& plan) {
  double largest = 0;
  for (const auto& [name, error] : plan.errors)
    if (check.observables.count(name)) largest = std::max(largest, check.observables.at(name).error());
  fmt::print("{:g} % asked for, at most {:.2f} % seen: {}\n", 100 * plan.asked, 100 * largest,
             largest <= plan.asked ? "held" : "not held");
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
  const Expectations plan = expectations_of(scene.text);
  const std::map<std::string, double>& expected = plan.errors;
  const SpotCheck check = spot_check(scene, prepared, simulation.state(), a.stretch);
  fmt::print("{}\n{:16} {:>12} {:>12} {:>9} {:>9}\n", check.how, "", "as planned", "finer", "error", "expected");
  for (const auto& [name, pair] : check.observables) {
    const auto promise = expected.find(name);
    fmt::print("{:16} {:12.6g} {:12.6g} {:7.2f} % {:>9}\n", name, pair.planned, pair.finer, 100 * pair.error(),
               promise == expected.end() ? "-" : fmt::format("{:.2f} %", 100 * promise->second));
  }
  for (const auto& [name, error] : expected)
    if (!check.observables.count(name)) fmt::print("{:16} is not part of this check\n", name);
  if (expected.empty())
    fmt::print("the scene was not planned: nothing was expected\n");
  else
    say_whether_held(check, plan);
  return 0;
}

}  // namespace

int plan_command(const PlanArguments& a) {
  if (!a.check.empty() && !a.scene.empty())
    throw InputError({"", 0, "--check"}, "stands beside a scene", "plan a scene, or check a run");
  return a.check.empty() ? make_plan(a) : check_run(a);
}

}  // namespace ropewalk
