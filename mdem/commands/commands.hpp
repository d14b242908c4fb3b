// The verbs of `ropewalk`. Each takes its options as plain data and returns the exit code; errors are thrown
// and turned into one line by main.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/single_state.hpp"

namespace ropewalk {

struct RunArguments {
  std::string scene;
  std::string out;
  int threads = 0;                // 0: all cores
  std::int64_t steps = -1;        // time step at which to stop; -1: the scene's end
  double until_ps = -1;           // time at which to stop; -1: the scene's end
  std::string on_limit = "warn";  // "warn", "stop" or "refine"
  std::string wall_time;          // see seconds_of_wall_time(); empty: any
  std::string instructions;       // empty: the machine's best
  std::string device;             // see RunSettings
  std::string slurm;              // write a job of SLURM to this file instead; empty: run
  bool force = false;             // overwrite an earlier run
  bool quiet = false;
};
int run_command(const RunArguments& arguments);

struct ResumeArguments {
  std::string dir;
  int threads = 0;
  std::int64_t steps = -1;  // as of RunArguments
  double until_ps = -1;     // likewise
  std::string on_limit = "warn";
  std::string wall_time;        // likewise
  std::string instructions;     // empty: those that the run was begun with
  std::string device;           // see RunSettings
  bool accept_changes = false;  // of scene, sets or program
  bool quiet = false;
};
int resume_command(const ResumeArguments& arguments);

struct ObserveArguments {
  std::string dir;
  double neighbour_radius = -1;  // nm; -1: the scene's
  bool json = false;
  bool list = false;   // only the table of observables
  bool tubes = false;  // every tube of the last frame, as CSV
};
int observe_command(const ObserveArguments& arguments);

struct ReportArguments {
  std::string dir;
  std::string picture;  // write the last frame as SVG here instead
};
int report_command(const ReportArguments& arguments);

struct ConvertArguments {
  std::string dir;
  std::string out;  // .gsd, .lammpstrj or .pvd
  double from_ps = 0;
  std::optional<double> to_ps;
  long every = 1;  // frames
  bool force = false;
};
int convert_command(const ConvertArguments& arguments);

struct PictureArguments {
  std::string dir;
  std::string out;                  // .svg, .pdf or .png
  std::vector<double> at;           // ps; empty: four times over the run
  std::string from = "side";        // or "x", "y", "z", "AZIMUTH,ELEVATION"
  std::vector<std::string> curves;  // "twist_eV+bend_eV" is one chart
  std::string x;                    // column over which they are drawn; empty: time
  std::string colour;               // a word of colour_words(); empty: bending moment
  bool sections = false;
  double width = 1040, highest = 200;  // pixels, of the figure and of each state
  double zoom = 2;                     // pixels of a PNG for one of the figure
  bool force = false;
};
int picture_command(const PictureArguments& arguments);

struct ViewArguments {
  std::string dir;
  std::string out;            // the page; empty: DIR/view.html
  int frames = 100;           // at most
  double megabytes = 15;      // largest size of the page
  std::string movie;          // .webm or .mp4 to write instead
  std::string from = "side";  // view of the movie, as in PictureArguments
  std::string colour;         // colours of the movie, as in PictureArguments
  double fps = 15;            // frames per second of the movie
  int width = 1280;           // pixels, of the movie
  bool force = false;
};
int view_command(const ViewArguments& arguments);

struct RestArguments {
  std::string scene;
  std::string out;                  // empty: runs/NAME-rest
  std::optional<double> viscosity;  // eV ps/nm^3
  double tolerance = 0.02;          // part of the geometric twist, within which both sides agree
  int jobs = 0;                     // 0: one for each core
  bool by_statics = false;          // by Newton's method, without runs
  bool force = false;
  bool json = false;
  bool quiet = false;
};
int rest_command(const RestArguments& arguments);

struct ModesArguments {
  std::string path;  // a scene, or the directory of a run
  int count = 8;
  double shift = 50;        // 1/ns
  bool anyway = false;      // also where it does not rest
  std::string csv, frame;   // files to write; empty: none
  double amplitude = 0.02;  // nm, of the frame
  int threads = 0;
  bool force = false;
};
int modes_command(const ModesArguments& arguments);

struct ErrorsArguments {
  std::string dir;
  bool numerics = false;  // with elements, time step, rate and other starts
  double mean_ps = 0;     // numerics: of means over so much time; 0: of the last row
  int jobs = 0;           // runs at a time; 0: one for each core
  bool again = false;
  bool json = false;
  bool quiet = false;
};
int errors_command(const ErrorsArguments& arguments);

struct CompareArguments {
  std::vector<std::string> names;  // of parameter sets, or of directories: runs and campaigns
  std::string page;                // HTML; empty: none for sets, compare.html for runs
  bool json = false;
  bool force = false;
  // For runs.
  std::string x;                    // empty: time_ps; with --tensile beta_deg, with --torsion rotation_deg
  std::vector<std::string> y;       // empty: the usual columns
  std::vector<std::string> levels;  // "0.45:measured"
  bool log = false;
  double mean_ps = 0;           // the table has means over the last so much time; 0: the last rows
  bool tensile = false;         // strength, toughness and so on of runs that pull a rope
  bool torsion = false;         // the largest torque and what came with it, of runs that twist a rope
  double yarn_diameter_um = 0;  // with --tensile, turns per metre of such a yarn; 0: none
  std::string svg, csv;         // write these files instead of a page
};
int compare_command(const CompareArguments& arguments);
int compare_runs(const CompareArguments& arguments);

struct SweepArguments {
  std::string file;
  std::string out;                // empty: FILE without .toml
  std::vector<std::string> only;  // names of points, or their numbers from 1; empty: all
  std::string slurm, snakemake;   // file to write instead
  std::string on_limit = "warn";  // or "stop"
  int jobs = 0;                   // runs at a time; 0: one for each core
  bool dry_run = false;
  bool again = false;  // failed points as well
  bool force = false;
  bool quiet = false;
};
int sweep_command(const SweepArguments& arguments);

struct ThresholdArguments {
  std::string file;
  std::string out;                // empty: FILE without .toml
  std::string known;              // trials.csv of an earlier search
  std::vector<std::string> only;  // numbers from 1 or names of points; empty: all
  std::string slurm, snakemake;   // write this file and run nothing
  int jobs = 0;                   // points at a time; 0: one for each core
  bool theory = false;            // run nothing
  bool by_statics = false;        // by Newton's method, without runs
  bool force = false;
  bool quiet = false;
};
int threshold_command(const ThresholdArguments& arguments);

struct GatherArguments {
  std::string dir;
  std::string out;  // empty: to the terminal
  double mean_ps = 0;
  bool series = false;
  std::vector<std::string> columns;
  bool force = false;
};
int gather_command(const GatherArguments& arguments);

struct NewArguments {
  std::string name;
  std::string kind = "rope";
  bool list = false;
  bool brief = false;  // without the keys that have their defaults
  bool force = false;
};
int new_command(const NewArguments& arguments);

struct CheckArguments {
  std::string path;       // a scene, or the directory of a run
  bool accuracy = false;  // compares a run with a finer model
  double stretch = 4;     // ps
  std::string against;    // directory of a finer run of the same scene; empty: a stretch is run
};
int check_command(const CheckArguments& arguments);

struct EnergyArguments {
  std::string state;    // file
  SingleState options;  // but for its source
  bool json = false;
  int threads = 0;
};
int energy_command(const EnergyArguments& arguments);

struct BenchArguments {
  std::string scene;         // a file, or a name of --list
  std::string law;           // contact law of a named scene; empty: line
  std::string instructions;  // for the contact; empty: the machine's best
  std::string device;        // empty: none
  long steps = 200;
  double after = -1;               // ps that the scene runs before it is measured; less than zero: as --list has it
  std::vector<int> threads = {1};  // measured one after another
  bool list = false;
  bool json = false;
};
int bench_command(const BenchArguments& arguments);
int bench_device(const BenchArguments& arguments);

struct ExportArguments {
  std::string scene;   // a file, or the directory of a run
  std::string lammps;  // directory to make
  bool force = false;
  bool quiet = false;
};
int export_command(const ExportArguments& arguments);

int cite_command(const std::string& directory);

struct AtomsArguments {
  std::string path;         // directory of a run, or a state file
  SingleState state;        // a state file, but for its source
  std::string out;          // .data, .xyz or .extxyz
  long frame = -1;          // of a run; from the end if negative
  std::string at;           // limit, whose place and time are wanted instead
  double length = 12;       // nm, of that place
  bool step_again = false;  // to that moment, however long it takes
  std::string tubes;        // "0-18,20"; empty: all
  std::string between;      // "20,40" nm along each tube; empty: all
  std::string potential;    // empty: that of the sets
  bool relax = false;
  bool force = false;
  bool json = false;
};
int atoms_command(const AtomsArguments& arguments);

struct CoarsenArguments {
  std::vector<std::string> files;
  std::string out;                      // directory of the run to make
  std::string state;                    // CSV file to write instead, of one frame
  std::vector<std::string> parameters;  // sets; empty: shipped ones of the chiralities that are found
  double element_length = 0;            // nm; 0: the set's
  double time_step_fs = 1;              // of MD steps in dumps that state no time
  bool force = false;
  bool json = false;
  bool quiet = false;
};
int coarsen_command(const CoarsenArguments& arguments);

struct ImportArguments {
  std::string dir;  // that of the export, after LAMMPS has run in it
  bool accept_changes = false;  // of in.rope and what it reads
};
int import_command(const ImportArguments& arguments);

}  // namespace ropewalk
