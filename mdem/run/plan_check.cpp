#include "run/plan_check.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "plan/planner.hpp"

namespace ropewalk {

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
