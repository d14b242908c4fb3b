// The directory of one run and its files.
#pragma once

#include <string>
#include <vector>

#include "io/frames/frames.hpp"
#include "io/log.hpp"
#include "io/manifest.hpp"
#include "observe/loading.hpp"
#include "observe/observe.hpp"
#include "run/directory_lock.hpp"
#include "scene/prepare.hpp"

namespace ropewalk {

struct RunDirectory {
  std::string path;

  std::string file(const char* name) const { return path + "/" + name; }
  std::string log() const { return file("log.csv"); }
  std::string frames(FrameFormat format) const;
  std::string frames() const;  // that is there; where there are none, those of GSD
  std::string checkpoint() const { return file("checkpoint.bin"); }
  std::string checkpoint_before() const { return file("checkpoint-before.bin"); }
  std::string manifest() const { return file("manifest.json"); }
  std::string scene() const { return file("scene.toml"); }
  std::string parameters(std::size_t type) const {
    return type == 0 ? file("parameters.toml") : path + "/parameters-" + std::to_string(type) + ".toml";
  }
  std::string friction(std::size_t k) const { return path + "/friction-" + std::to_string(k) + ".toml"; }
  std::string state() const { return file("state.csv"); }
  std::string state_memory() const { return file("state-memory.csv"); }
  std::string report() const { return file("report.html"); }
  std::string view() const { return file("view.html"); }
  std::string equilibria() const { return file("equilibria.csv"); }
  std::string events() const { return file("events.csv"); }
  std::string limits() const { return file("limits.json"); }
  std::string final_state() const { return file("final.csv"); }
  std::string final_memory() const { return file("final-memory.csv"); }
  std::string failed_state() const { return file("failed-state.csv"); }
};

// A file of a run directory; a * stands for a number. --force removes these files and nothing else.
struct OutputFile {
  const char* name;
  const char* by;  // the verb that writes it
  const char* meaning;
};
const std::vector<OutputFile>& run_files();
std::string run_files_markdown();  // the table in Markdown

// Makes the directory and locks it. Throws InputError if it holds an earlier run, unless `force` is set, if another
// process works there, and if it holds other files, even with `force`.
DirectoryLock create_run_directory(const RunDirectory& dir, bool force);

// Removes the directory of a run. Throws InputError, and removes nothing, where another process works there and
// where it holds anything else. No directory: nothing happens.
void remove_run(const RunDirectory& dir, const char* option);
// Removes all files of a run but the lock, which the caller holds.
void empty_run_directory(const RunDirectory& dir);
// Throws InputError where a file of a run is a link, a pipe or another thing that is no file. Called before any is
// read, since a directory may come from somebody else.
void refuse_strange_files(const RunDirectory& dir);
// Throws InputError where the program of the run has parts of its own (scene/own_parts.hpp) that this one lacks.
void refuse_other_program(const RunDirectory& dir);
// Removes what killed processes left half written.
void remove_run_parts(const RunDirectory& dir);

// Whether there is a checkpoint, of either generation.
bool has_checkpoint(const RunDirectory& dir);

// Copies to the directory the parameter sets of a scene and the files of its drives (Drive::files).
void copy_parameters(const Scene& scene, const RunDirectory& to);

// The scene as the run had it: scene.toml, parameters.toml and state.csv of the directory.
Scene read_run_scene(const RunDirectory& dir);

// The reference data of all observations in a run: shells and spacing (nm) of the untwisted rope, and the scene's
// neighbour radius (nm). The ends are those that grips hold, or else the first and last elements of all tubes.
struct Observer {
  RopeShells shells;
  double neighbour_radius = 0;
  double spacing = 0;
  RopeSize size;
  LoadingReference loading;
};
Observer make_observer(const Scene& scene, const Prepared& prepared);

RopeObservation observe(const Observer& observer, const Scene& scene, const Topology& topology, const State& state);
// The limits that a run watches, with the pressure on every tube.
Watched watched_by_run(const Scene& scene, const Prepared& prepared, const Observer& observer);
LogRow log_row(const Observer& observer, const Scene& scene, const Topology& topology, const State& state,
               const EnergyAccount& account);

// Warnings about the scene for readers of the results, one sentence each.
std::vector<std::string> warnings_of(const Scene& scene, const Prepared& prepared);
// "NAME: good" of each parameter set, see io/grade.hpp.
std::vector<std::string> grades_of(const Scene& scene);
// Error bars by registry, which the model leaves out, of the energies at the end of a run; a paragraph each.
std::vector<std::string> error_bars_of(const Scene& scene, const Topology& topology,
                                       const std::vector<LogRow>& log);

// report.html from the files of the directory: its text, and into its file.
std::string report_of(const RunDirectory& dir, const Scene& scene, const Prepared& prepared);
void write_report(const RunDirectory& dir, const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
