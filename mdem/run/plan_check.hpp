// plan-check.csv: what `plan --check` found of a planned run, for its report.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/manifest.hpp"
#include "io/outputs.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {

struct PlanCheck {
  struct Value {
    double planned = 0, finer = 0;
    double error = 0;  // relative, as plan/outcome.hpp has it
  };
  std::string against;                 // in words
  std::map<std::string, Value> found;  // by observable
};

// The end of a run against that of a finer run of the same scene, by their logs.
PlanCheck checked_against(const RunDirectory& dir, const RunDirectory& finer);
// The state that a run has reached, gone on with for a stretch (ps) with its own model and a finer one.
PlanCheck checked_by_stretch(const RunDirectory& dir, double stretch);

std::vector<OutputColumn> plan_check_columns();
void write_plan_check(const RunDirectory& dir, const PlanCheck& check);

// Promised and found errors, a paragraph; empty for a scene that was not planned.
std::string plan_words(const RunDirectory& dir, const Scene& scene, const Manifest& manifest);

}  // namespace ropewalk
