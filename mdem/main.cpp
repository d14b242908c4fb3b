// ropewalk: the front door. Reads the command line, calls the verb, turns errors into one line and an exit
// code: 0 done, 2 wrong input, 3 numerical failure or a disk that takes no more, 4 a relaxation that did not come
// to rest, 5 stopped at a limit, 6 stopped by --wall-time, 7 done but far beyond a limit, 128 + signal when
// interrupted.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "cli/command_line.hpp"
#include "commands/commands.hpp"
#include "commands/limit_help.hpp"
#include "commands/siblings.hpp"
#include "commands/table_help.hpp"
#include "io/data_files.hpp"
#include "io/error_exit.hpp"
#include "io/plain_text.hpp"
#include "io/program.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "observe/limits.hpp"
#include "run/cores.hpp"
#include "run/pages/colour_fields.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"
#include "version.hpp"

namespace {

using namespace ropewalk;

// Before steps that so many threads share (0: all that there are). By default the OpenMP runtime spins for
// milliseconds while it waits, and on a machine that does other work as well a step then takes up to ten times as
// long. Asleep at once, small ropes lose what the second core gains: waking takes as long as the gaps between the
// parallel parts of a step. So: spin for some ten microseconds, then sleep. The runtime reads its settings before
// main: start once more with them, unless the user has chosen otherwise. (Under valgrind, set
// OMP_WAIT_POLICY=passive yourself, or the second start runs outside it.)
void wait_briefly(char** argv, int threads) {
  if ((threads > 0 ? threads : threads_in_use()) == 1) return;
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("GOMP_SPINCOUNT", "2000", 1);
  give_back_cores();
  execv("/proc/self/exe", argv);  // on failure go on as we are: only speed is lost
}

// Threads of each of so many runs at a time; 0 runs: one for each core.
int threads_beside(int jobs) { return jobs > 0 ? std::max(1, omp_get_num_procs() / jobs) : 1; }

struct Verbs {
  char** argv;
  RunArguments run;
  ResumeArguments resume;
  ObserveArguments observe;
  NewArguments make;
  EnergyArguments energy;
  BenchArguments bench;
  ReportArguments report;
  ConvertArguments convert;
  PictureArguments picture;
  ViewArguments view;
  ErrorsArguments errors;
  CompareArguments compare;
  SweepArguments sweep;
  ThresholdArguments threshold;
  RestArguments rest;
  ModesArguments modes;
  GatherArguments gather;
  ExportArguments to_lammps;
  ImportArguments from_lammps;
  AtomsArguments atoms;
  CoarsenArguments coarsen;
  CheckArguments check;
  std::string help_topic, cited_run;
  int code = 0;
};

void add_on_limit(CLI::App* c, std::string& word) {
  c->add_option("--on-limit", word,
                "What to do where a limit of [limits] is passed: warn; stop (exit code 5); refine: go on in "
                "DIR.fine with every element split in two")
      ->capture_default_str()
      ->check(CLI::IsMember({"warn", "stop", "refine"}));
}

void add_end(CLI::App* c, std::int64_t& steps, double& until_ps) {
  CLI::Option* count = c->add_option("--steps", steps, "Stop at this time step")->check(whole_number(0));
  c->add_option("--until", until_ps, "Stop at this time (ps) instead of the scene's")
      ->check(number_within(Bounds::non_negative()))
      ->excludes(count);
}

void add_wall_time(CLI::App* c, std::string& wall_time) {
  c->add_option("--wall-time", wall_time,
                "Stop with a checkpoint (exit code 6) before the program has run for so long: seconds, or H:MM:SS");
}

void add_instructions(CLI::App* c, std::string& name, const char* of, const std::string& by_default) {
  c->add_option(
       "--instructions", name,
       fmt::format("Instruction set of {}: {} [default: {}]", of, fmt::join(instruction_sets(), ", "), by_default))
      ->check(CLI::IsMember(instruction_sets()));
}

void add_device(CLI::App* c, std::string& name, const std::string& by_default) {
  c->add_option("--device", name,
                "Device that moves the elements (a GPU pays, by estimate, from 20 000 elements on): gpu, "
                "opencl:TEXT for an OpenCL "
                "device with TEXT in its name, c++ for its kernels on this processor, or none [default: " +
                    by_default + "]");
}

CLI::Option* add_colour(CLI::App* c, std::string& colour, const char* what) {
  return c
      ->add_option("--colour", colour,
                   fmt::format("{} are coloured by: {} [default: moment, where frames have it]", what,
                               fmt::join(colour_words(), ", ")))
      ->check(CLI::IsMember(colour_words()));
}

CLI::Validator thread_range() { return whole_number(1, most_threads); }

void add_new(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("new", "Write a commented scene to start from");
  c->add_option("name", v.make.name, "Name of the scene; NAME.toml is written");
  c->add_option("--kind", v.make.kind, "Which template, see --list")->capture_default_str();
  c->add_flag("--list", v.make.list, "List the templates");
  c->add_flag("--short", v.make.brief, "Only the keys that matter, without those that have their defaults");
  c->add_flag("--force", v.make.force, "Overwrite an existing file");
  c->callback([&v] { v.code = new_command(v.make); });
}

void add_check(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "check",
      "Read a scene, say what it would do and how long it would take; or judge a run by the [[expect]] "
      "tables of its scene, or by a finer model");
  c->add_option("scene", v.check.path, "Scene file (TOML), or the directory of a finished run")->required();
  c->add_flag("--accuracy", v.check.accuracy,
              "Of a run: continue it with its own model and with a finer one, and print how far they differ");
  c->add_option("--stretch", v.check.stretch, "With --accuracy: ps that both models go on")
      ->capture_default_str()
      ->check(number_within(Bounds::positive()));
  c->add_option("--against", v.check.against,
                "With --accuracy: directory of a run of the same scene by a finer model, in place of the stretch");
  c->callback([&v] { v.code = check_command(v.check); });
}

