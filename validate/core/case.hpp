// A validation case: one physical question with a set-up, an oracle and tolerances that were fixed beforehand. A
// case runs the model, holds its numbers to the oracle and returns checks and figures; it never prints and never
// decides what to do about a miss. Every case is one file of validate/cases/.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "model/parameters.hpp"
#include "report/svg.hpp"

namespace ropewalk {

// One number held to its oracle.
struct Check {
  std::string name;      // "EA of the chain"
  double value = 0;      // of the model
  double reference = 0;  // of the oracle
  double tolerance = 0;  // allowed difference
  bool relative = true;  // tolerance over |reference|, or in the unit
  std::string unit;
  // Not held to anything: shown for what it tells (another code's fault, a known limit).
  bool informative = false;
  std::string note;  // why this tolerance, or what a miss means

  double difference() const;  // relative or absolute, as the tolerance is
  bool holds() const;         // false for a value that is not finite
};

struct CaseFigure {
  LineChart chart;
  std::string caption;  // what to see in it
};

// A place where a method fails: for the map of `validate stability`.
struct Limit {
  // What `run` does about it: does not start, ends with the reason, says so, or nothing.
  enum class Guard { refused, stopped, told, none };
  std::string method;  // "time step of a single tube"
  double found = 0;    // by bisection on the method itself
  double theory = 0;
  std::string unit;
  Guard guard = Guard::none;
  std::string how;  // the guard in words
};

struct CaseResult {
  std::vector<Check> checks;
  std::vector<Limit> limits;  // of the group `stability`
  std::vector<CaseFigure> figures;
  std::vector<std::string> remarks;  // sentences: what a miss is due to, which assumption it shows
  std::vector<std::string> sources;  // reference files (with "stored" or "fresh"), parameter sets
  double seconds = 0;

  bool holds() const;  // of all checks that are not informative
};

// A deliberate fault of the model, never of the oracle: a case that stays green under every one of them tests
// nothing.
struct Fault {
  double EA = 1, EI = 1, GJ = 1;  // factors of the bond
  double contact = 1;             // factor of the contact energy
  bool missing_torque = false;    // the `paper` law without the torque that the published code leaves out
};

// A set whose tubes bind so many times as strongly, at the same distance.
void scale_contact(ParameterSet& set, double factor);

// What a case may use.
struct CaseContext {
  // The set of a name, for the oracle; the one given with --parameters where its chirality is the same.
  std::function<ParameterSet(const std::string& name)> parameters;
  Fault fault;
  // The same set as the model is to have it, that is with the fault.
  ParameterSet model(const std::string& name) const;
  std::string references;  // folder of stored reference data
  std::string work;        // an empty folder for this case (LAMMPS files, states)
  bool fresh = false;      // make references anew with LAMMPS and compare with the stored ones
  std::function<void(const std::string& line)> progress;
};

struct Case {
  // The last: where a method fails, with theory beside it; of `validate stability`, not of `run`.
  enum class Group { theory, atoms, codes, stability };
  enum class Tier { quick, full };
  std::string name;  // "euler-buckling": of the command line and the files
  Group group = Group::theory;
  Tier tier = Tier::quick;  // seconds, or minutes to an hour with stored references
  std::string title;
  std::string why;         // why it matters for a rope
  std::string setup;       // what is built and loaded
  std::string oracle;      // what it is held to, with the equation
  std::string literature;  // citation with DOI
  std::function<CaseResult(const CaseContext&)> run;
};

// All cases, in the order of the report. A case file defines `Case name_case()`, listed in cases/cases.cpp.
const std::vector<Case>& all_cases();

}  // namespace ropewalk
