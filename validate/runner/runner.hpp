// What `ropewalk validate` runs, and what it writes about it.
#pragma once

#include <string>
#include <vector>

#include "core/case.hpp"

namespace ropewalk::validate {

struct Outcome;

struct ValidateArguments {
  std::vector<std::string> cases;  // empty: all of the tier
  std::string tier = "full";       // "quick": without ropes and bundles
  bool stability = false;          // the group `stability` instead of the others
  std::string parameters;          // a set that takes the place of the shipped ones
  std::string with;                // a second set, for pairs of unlike tubes
  bool atoms = false;              // make references of the given set that are missing, with LAMMPS
  double budget = 0;               // minutes that these may take; 0: any
  int jobs = 0;                    // cases at a time; 0: one for each core
  std::string out = "validation";
  bool fresh = false;
  bool again = false;  // run cases again whose results lie in the directory
  bool json = false;
  bool quiet = false;
};
// `validate run` without its messages. Runs the cases whose results are not yet in the folder `arguments.out`, and
// writes results and reports there. Throws InputError.
std::vector<Outcome> run_cases(const ValidateArguments& arguments);

// The directory of --out. Throws InputError where it cannot be made.
void make_directory(const std::string& dir);

// --- Results of cases, and the reports made from them ---

// A parameter set that a case was run with.
struct UsedSet {
  std::string name, hash, tube;
  std::string grade;  // how far it stands for its tube, in words
  double registry =
      -1;  // standard deviation of the energy of two real tubes over all registries; negative: not known
};

struct Outcome {
  std::string name;
  std::vector<UsedSet> sets;
  std::string tubes;  // "(5,5) and (10,10)"
  CaseResult result;
  std::string error;           // why the case could not be run; empty otherwise
  std::string not_applicable;  // why the case is none of this set; empty otherwise
  std::string key;             // version, set and references it was run with; a result with another key is stale

  enum class Verdict { holds, misses, failed, not_applicable };
  Verdict verdict() const;
  std::string with_tubes(std::string text) const;  // {tube} replaced
};

// The grade of a set in words: by its own numbers, and by the cases in which the set misses. A set that misses in a
// case is not good.
std::string grade_with_verdicts(const std::string& grade, const std::string& hash,
                                const std::vector<Outcome>& outcomes);

inline constexpr const char* outcome_format = "ropewalk-validation-1";
std::string outcome_json(const Outcome& outcome);
// Throws InputError where the file is not such a result.
Outcome read_outcome(const std::string& path);

// The part above the cases of a page.
struct PageTop {
  std::string kicker, title;
  std::string html;  // between the first sentence and the table of cases
};
// Outcomes in the order of all_cases(); `facts` are lines for the end of the page.
std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts);
std::string validation_page(const std::vector<Outcome>& outcomes, const std::vector<std::string>& facts,
                            const PageTop& top);
// Grades of the sets of these outcomes, and how they were made.
std::vector<std::string> page_facts(const std::vector<Outcome>& outcomes);
std::string validation_json(const std::vector<Outcome>& outcomes);
std::string validation_table(const std::vector<Outcome>& outcomes);

// Throws InputError with the nearest name where there is no such case.
const Case& find_case(const std::string& name);
const char* group_name(Case::Group group);

}  // namespace ropewalk::validate