void add_run(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("run", "Run a scene");
  c->add_option("scene", v.run.scene, "Scene file (TOML)")->required();
  c->add_option("--out", v.run.out, "Directory of the run; made, never overwritten")->required();
  c->add_option("--threads", v.run.threads, "Threads [default: all cores]; any number gives the same bits")
      ->check(thread_range());
  add_end(c, v.run.steps, v.run.until_ps);
  add_on_limit(c, v.run.on_limit);
  add_wall_time(c, v.run.wall_time);
  add_instructions(c, v.run.instructions, "the calculation, for the same bits on other processors",
                   instruction_sets().front());
  add_device(c, v.run.device, "none");
  c->add_option(
      "--slurm", v.run.slurm,
      "Only write a SLURM job to this file that runs the scene in pieces of --wall-time, and submits itself "
      "until the run is done");
  c->add_flag("--force", v.run.force, "Replace an earlier run in --out");
  c->add_flag("--quiet", v.run.quiet, "No progress line");
  c->callback([&v] {
    wait_briefly(v.argv, v.run.threads);
    v.code = run_command(v.run);
  });
}

void add_errors(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("errors",
                                   "Error bars of a finished run, from the standard errors of its parameter sets, "
                                   "friction files and scene numbers; it "
                                   "repeats the run");
  c->add_option("dir", v.errors.dir, "Directory of the run")->required();
  CLI::Option* numerics = c->add_flag("--numerics", v.errors.numerics,
                                      "Add the numerical errors: repeat the run with half the element length, half "
                                      "the time step and half the rate, and "
                                      "from other random starts");
  c->add_option("--mean", v.errors.mean_ps, "Errors of means over the last so many ps instead of the last row")
      ->check(number_within(Bounds::positive()))
      ->needs(numerics);
  c->add_option("-j,--jobs", v.errors.jobs, "Runs at a time [default: one for each core]")->check(whole_number(1));
  c->add_flag("--again", v.errors.again, "Repeat finished runs as well");
  c->add_flag("--json", v.errors.json, "JSON");
  c->add_flag("--quiet", v.errors.quiet, "No progress lines");
  c->callback([&v] {
    wait_briefly(v.argv, threads_beside(v.errors.jobs));
    v.code = errors_command(v.errors);
  });
}

void add_cite(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("cite", "Name what a paper that shows a run should cite, as BibTeX");
  c->add_option("dir", v.cited_run, "Directory of the run")->required();
  c->callback([&v] { v.code = cite_command(v.cited_run); });
}

void add_compare(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("compare", "Side by side: runs and campaigns, or parameter sets");
  c->add_option("names", v.compare.names,
                "Directories of runs and campaigns; or parameter sets: files, or names of shipped ones")
      ->required();
  c->add_option("--page", v.compare.page,
                "Page with all curves (HTML) [default: compare.html for runs, none for sets]");
  c->add_option("--x", v.compare.x,
                "Runs: column of log.csv on the horizontal axis [default: time_ps; with --tensile beta_deg, with "
                "--torsion rotation_deg]");
  c->add_option("--y", v.compare.y, "Runs: columns, a chart each, such as torque_nN_nm, the mean of both ends [default: the usual ones that vary]")
      ->delimiter(',');
  c->add_option("--level", v.compare.levels, "Runs: a value to compare with, as 0.45:NAME");
  c->add_option(
       "--mean", v.compare.mean_ps,
       "Runs: the table, and --csv, have means over the last so many ps, each with its error and correlation time")
      ->check(number_within(Bounds::positive()));
  c->add_flag(
      "--tensile", v.compare.tensile,
      "Runs that pull a rope: strength, modulus, toughness and breaks, against the value of --x before the pull");
  c->add_flag("--torsion", v.compare.torsion,
              "Runs that twist a rope: largest torque, its angle, first break and stored energy, against the value "
              "of --x at that torque")
      ->excludes("--tensile");
  c->add_option("--yarn-diameter-um", v.compare.yarn_diameter_um,
                "With --tensile: add turns per metre, of a yarn of this diameter with the twist angle of each run")
      ->check(number_within(Bounds::positive()))
      ->needs("--tensile");
  c->add_flag("--log", v.compare.log, "Runs: logarithmic vertical axis");
  c->add_option("--svg", v.compare.svg, "Runs: write the chart of the first column to this file instead");
  c->add_option("--csv", v.compare.csv, "Runs: write the curves, and their standard errors, to this file instead");
  c->add_flag("--json", v.compare.json, "Sets: JSON");
  c->add_flag("--force", v.compare.force, "Replace existing files");
  c->callback([&v] { v.code = compare_command(v.compare); });
}

