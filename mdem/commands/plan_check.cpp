// `plan --check`: whether a planned run kept its promise.
#include "run/plan_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands/commands.hpp"
#include "plan/planner.hpp"

namespace ropewalk {
namespace {

void print_check(const PlanCheck& check, const Expectations& plan) {
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

void print_time(const RunDirectory& dir, const Expectations& plan) {
  if (plan.seconds <= 0) return;
  const Manifest m = read_manifest(dir.manifest());
  fmt::print("{:.3g} s of processor time promised; the run took {:.3g} s on {} thread{}\n", plan.seconds,
             m.wall_seconds, m.threads, m.threads == 1 ? "" : "s");
}

}  // namespace

int check_plan(const PlanArguments& a) {
  const RunDirectory dir{a.check};
  Scene scene = read_run_scene(dir);
  const PlanCheck check =
      a.against.empty() ? checked_by_stretch(dir, a.stretch) : checked_against(dir, {a.against});
  const Expectations plan = expectations_of(scene.text);
  print_check(check, plan);
  print_time(dir, plan);
  if (plan.errors.empty()) return 0;
  write_plan_check(dir, check);
  const Prepared prepared = prepare(scene);
  write_report(dir, scene, prepared);
  return 0;
}

}  // namespace ropewalk
