// A validation case asks one physical question. It has a set-up, an oracle and tolerances, all fixed before the
// case is run. A case runs the model, compares its numbers with the oracle and returns checks and figures; it never
// prints and never decides what a miss leads to. Every case is a folder of validate/cases/: `case.md`, its prose,
// `scene.toml` where its specimen is a scene, and `case.cpp`, its oracle and checks, which registers it.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "model/parameters.hpp"
#include "report/svg.hpp"

namespace ropewalk::validate {

// One number compared with its oracle.
struct Check {
  std::string name;      // "EA of the chain"
  double value = 0;      // result of the model
  double reference = 0;  // result of the oracle
  double tolerance = 0;  // largest difference allowed
  bool relative = true;  // tolerance over |reference|; otherwise in the unit
  std::string unit;
  // Shown for information (another code's error, a known limit); decides nothing.
  bool informative = false;
  std::string note;  // the reason for this tolerance, or what a miss means
  // A miss that the case declares: it holds while the difference stays within `spread` of `expected`.
  struct Known {
    double expected = 0, spread = 0;  // as difference()
  };
  std::optional<Known> known = {};

  double difference() const;  // relative or absolute, as the tolerance is
  bool holds() const;         // false for a value that is not finite
};

struct CaseFigure {
  LineChart chart;
  std::string caption;  // what the figure shows
  bool on_map = false;  // stands with the limits of all methods, at the top of the page
  std::vector<std::vector<std::string>> labels = {};  // beside the points of each line; may be shorter
};

// A place where a method fails, for the map of `validate stability`.
struct Limit {
  // The response of `run` there: it does not start, it ends with the reason, it warns, or it does nothing.
  enum class Guard { refused, stopped, told, none };
  std::string method;  // "time step of a single tube"
  double found = 0;    // limit that bisection on the method itself has found
  double theory = 0;
  std::string unit;
  Guard guard = Guard::none;
  std::string how;  // the guard in words
};

struct CaseResult {
  std::vector<Check> checks;
  std::vector<Limit> limits;  // only in cases of the group `stability`
  std::vector<CaseFigure> figures;
  std::vector<std::string> remarks;  // sentences: the cause of a miss, the assumption that a number tests
  std::vector<std::string> sources;  // reference files (with "stored" or "fresh"); run_case() adds the sets
  double seconds = 0;

  bool holds() const;  // every check that is not informative holds

  // Adds a check whose tolerance is a fraction of |reference|, or is in the unit. show_... adds one that decides
  // nothing.
  void check_relative(std::string name, double value, double reference, double tolerance, std::string unit,
                      std::string note = "");
  void check_absolute(std::string name, double value, double reference, double tolerance, std::string unit,
                      std::string note = "");
  void show_relative(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
  void show_absolute(std::string name, double value, double reference, double tolerance, std::string unit,
                     std::string note = "");
  // Adds a figure; see case_figure().
  void figure(std::string title, ChartAxis x, ChartAxis y, std::string caption, std::vector<ChartLine> lines);
};

// A deliberately wrong parameter of the model, never of the oracle.
struct Fault {
  double EA = 1, EI = 1, GJ = 1;  // factors of the bond's stiffnesses
  double contact = 1;             // factor of the contact energy
  bool missing_torque = false;    // the `paper` law without the torque that the published code leaves out
  double natural = 1;             // factor of curvature and twist at rest

  std::string name() const;  // "EI_plus_10_percent", for names of tests; empty without a fault
};
Fault wrong_EA(double factor);
Fault wrong_EI(double factor);
Fault wrong_GJ(double factor);
Fault wrong_stiffnesses(double factor);  // EA, EI and GJ together
Fault wrong_contact(double factor);
Fault wrong_natural_shape(double factor);
Fault without_torque();

// Multiplies the contact energy of a set; the distance of its minimum stays.
void scale_contact(ParameterSet& set, double factor);

// The case cannot run with this set, or nothing is there to compare it with; what() says why.
struct NotApplicable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One tube of a case.
struct CaseTube {
  ParameterSet set;    // set of the oracle
  ParameterSet model;  // the same with the fault
  std::string name;    // "(10,10)"
  std::string source;  // "cnt-10-10-tersoff (hash ...)", for CaseResult::sources
};

// What the runner gives to a case.
struct CaseContext {
  // The sets that the case runs with: Case::sets or, in the place of all of them, the one given with --parameters.
  std::vector<ParameterSet> sets;
  bool given = false;  // with --parameters
  Fault fault;
  // The tests of a wrong parameter ask for fewer runs: a case leaves out parameter sets, rope sizes and rates that
  // its other runs make unnecessary.
  bool brief = false;
  const ParameterSet& set(std::size_t k = 0) const { return sets.at(k); }  // for the oracle
  ParameterSet model(std::size_t k = 0) const;                             // the same with the fault
  CaseTube tube(std::size_t k = 0) const;
  std::vector<CaseTube> tubes() const;