void add_resume(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("resume", "Go on with a run from its last checkpoint, bit for bit");
  c->add_option("dir", v.resume.dir, "Directory of the run")->required();
  c->add_option("--threads", v.resume.threads, "Threads [default: all cores]")->check(thread_range());
  add_end(c, v.resume.steps, v.resume.until_ps);
  add_on_limit(c, v.resume.on_limit);
  add_wall_time(c, v.resume.wall_time);
  add_instructions(c, v.resume.instructions, "the calculation", "that of the run");
  add_device(c, v.resume.device, "that of the run");
  c->add_flag("--accept-changes", v.resume.accept_changes,
              "Go on although the scene, the parameter set or the program is not what the run was begun with");
  c->add_flag("--quiet", v.resume.quiet, "No progress line");
  c->callback([&v] {
    wait_briefly(v.argv, v.resume.threads);
    v.code = resume_command(v.resume);
  });
}

void add_observe(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("observe", "Measure the stored frames of a run: twist, packing, shape");
  c->add_option("dir", v.observe.dir, "Directory of the run");
  c->add_flag("--list", v.observe.list, "List the observables: name, unit, meaning (Markdown)");
  c->add_option("--neighbour-radius", v.observe.neighbour_radius,
                "Tubes closer than this are neighbours (nm) [default: the scene's]")
      ->check(number_within(Bounds::positive()));
  c->add_flag("--json", v.observe.json, "JSON, with radius profile and centre line");
  c->add_flag("--tubes", v.observe.tubes,
              "Every tube of the last frame, as CSV: tension, twist, curvature, slip, pressure");
  c->callback([&v] { v.code = observe_command(v.observe); });
}

void add_report(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("report", "Make report.html anew from the files of a run");
  c->add_option("dir", v.report.dir, "Directory of the run")->required();
  c->add_option("--picture", v.report.picture, "Write a side view of the last frame to this SVG file instead");
  c->callback([&v] { v.code = report_command(v.report); });
}

void add_convert(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("convert", "Frames of a run in another format: GSD, LAMMPS dump, ParaView");
  c->add_option("dir", v.convert.dir, "Directory of the run")->required();
  c->add_option("file", v.convert.out,
                "File to write: .gsd (OVITO, MDAnalysis), .lammpstrj (LAMMPS, ASE) or .pvd (ParaView)")
      ->required();
  c->add_option("--from-ps", v.convert.from_ps, "Leave out what is earlier")->capture_default_str();
  c->add_option("--to-ps", v.convert.to_ps, "Leave out what is later");
  c->add_option("--every", v.convert.every, "Every Nth frame")->check(whole_number(1))->capture_default_str();
  c->add_flag("--force", v.convert.force, "Replace an existing file");
  c->callback([&v] { v.code = convert_command(v.convert); });
}

void add_picture(CLI::App& app, Verbs& v) {
  CLI::App* c =
      app.add_subcommand("picture", "A figure for a paper: states of a run, their sections, curves with marks");
  c->add_option("dir", v.picture.dir, "Directory of the run")->required();
  c->add_option("-o", v.picture.out, "File to write: .svg, .pdf or .png")->required();
  c->add_option("--at", v.picture.at, "Times of the states, ps [default: four over the run]")->delimiter(',');
  c->add_option("--from", v.picture.from,
                "Seen from: side (the largest deflection in the page), x, y, z, or AZIMUTH,ELEVATION")
      ->capture_default_str();
  c->add_option("--curves", v.picture.curves, "Charts below: columns of log.csv, or torque_nN_nm, the mean of both ends; twist_eV+bend_eV,Q makes two")
      ->delimiter(',');
  c->add_option("--x", v.picture.x,
                "Column of log.csv over which these are drawn, such as rotation_deg [default: time]");
  add_colour(c, v.picture.colour, "Tubes");
  c->add_flag("--sections", v.picture.sections, "The cross-section of each state beside it");
  c->add_option("--width", v.picture.width, "Width of the figure, pixels")
      ->capture_default_str()
      ->check(whole_number(200, 8000));
  c->add_option("--highest", v.picture.highest, "Largest height of a state, pixels")
      ->capture_default_str()
      ->check(whole_number(20, 8000));
  c->add_option("--zoom", v.picture.zoom, "Pixels of a PNG per pixel of the figure")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0.1, 20.0)));
  c->add_flag("--force", v.picture.force, "Replace the file");
  c->callback([&v] { v.code = picture_command(v.picture); });
}

