// The verbs of `ropewalk validate`. Exit codes: 0 all checks hold, 1 some miss, 2 wrong input, 3 a case failed.
#pragma once

#include <string>
#include <vector>

#include "core/case.hpp"

namespace ropewalk {

struct ListArguments {
  bool json = false;
};
int list_command(const ListArguments& arguments);

struct ValidateArguments {
  std::vector<std::string> cases;  // empty: all of the tier
  std::string tier = "quick";      // "full" includes the quick ones
  bool stability = false;          // the group `stability` instead of the others
  std::string parameters;          // a set that takes the place of the shipped ones where the case allows it
  std::string out = "validation";
  bool fresh = false;
  bool again = false;  // run cases again whose results lie in the directory
  bool json = false;
  bool quiet = false;
};
int validate_command(const ValidateArguments& arguments);

struct ReportArguments {
  std::string dir;
};
int validation_report_command(const ReportArguments& arguments);

// --- Results of cases, and the reports made from them ---

struct Outcome {
  std::string name;
  CaseResult result;
  std::string error;  // why the case could not be run; empty otherwise
  std::string key;    // version, set and references it was run with; a result with another key is stale

  enum class Verdict { holds, misses, failed };
  Verdict verdict() const;
};

std::string outcome_json(const Outcome& outcome);
// Throws InputError where the file is not such a result.
Outcome read_outcome(const std::string& path);

// Outcomes in the order of all_cases(); `facts` are lines for the end of the page.
std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts);
std::string validation_json(const std::vector<Outcome>& outcomes);
std::string validation_table(const std::vector<Outcome>& outcomes);

// Throws InputError with the nearest name where there is no such case.
const Case& find_case(const std::string& name);
const char* group_name(Case::Group group);

}  // namespace ropewalk