  std::string references;   // folder of the stored reference data of shipped sets
  std::string work;         // an empty folder for this case (LAMMPS files, states)
  bool fresh = false;       // make references with LAMMPS and compare them with the stored ones
  bool make_atoms = false;  // make references that are missing and store them beside the set
  std::string no_atoms;     // why they are not made
  std::function<void(const std::string& line)> progress;
};

struct Case {
  // `validate run` takes all groups but `stability`, which `validate stability` takes: the limits of the methods.
  enum class Group { theory, atoms, codes, stability };
  // quick: single tubes, pairs and theory. full: also ropes and bundles, whose atoms take LAMMPS minutes to an
  // hour.
  enum class Tier { quick, full };

  // A fault under which the case must miss.
  struct Red {
    Fault fault;
    // Parts of names: for each, a check that has this part in its name must miss. Without any, one check must miss.
    std::vector<std::string> checks;

    Red(const Fault& fault_ = {}, std::vector<std::string> checks_ = {})
        : fault(fault_), checks(std::move(checks_)) {}
  };

  // The contact law that the case uses: sets without it cannot run it.
  enum class Law { none, line, paper };

  std::string name;  // "euler-buckling", on the command line and of files; the folder's name
  Group group = Group::theory;
  int order = 0;  // place within the group in lists and reports; equal places go by name
  Tier tier = Tier::quick;
  Law law = Law::line;
  // Shipped sets that it runs with where none is given.
  std::vector<std::string> sets = {"cnt-10-10-tersoff"};
  // Is of a filament with a natural shape or two stiffnesses of bending too.
  bool shaped = false;
  // Compares pairs of unlike tubes too: takes the second set of `validate run --with`.
  bool takes_two = false;
  // The case is about these sets. A given one takes the place of none of them, unless it is of the same tube and
  // the same interatomic potential. The text says why.
  std::string only_these;
  // The following stand in case.md. Texts may contain {tube}, the names of the tubes: "(5,5) and (10,10)". Formulas
  // stand between backquotes in these texts, in notes and in captions. report/formula.hpp has their grammar.
  std::string title;
  std::string why;         // why it matters in a rope
  std::string setup;       // the specimen and its loads
  std::string oracle;      // what the model is compared with, with the equation
  std::string literature;  // citation with DOI
  std::vector<std::string> remarks;
  std::function<CaseResult(const CaseContext&)> run;
  // Cases against atoms: their tables of references (see reference.hpp), and about how long LAMMPS takes for those
  // of one tube, s of one core.
  std::vector<std::string> tables;
  std::function<double(const ParameterSet&)> lammps_seconds;

  // The test of every case makes sure that it holds, and that these turn it red. A case that holds under every
  // wrong parameter tests nothing: each names at least one that it sees.
  std::vector<Red> turns_red;
  std::vector<Fault> stays_green;  // faults in quantities that the case does not depend on
  // Checks that miss with the right parameters, and by how much; the remarks say why. A miss that changes is a
  // miss.
  struct KnownMiss {
    std::string check;
    Check::Known size;
  };
  std::vector<KnownMiss> known_misses;
};

// Registers a case before main() begins. Write one at the end of case.cpp; case.md and the folder's name say the
// rest:
//
//   const RegisteredCase registered([] {
//     Case c;
//     c.name = "my-question";
//     ...
//     return c;
//   });
struct RegisteredCase {
  explicit RegisteredCase(Case (*make)());
};

// All registered cases, in the order of the report: by group, order and name.
const std::vector<Case>& all_cases();

// "(5,5) and (10,10)", the tubes of these sets; laws apart, each once.
std::string tube_names(const std::vector<ParameterSet>& sets);
// Whether two sets are of the same tube and the same interatomic potential, or of the same filament.
bool like(const ParameterSet& i, const ParameterSet& j);
// Runs the case, names its sets among the sources and marks its known misses.
CaseResult run_case(const Case& c, const CaseContext& context);
// Whether the case can run with a set that the user gives: throws NotApplicable where it cannot.
void check_applicable(const Case& c, const ParameterSet& given, const std::vector<ParameterSet>& shipped);

// Sorts the cases for the report. Throws std::invalid_argument where two have the same name.
std::vector<Case> sorted_cases(std::vector<Case> cases);

}  // namespace ropewalk::validate
