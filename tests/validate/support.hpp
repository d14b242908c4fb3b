// Runs a case on the stored references, with or without a fault of the model, for the tests of cases.
#pragma once

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "core/case.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"

namespace ropewalk::validate::test {

inline ParameterSet shipped(const std::string& name) { return read_parameters(find_parameters(name, "")); }

inline CaseContext stored_context() {
  CaseContext context;
  context.references = ROPEWALK_SOURCE_DIR "/data/references";
  context.no_atoms = "make them with --atoms";
  context.progress = [](const std::string&) {};
  return context;
}

inline CaseResult run(const Case& c, const Fault& fault = {}) {
  CaseContext context = stored_context();
  for (const std::string& name : c.sets) context.sets.push_back(shipped(name));
  context.fault = fault;
  context.brief = !fault.name().empty();
  return run_case(c, context);
}

// As with --parameters.
inline CaseResult run_with(const ParameterSet& given, const Case& c, const Fault& fault = {}) {
  CaseContext context = stored_context();
  context.sets = {given};
  context.given = true;
  context.fault = fault;
  return run_case(c, context);
}

// Names of the checks that decide and do not hold.
inline std::set<std::string> misses(const CaseResult& result) {
  std::set<std::string> names;
  for (const Check& check : result.checks)
    if (!check.informative && !check.holds()) names.insert(check.name);
  return names;
}

// The first check that has this part in its name.
inline const Check& check_of(const CaseResult& result, const std::string& part) {
  const auto at = std::find_if(result.checks.begin(), result.checks.end(),
                               [&](const Check& c) { return c.name.find(part) != std::string::npos; });
  if (at == result.checks.end()) throw std::out_of_range(part);
  return *at;
}

}  // namespace ropewalk::validate::test
