// What the verbs of `ropewalk calibrate` share. Each verb is a file, with its options; main.cpp names it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "io/removal.hpp"
#include "verbs/calibration.hpp"

namespace ropewalk::calibrate {

struct CalibrateArguments {
  std::string chirality;      // "10,10", "(5,5)@(10,10)"
  int walls = 0;              // found for outer_diameter; 0: chirality has them
  double outer_diameter = 0;  // nm
  std::string carried_by;     // several walls: "outer", "all"; empty: by whether they lock
  std::string atoms = "C";    // or what potential_of_atoms() takes
  std::string potential;      // empty: the first of these atoms
  std::string user_potential;  // file of pair_style and pair_coeff lines
  std::string lj;              // empty: that of the atoms
  double lj_cutoff = 1.2;  // nm; 0: none
  bool usual_cutoff = true;  // nobody chose: 3 nm for several walls
  bool envelope = false;
  std::string out;   // empty: NAME.toml in the current directory
  std::string keep;  // empty: LAMMPS's files are removed at the end
  bool json = false;
  bool force = false;
  bool quiet = false;
  StiffnessOptions stiffness;
  std::string envelope_of;            // a set whose envelope is taken
  std::string bend_lengths;           // nm; empty: 6,10 of one wall, specimen_lengths() of several
  std::string command;                // as typed
};
int calibrate_command(const CalibrateArguments& arguments);

struct FitArguments {
  std::string data, settings, out;
  bool json = false;
  bool force = false;
  std::string command;
};
int fit_command(const FitArguments& arguments);

struct FrictionArguments {
  std::string first, second;  // sets; second empty: like the first
  std::string out;            // empty: friction-N-M-N-M-POTENTIAL.toml in the current directory
  std::string keep;           // empty: LAMMPS's files are removed at the end
  int registers = 32, checks = 3;
  double budget_min =
      0;                // minutes of wall time; registers and checks are chosen to fill them. 0: both are as given
  double drag_ps = 20;  // at each speed; 0: no drag
  bool json = false, force = false, quiet = false;
  LammpsOptions lammps;
  std::string command;
};
int friction_command(const FrictionArguments& arguments);

// --- Shared by the verbs ---

inline constexpr const char* law_of_carbon = "2.84e-3,0.34";

// The options --lj and --lj-cutoff.
void add_law(CLI::App& app, std::string& lj, double& cutoff);

// On Ctrl-C and TERM the LAMMPS child is ended first and temporary files are removed. interrupted_by() is the
// signal, or 0.
void catch_interrupts();
int interrupted_by();

// Reads "12,6". Throws InputError if the text is not a chirality, or if the tube cannot be calibrated.
Chirality parse_chirality(const std::string& text);
AtomLaw parse_atom_law(const std::string& lj, double cutoff);

// A folder for LAMMPS's files: `keep`, which must be new or empty, or a temporary folder. The destructor removes a
// temporary folder, unless an error names files in it.
class WorkFolder {
 public:
  explicit WorkFolder(const std::string& keep);
  const std::string& path() const { return path_; }
  void stay_for(const LammpsError& error);

 private:
  std::string path_;
  std::optional<TemporaryFolder> temporary_;
};

// Refuses an existing file unless forced. Throws InputError.
void check_output(const std::string& path, const std::string& option, bool force);

// EA, EI, GJ as bonds of rigid elements: kn and ks per area with an effective section.
struct Section {
  double kn, ks;        // nN/nm^3
  double A, I, J;       // nm^2, nm^4
  double E, G;          // GPa
  double thick_wall_I;  // nm^4
};
Section effective_section(const ParameterSet& set);

// What made a shipped set, and the numbers that `check-shipped` compares with those of the set made anew. Throws
// InputError for a set that `ropewalk calibrate` did not make.
CalibrationRequest request_of(const ParameterSet& set);
std::vector<std::string> compared_numbers(const ParameterSet& set);

void print_set(const ParameterSet& set);
std::string calibration_page(const ParameterSet& set);

}  // namespace ropewalk::calibrate
