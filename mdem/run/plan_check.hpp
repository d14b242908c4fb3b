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

std::vector<OutputColumn> plan_check_columns();
void write_plan_check(const RunDirectory& dir, const PlanCheck& check);

// What was promised and what was seen, a paragraph; empty for a scene that was not planned.
std::string plan_words(const RunDirectory& dir, const Scene& scene, const Manifest& manifest);

}  // namespace ropewalk