void add_view(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "view", "Show a run in space: a page to turn, play and cut through its frames; or a movie");
  c->add_option("dir", v.view.dir, "Directory of the run")->required();
  c->add_option("-o", v.view.out, "Page to write [default: DIR/view.html]");
  c->add_option("--frames", v.view.frames, "At most so many frames, evenly over the run")
      ->capture_default_str()
      ->check(whole_number(1, 100000));
  c->add_option("--megabytes", v.view.megabytes,
                "Largest size of the page: numbers are rounded to keep it, then frames are left out")
      ->capture_default_str()
      ->check(number_within(Bounds::range(1.0, 2000.0)));
  CLI::Option* movie =
      c->add_option("--movie", v.view.movie, "Write a movie of these frames instead: .webm or .mp4, by ffmpeg");
  c->add_option("--from", v.view.from,
                "Movie, seen from: side (the largest deflection in the picture), x, y, z, or AZIMUTH,ELEVATION")
      ->capture_default_str()
      ->needs(movie);
  add_colour(c, v.view.colour, "Movie: tubes")->needs(movie);
  c->add_option("--fps", v.view.fps, "Movie: frames per second")
      ->capture_default_str()
      ->check(number_within(Bounds::range(0.1, 120.0)))
      ->needs(movie);
  c->add_option("--width", v.view.width, "Movie: width, pixels")
      ->capture_default_str()
      ->check(whole_number(200, 7680))
      ->needs(movie);
  c->add_flag("--force", v.view.force, "Replace the file of -o or --movie");
  c->callback([&v] { v.code = view_command(v.view); });
}

void add_atoms(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "atoms", "Elements as atoms: a frame of a run, or a state, as a LAMMPS data file or extended XYZ");
  c->add_option("path", v.atoms.path, "Directory of a run, or a state file (CSV)")->required();
  c->add_option(
       "-o", v.atoms.out,
       "File to write: .data for LAMMPS, .xyz or .extxyz. Beside it: which atoms are of which element, and an "
       "input of LAMMPS that relaxes them")
      ->required();
  CLI::Option* frame =
      c->add_option("--frame", v.atoms.frame, "Frame of a run, from 0; -1 is the last")->capture_default_str();
  CLI::Option* at =
      c->add_option("--at", v.atoms.at,
                    "A limit that the run has passed: the place where it did so first. The run is stepped again to "
                    "that moment where that takes less than a minute; else the last frame before it is taken")
          ->excludes(frame);
  c->add_flag("--step-again", v.atoms.step_again, "With --at: step the run again, however long it takes")
      ->needs(at);
  c->add_option("--length", v.atoms.length, "With --at: diameter of that place, nm")
      ->capture_default_str()
      ->check(number_within(Bounds::range(1, 1000)))
      ->needs(at);
  c->add_option("--tubes", v.atoms.tubes, "These tubes alone, from 0: 0-18,20");
  c->add_option("--between", v.atoms.between,
                "This stretch of each tube alone, nm from its first end at rest: 20,40");
  c->add_flag("--relax", v.atoms.relax,
              "Have LAMMPS minimise the energy with the ends held, and print it beside that of the model");
  c->add_option("--potential", v.atoms.potential,
                "tersoff, airebo, rebo, lcbop, or a file of pair_style and pair_coeff lines [default: the set's]");
  c->add_option("--parameters", v.atoms.state.parameters,
                "For a state file: its parameter set; several, separated by commas, for tube types")
      ->delimiter(',');
  c->add_option("--tube-types", v.atoms.state.tube_types,
                "For a state file: number of the parameter set of each tube, from 0 [default: all 0]")
      ->delimiter(',');
  c->add_option("--element-length-nm", v.atoms.state.element_length,
                "For a state file: length of an element [default: what the file says, else the set's]")
      ->check(number_within(Bounds::range(0.05, 50)));
  c->add_flag("--json", v.atoms.json, "With --relax: JSON");
  c->add_flag("--force", v.atoms.force, "Replace existing files");
  c->callback([&v] { v.code = atoms_command(v.atoms); });
}

