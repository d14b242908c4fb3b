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
  std::string tier = "quick";      // "full" has the quick ones too
  bool stability = false;          // the cases that show where methods fail, instead of the others
  std::string parameters;          // a set, in place of the shipped ones where it fits
  std::string out = "validation";
  bool fresh = false;
  bool again = false;  // run cases anew whose results lie in the directory
  bool json = false;
  bool quiet = false;
};
int validate_command(const ValidateArguments& arguments);

struct ReportArguments {
  std::string dir;
};
int validation_report_command(const ReportArguments& arguments);

// --- What a run of cases leaves, and what is made of it ---

struct Outcome {
  std::string name;
  CaseResult result;
  std::string error;  // of a case that could not be run; empty otherwise
  std::string key;    // what it was run with: another key makes it stale

  enum class Verdict { holds, misses, failed };
  Verdict verdict() const;
};

std::string outcome_json(const Outcome& outcome);
// Throws InputError where the file is not such a result.
Outcome read_outcome(const std::string& path);

// The outcomes in the order of all_cases(); `facts` are lines for the end of the page.
std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts);
std::string validation_json(const std::vector<Outcome>& outcomes);
std::string validation_table(const std::vector<Outcome>& outcomes);

const Case& find_case(const std::string& name);
const char* group_name(Case::Group group);

}  // namespace ropewalk
