#include "run/plan_check.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "plan/spot_check.hpp"
#include "plan/outcome.hpp"
#include "plan/planner.hpp"
#include "run/run_checkpoint.hpp"

namespace ropewalk {

PlanCheck checked_against(const RunDirectory& dir, const RunDirectory& other) {
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
  return check;
}

PlanCheck checked_by_stretch(const RunDirectory& dir, double stretch) {
  Scene scene = read_run_scene(dir);
  const RunCheckpoint checkpoint = read_checkpoint(dir);
  const Prepared prepared = prepare(scene);
  const Simulation simulation = simulation_at(dir, scene, prepared, checkpoint);
  const SpotCheck spot = spot_check(scene, prepared, simulation.state(), stretch);
  PlanCheck check{spot.how, {}};
  for (const auto& [name, pair] : spot.observables) check.found[name] = {pair.planned, pair.finer, pair.error()};
  return check;
}

std::vector<OutputColumn> plan_check_columns() {
  return {{"observable", "", "\"energy\", or a column of log.csv"},
          {"planned", "that of the observable", "in the planned run"},
          {"finer", "that of the observable", "with the finer model"},
          {"error", "", "the difference, relative"},
          {"against", "", "what the run was compared with"}};
}

void write_plan_check(const RunDirectory& dir, const PlanCheck& check) {
  std::string text = column_names(plan_check_columns()) + "\n";
  for (const auto& [name, v] : check.found)
    text += fmt::format("{},{},{},{},{}\n", name, v.planned, v.finer, v.error, csv_cell(check.against));
  write_file_atomically(dir.plan_check(), text);
}

namespace {

// Observable and error of each line.
std::map<std::string, double> checked_errors(const RunDirectory& dir, std::string& against) {
  std::map<std::string, double> out;
  if (!std::filesystem::exists(dir.plan_check())) return out;
  CsvReader csv(dir.plan_check());
  csv.next();  // the header
  while (csv.next()) {
    if (csv.cells().size() != plan_check_columns().size())
      csv.fail("", fmt::format("has {} columns, not {}", csv.cells().size(), plan_check_columns().size()),
               "make it again with `ropewalk plan --check`");
    out[std::string(csv.cells()[0])] = csv.number(3, "error");
    against = csv.cells()[4];
  }
  return out;
}

}  // namespace

std::string plan_words(const RunDirectory& dir, const Scene& scene, const Manifest& m) {
  const Expectations plan = expectations_of(scene.text);
  if (plan.errors.empty()) return "";
  std::string against;
  const std::map<std::string, double> seen = checked_errors(dir, against);
  std::string text = fmt::format("This run was planned for {:g} %. Errors promised{}:", 100 * plan.asked,
                                 seen.empty() ? "" : ", and in brackets those seen");
  const char* comma = "";
  for (const auto& [name, error] : plan.errors) {
    const auto at = seen.find(name);
    text += fmt::format("{} {} {:.2f} %{}", comma, name, 100 * error,
                        at == seen.end() ? "" : fmt::format(" ({:.2f} %)", 100 * at->second));
    comma = ",";
  }
  text += seen.empty() ? ". They were not checked yet: `ropewalk plan --check` does it."
                       : fmt::format(". Compared with: {}.", against);
  if (plan.seconds > 0)
    text += fmt::format(" Processor time promised: {:.3g} s; the run took {:.3g} s on {} thread{}.", plan.seconds,
                        m.wall_seconds, m.threads, m.threads == 1 ? "" : "s");
  return text;
}

}  // namespace ropewalk