void add_coarsen(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "coarsen", "Atoms as elements: tubes found in LAMMPS data files, dumps or XYZ become a run, or a state");
  c->add_option("files", v.coarsen.files,
                "Files of one simulation: LAMMPS data, LAMMPS text dumps, XYZ or extended XYZ; lengths in Angstrom")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* out = c->add_option("-o,--out", v.coarsen.out,
                                   "Directory of the run to make, for observe, report, view and compare");
  c->add_option("--state", v.coarsen.state, "Write the last frame as a state (CSV), from which a scene can start")
      ->excludes(out);
  c->add_option("--parameters", v.coarsen.parameters,
                "Parameter sets, one for each (n,m) [default: shipped ones of what is found]")
      ->delimiter(',');
  c->add_option("--element-length-nm", v.coarsen.element_length,
                "Length of an element [default: the set's, of the first kind of tube]")
      ->check(number_within(Bounds::range(0.3, 50)));
  c->add_option("--time-step-fs", v.coarsen.time_step_fs, "Time step of the MD, for dumps without ITEM: TIME")
      ->capture_default_str()
      ->check(number_within(Bounds::positive(1e6)));
  c->add_flag("--json", v.coarsen.json, "What was found, as JSON");
  c->add_flag("--force", v.coarsen.force, "Replace an earlier run in --out, or the file");
  c->add_flag("--quiet", v.coarsen.quiet, "Do not list the tubes");
  c->callback([&v] { v.code = coarsen_command(v.coarsen); });
}

void add_energy(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "energy", "Energies (eV), forces (eV/nm) and torques (eV) of one state: CSV tube,x_nm,y_nm,z_nm,qw,qx,qy,qz");
  c->add_option("state", v.energy.state, "State file; the tube axis is the body's z")->required();
  c->add_option("--parameters", v.energy.options.parameters,
                "Parameter set: a file, or the name of a shipped one; several, separated by commas, for tube types")
      ->delimiter(',')
      ->required();
  c->add_option("--tube-types", v.energy.options.tube_types,
                "Number of the parameter set of each tube, from 0: 0,1,1 [default: all 0]")
      ->delimiter(',');
  c->add_option("--law", v.energy.options.law,
                "Contact law: line, paper or none [default: line where the set has it]");
  c->add_option("--bond", v.energy.options.bond,
                "harmonic or anharmonic [default: anharmonic where the set has it]")
      ->check(CLI::IsMember({"harmonic", "anharmonic"}));
  c->add_option("--element-length-nm", v.energy.options.element_length,
                "Length of an element [default: what the state file says, else the set's]")
      ->check(number_within(Bounds::range(0.05, 50)));
  c->add_option("--free-length-nm", v.energy.options.free_length,
                "Free length of the tubes between their clamps; long tubes collapse at less twist than short ones "
                "[default: the whole length]")
      ->check(number_within(Bounds::positive()));
  c->add_option("--exclude-along-tube-nm", v.energy.options.exclude_along_tube,
                "Parts of one tube up to this far apart along it do not attract [default: as a scene has it]")
      ->check(number_within(Bounds::positive()));
  c->add_option("--threads", v.energy.threads, "Threads [default: all cores]")->check(thread_range());
  c->add_flag("--legacy-torque", v.energy.options.legacy_torque,
              "Leave out the torque that the published code leaves out");
  c->add_flag("--reference", v.energy.options.reference, "The plain O(N^2) path instead of the fast one");
  c->add_flag("--json", v.energy.json, "JSON");
  c->callback([&v] { v.code = energy_command(v.energy); });
}

void add_sweep(CLI::App& app, Verbs& v) {
  CLI::App* c =
      app.add_subcommand("sweep", "Run a scene for many values of its keys, each point in a directory of its own");
  c->add_option("file", v.sweep.file, "Sweep (TOML): scene = \"rope.toml\", then [vary] with rope.tubes = [7, 19]")
      ->required();
  c->add_option("--out", v.sweep.out, "Directory of the campaign, where the same command goes on [default: FILE]");
  c->add_option("-j,--jobs", v.sweep.jobs, "Runs at a time, each on one core [default: all cores]")
      ->check(thread_range());
  c->add_flag("--dry-run", v.sweep.dry_run, "Only list the points and what they cost");
  c->add_option("--only", v.sweep.only, "Points by name, or by number from 1")->delimiter(',');
  c->add_flag("--again", v.sweep.again, "Run failed points once more");
  c->add_option("--on-limit", v.sweep.on_limit, "What points do where a limit of [limits] is passed: warn or stop")
      ->capture_default_str()
      ->check(CLI::IsMember({"warn", "stop"}));
  c->add_option("--slurm", v.sweep.slurm, "Only write a SLURM array with a job for each point to this file");
  c->add_option("--snakemake", v.sweep.snakemake, "Only write a Snakemake file to this file");
  c->add_flag("--force", v.sweep.force, "Replace points that were run with another scene");
  c->add_flag("--quiet", v.sweep.quiet, "No progress line");
  c->callback([&v] { v.code = sweep_command(v.sweep); });
}

void add_threshold(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "threshold",
      "The critical value of a key at each point of a sweep, by bisection, beside theory: a phase diagram");
  c->add_option("file", v.threshold.file,
                "Sweep (TOML) with [threshold]: key, from, to, and column and above, or shape")
      ->required();
  c->add_option("--out", v.threshold.out,
                "Directory of the campaign, where the same command goes on [default: FILE]");
  c->add_option("-j,--jobs", v.threshold.jobs, "Points at a time, each on one core [default: all cores]")
      ->check(thread_range());
  c->add_option("--known", v.threshold.known,
                "trials.csv of an earlier search: its trials of the same scenes are not run again")
      ->check(CLI::ExistingFile);
  c->add_option("--only", v.threshold.only, "Numbers from 1 or names of the points to search")->delimiter(',');
  c->add_option("--slurm", v.threshold.slurm, "Only write a SLURM array with a job for each point to this file");
  c->add_option("--snakemake", v.threshold.snakemake, "Only write a Snakemake file to this file");
  c->add_flag("--theory", v.threshold.theory,
              "Run nothing: tables and page of theory and of the runs that are there");
  c->add_flag(
      "--static", v.threshold.by_statics,
      "Run nothing: find, by statics, between which values the equilibrium without friction loses its stability");
  c->add_flag("--force", v.threshold.force, "Replace runs of another scene");
  c->add_flag("--quiet", v.threshold.quiet, "No progress");
  c->callback([&v] { v.code = threshold_command(v.threshold); });
}

void add_rest(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "rest", "Where a rope under a moment comes to rest: approached from below and from above, beside theory");
  c->add_option("scene", v.rest.scene, "Scene (TOML): a [rope] with [twist]")->required();
  c->add_option("--out", v.rest.out, "Directory of both runs; the same command goes on [default: runs/NAME-rest]");
  c->add_option("--viscosity", v.rest.viscosity,
                "Contact viscosity (eV ps/nm^3) [default: the scene's, or a tenth of the default]")
      ->check(CLI::NonNegativeNumber);
  c->add_option("--tolerance", v.rest.tolerance,
                "Relative tolerance of the twist: of a side, to be at rest, and of both, to agree")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 0.5));
  c->add_option("-j,--jobs", v.rest.jobs, "Runs at a time [default: one for each core]")->check(thread_range());
  c->add_flag(
      "--static", v.rest.by_statics,
      "By Newton's method, without runs: the equilibrium states without friction, and whether they are stable");
  c->add_flag("--force", v.rest.force, "Replace runs of another scene");
  c->add_flag("--json", v.rest.json, "JSON");
  c->add_flag("--quiet", v.rest.quiet, "No progress");
  c->callback([&v] { v.code = rest_command(v.rest); });
}

void add_modes(CLI::App& app, Verbs& v) {
  CLI::App* c =
      app.add_subcommand("modes", "Small motions that grow out of a state at rest: their rates and what they move");
  c->add_option("path", v.modes.path,
                "Directory of a run, whose newest checkpoint counts, or a scene (TOML) at its start")
      ->required()
      ->check(CLI::ExistingPath);
  c->add_option("--count", v.modes.count, "Eigenvalues to find")
      ->capture_default_str()
      ->check(whole_number(1, 200));
  c->add_option("--shift", v.modes.shift,
                "Find the motions with growth rates nearest to this one (1/ns); choose it above the largest rate")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1e5));
  c->add_flag("--anyway", v.modes.anyway, "Also for a state that is not at rest, as if it stood still");
  c->add_option("--csv", v.modes.csv, "Write the table to this file");
  c->add_option("--frame", v.modes.frame,
                "Write the state moved along the leading mode to this file (CSV), from which a scene can start");
  c->add_option("--amplitude", v.modes.amplitude, "Largest displacement of an element in that state, nm")
      ->capture_default_str()
      ->check(CLI::Range(1e-9, 1.0));
  c->add_option("--threads", v.modes.threads, "Threads [default: all cores]")->check(thread_range());
  c->add_flag("--force", v.modes.force, "Replace existing files");
  c->callback([&v] {
    wait_briefly(v.argv, v.modes.threads);
    v.code = modes_command(v.modes);
  });
}

void add_gather(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("gather", "One table (CSV) of all points of a campaign, at their ends");
  c->add_option("dir", v.gather.dir, "Directory of the campaign")->required();
  c->add_option("-o", v.gather.out, "File to write [default: the terminal]");
  c->add_option("--columns", v.gather.columns, "Columns of log.csv [default: all]")->delimiter(',');
  c->add_option("--mean", v.gather.mean_ps, "Means over the last rows of so much time, ps [default: the last row]")
      ->check(number_within(Bounds::positive()));
  c->add_flag("--series", v.gather.series, "All rows of all logs instead of the ends");
  c->add_flag("--force", v.gather.force, "Replace the file");
  c->callback([&v] { v.code = gather_command(v.gather); });
}

// An option of earlier versions: refused with what to do instead.
void add_retired(CLI::App* c, const std::string& name, const std::string& remedy) {
  c->add_option_function<std::string>(
       name,
       [name, remedy](const std::string&) { throw InputError({"", 0, name}, "is no option any more", remedy); }, "")
      ->expected(0, 1)
      ->group("");
}

// A verb of earlier versions.
void add_plan(CLI::App& app) {
  CLI::App* c = app.add_subcommand("plan", "")->group("");
  c->allow_extras();
  c->callback([] {
    throw InputError({"", 0, "plan"}, "is no verb any more: the default model is what it chose in most scenes",
                     "run the scene, and hold the run against a finer model: ropewalk check RUN --accuracy");
  });
}

void add_export(CLI::App& app, Verbs& v) {
  CLI::App* c =
      app.add_subcommand("export", "Write a scene, or the present state of a run, for lmp-ropewalk (MPI)");
  c->add_option("scene", v.to_lammps.scene, "Scene file (TOML), or the directory of a run")->required();
  c->add_option("--lammps", v.to_lammps.lammps, "Directory to make: data, input and a README that says how to run")
      ->required();
  c->add_flag("--force", v.to_lammps.force, "Replace an earlier run or export in it");
  c->callback([&v] { v.code = export_command(v.to_lammps); });
}

void add_import(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand(
      "import", "Take the results of lmp-ropewalk into the run, to observe, report or resume it");
  c->add_option("dir", v.from_lammps.dir, "Directory of the export, in which lmp-ropewalk has run")->required();
  c->add_flag("--accept-changes", v.from_lammps.accept_changes,
              "Take the states although in.rope, or what it reads, is not what was exported");
  c->callback([&v] { v.code = import_command(v.from_lammps); });
}

void add_bench(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("bench", "Time the steps of a scene");
  c->add_option("scene", v.bench.scene, "Scene file (TOML), or a name of --list");
  c->add_flag("--list", v.bench.list, "List the scenes that have a name");
  c->add_option("--law", v.bench.law, "Contact law of a named scene: line or paper [default: line]")
      ->check(CLI::IsMember({"line", "paper"}));
  c->add_option("--steps", v.bench.steps, "Time steps")->capture_default_str()->check(whole_number(1));
  c->add_option("--after", v.bench.after,
                "Time that the scene runs before it is measured, ps [default: as --list has it, or 0]")
      ->check(number_within(Bounds::non_negative()));
  c->add_option("--threads", v.bench.threads, "Threads; 1,2: both, one after the other [default: 1]")
      ->delimiter(',')
      ->check(thread_range());
  add_instructions(c, v.bench.instructions, "the contact", instruction_sets().front());
  add_device(c, v.bench.device, "none");
  c->add_flag("--json", v.bench.json, "JSON");
  const std::string export_it = "export the scene (ropewalk export SCENE --lammps DIR) and read LAMMPS's own \"Loop time\"";
  add_retired(c, "--lammps", export_it);
  add_retired(c, "--plain", export_it);
  add_retired(c, "--parts", export_it + " on several ranks");
  c->callback([&v] {
    wait_briefly(v.argv, *std::max_element(v.bench.threads.begin(), v.bench.threads.end()));
    v.code = bench_command(v.bench);
  });
}

std::vector<std::string> listed_verbs(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    names.push_back(verb->get_name());
  return names;
}

// Help on the keys of a scene. verb_before_help() gives the help of verbs.
void add_help(CLI::App& app, Verbs& v) {
  CLI::App* c = app.add_subcommand("help", "The help of a verb; help scene: every key of a scene, with its unit");
  c->add_option("topic", v.help_topic,
                "A verb; scene; a table of a scene, as links or [run]; one of its keys; or a limit that a run has "
                "passed [default: the list of verbs]");
  c->callback([&app, &v] {
    if (v.help_topic == "scene") {
      std::puts(scene_key_help().c_str());
      return;
    }
    std::string text;  // one word may be a table, a key and a limit
    for (const std::string& part :
         {table_help(v.help_topic), load_help(v.help_topic), scene_key_help(v.help_topic), limit_help(v.help_topic)})
      text += (text.empty() || part.empty() ? "" : "\n") + part;
    if (!text.empty()) {
      std::fputs(text.c_str(), stdout);
      return;
    }
    std::vector<std::string> topics = listed_verbs(app);
    topics.emplace_back("scene");
    for (const std::string& limit : limit_headings()) topics.push_back(limit);
    for (const SceneTable& t : scene_tables()) {
      topics.push_back(t.name.empty() ? "top" : t.name);
      for (const SceneKey& k : t.keys) topics.push_back(k.key);
    }
    const std::string near = nearest_word(v.help_topic, topics);
    throw InputError({"", 0, "help"}, "there is nothing on \"" + printable(v.help_topic, 60) + "\"",
                     near.empty() ? "see ropewalk help" : "did you mean " + near + "?");
  });
}

// For describe json: the keys of a scene, and the limits that a run watches.
nlohmann::ordered_json scenes_and_limits() {
  auto scene = nlohmann::ordered_json::array(), limits = scene;
  for (const SceneTable& t : scene_tables()) {
    auto keys = nlohmann::ordered_json::array();
    for (const SceneKey& k : t.keys)
      keys.push_back({{"key", k.key},
                      {"unit", k.unit},
                      {"standard", k.standard.empty() ? k.value : k.standard},
                      {"meaning", k.meaning}});
    auto parts = nlohmann::ordered_json::array();
    for (const TablePart& part : table_parts(t)) parts.push_back({{"heading", part.heading}, {"text", part.text}});
    scene.push_back(
        {{"table", t.name.empty() ? "" : t.header()}, {"meaning", t.meaning}, {"keys", keys}, {"parts", parts}});
  }
  for (const LimitKind& kind : limit_kinds())
    limits.push_back({{"key", kind.key},
                      {"unit", kind.unit},
                      {"what", kind.what},
                      {"consequence", kind.consequence},
                      {"remedy", kind.remedy}});
  return {{"scene", scene}, {"described_tables", described_tables()}, {"limits", limits}};
}

Description description() {
  std::vector<std::string> kinds;
  for (const SceneTemplate& t : scene_templates()) kinds.push_back(t.name);
  const std::vector<std::string> sets = shipped_sets();
  return {"ropewalk",
          version,
          scene_key_help(),
          scenes_and_limits(),
          {{"--kind", kinds}, {"--parameters", sets}, {"compare", sets}},
          {"calibrate", "validate"}};
}

// "help run" as "run --help", and "help" as "--help".
void verb_before_help(const CLI::App& app, int argc, char** argv) {
  static char help[] = "--help";
  if (argc < 2 || argc > 3 || std::string(argv[1]) != "help") return;
  if (argc == 2) argv[1] = help;
  const std::vector<std::string> verbs = listed_verbs(app);
  if (argc == 2 || !std::count(verbs.begin(), verbs.end(), argv[2])) return;
  argv[1] = argv[2];
  argv[2] = help;
}

}  // namespace

int main(int argc, char** argv) {
  begin_program("ropewalk");
  CLI::App app(
      "ropewalk twists carbon-nanotube ropes by the mesoscopic distinct element method.\n"
      "Units: nm, ps, eV; moments nN nm. Every key of a scene carries its unit: ropewalk help scene.\n"
      "Exit code: 0 done, 2 wrong input, 3 stopped with the reason, 4 not relaxed within run.max_steps, 5 stopped "
      "at a limit, 6 stopped by --wall-time, 7 done but more than three times beyond a limit, 8 done but not as "
      "[[expect]] says, 128 + signal.");
  keep_help_within_width(app);
  app.set_version_flag("--version", fmt::format("ropewalk {} ({}), {}, {}, {}", version, git_id, compiler,
                                                build_type, instruction_sets().front()));
  app.require_subcommand(1);
  Verbs verbs;
  verbs.argv = argv;
  add_new(app, verbs);
  add_check(app, verbs);
  add_run(app, verbs);
  add_resume(app, verbs);
  add_observe(app, verbs);
  add_report(app, verbs);
  add_convert(app, verbs);
  add_picture(app, verbs);
  add_view(app, verbs);
  add_errors(app, verbs);
  add_compare(app, verbs);
  add_sweep(app, verbs);
  add_threshold(app, verbs);
  add_rest(app, verbs);
  add_modes(app, verbs);
  add_gather(app, verbs);
  add_cite(app, verbs);
  add_plan(app);
  add_export(app, verbs);
  add_import(app, verbs);
  add_atoms(app, verbs);
  add_coarsen(app, verbs);
  // Handed over before anything is parsed; named here for --help.
  app.add_subcommand("calibrate", "Derive a parameter set for any (n,m) from atomistic data");
  app.add_subcommand("validate", "Hold the model against theory, atoms and other codes");
  app.add_subcommand("parametrize",
                     "From a chirality to a validated parameter set: calibrate, make atoms, validate");
  add_energy(app, verbs);
  add_bench(app, verbs);
  add_help(app, verbs);
  add_describe(app, description);
  try {
    refuse_control_characters(argv);
    verb_before_help(app, argc, argv);
    hand_over_to_sibling(argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return code_at_exit("ropewalk", app.exit(e));
    std::fprintf(stderr, "ropewalk: %s\n", usage_error(app, e, "ropewalk").c_str());
    return 2;
  } catch (const std::exception& e) {
    return report_error("ropewalk", e);
  }
  return code_at_exit("ropewalk", verbs.code);
}
