#include "run/run_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/files.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "scene/kinds/state.hpp"
#include "scene/own_parts.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* of_a_run = "of a run";

// A * of the pattern stands for a number.
bool fits(const std::string& name, const std::string& pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos) return name == pattern;
  const std::string end = pattern.substr(star + 1);
  if (name.size() <= star + end.size() || name.compare(0, star, pattern, 0, star) != 0 ||
      name.compare(name.size() - end.size(), end.size(), end) != 0)
    return false;
  const std::string number = name.substr(star, name.size() - star - end.size());
  return number.find_first_not_of("0123456789") == std::string::npos;
}

bool is_run_file(const std::string& file_name) {
  const std::string whole = without_part(file_name), name = whole.empty() ? file_name : whole;
  return is_lock_file(name) ||
         std::any_of(run_files().begin(), run_files().end(), [&](const auto& f) { return fits(name, f.name); });
}

bool ends_in(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Contents of the directory `errors`: errors.json and numerics.json, the directories of the runs behind numerics.json,
// and for each run behind errors.json NAME-plus.toml and the directory NAME-plus.
bool is_errors_file(const std::string& name) {
  for (const char* run : {"half-elements", "half-step", "half-rate", "tenth-tolerance", "start-*"})
    if (fits(name, run)) return true;
  for (const char* side : {"-plus", "-minus"})
    if (ends_in(name, side) || ends_in(name, std::string(side) + ".toml")) return true;
  const std::string whole = without_part(name);
  return name == "errors.json" || name == "numerics.json" || (!whole.empty() && is_errors_file(whole));
}

bool belongs_to_a_run(const std::string& inside) {
  const fs::path path = inside;
  std::vector<std::string> parts;
  for (const fs::path& part : path) parts.push_back(part.string());
  if (parts.size() == 1) return is_run_file(parts[0]);
  if (parts[0] != "errors" || parts.size() > 3) return false;
  return is_errors_file(parts[1]) && (parts.size() == 2 || is_run_file(parts[2]));
}

}  // namespace

std::string RunDirectory::frames(FrameFormat format) const {
  return file(format == FrameFormat::gsd ? "frames.gsd" : "frames.lammpstrj");
}

std::string RunDirectory::frames() const {
  const std::string gsd = frames(FrameFormat::gsd), dump = frames(FrameFormat::dump);
  return !fs::exists(gsd) && fs::exists(dump) ? dump : gsd;
}

const std::vector<OutputFile>& run_files() {
  static const std::vector<OutputFile> files = {
      {"scene.toml", "run", "the scene"},
      {"parameters.toml", "run", "the parameter set of the first type of tube"},
      {"parameters-*.toml", "run", "the parameter sets of further types, from 1"},
      {"friction-*.toml", "run", "friction of pairs of tubes, of a scene that takes it from files, from 0"},
      {"state.csv", "run", "the start, of a scene that reads its state from a file"},
      {"state-memory.csv", "run", "what friction, links and tethers remember at that start"},
      {"log.csv", "run", "observables against time"},
      {"frames.gsd", "run", "elements against time, for OVITO and MDAnalysis"},
      {"frames.lammpstrj", "run, convert", "the same as text, for LAMMPS, ASE and OVITO"},
      {"equilibria.csv", "run", "states of rest along the schedules of the loads, of a scene with [statics]"},
      {"events.csv", "run", "links that formed and broke, and tubes that broke, with time and place"},
      {"limits.json", "run", "limits that were watched and passed, and refinements"},
      {"manifest.json", "run", "program, inputs and how the run ended"},
      {"checkpoint.bin", "run", "binary: where `resume` goes on"},
      {"checkpoint-before.bin", "run", "binary: the checkpoint before it, which `resume` takes where it has to"},
      {lock_name, "run, import", "names the process that works here; there only as long as it does"},
      {"report.html", "run, report", "page with charts, pictures and all observables"},
      {"view.html", "view", "page that shows the frames in space"},
      {"errors.csv", "errors", "standard errors of the observables by those of the inputs, as log.csv"},
      {"errors-potential.csv", "errors", "their errors by the spread between interatomic potentials, as log.csv"},
      {"errors-numerics.csv", "errors", "their errors by elements, time step and rate, as log.csv"},
      {"errors-statistics.csv", "errors", "their errors by other starts and random numbers, as log.csv"},
      {"errors", "errors", "directory with the runs behind these files, errors.json and numerics.json"},
      {"changed.toml", "errors", "in the runs behind errors.csv: the set, file or scene with its changed number"},
      {"final.csv", "run, import", "the state at the end: the start of another scene by [state]"},
      {"final-memory.csv", "run, import",
       "what friction, links and tethers remember there; it belongs beside `final.csv`"},
      {"failed-state.csv", "run", "the state of a run that failed"},
      {"failed-state-memory.csv", "run", "what friction, links and tethers remember there"},
      {"found-tubes.csv", "coarsen", "the tubes that were found in the first frame, and their defects"},
      {"sections.csv", "coarsen", "radius, ovality and shear of the elements' atoms, means over the frames"},
      {"README.txt", "export", "how to run LAMMPS here"},
      {"in.rope", "export", "input of LAMMPS"},
      {"job.sh", "export", "a job for SLURM that runs it"},
      {"rope.state", "export", "binary: the state where LAMMPS begins"},
      {"tubes.csv", "export", "tubes, by kind"},
      {"lammps.json", "export", "where the run stands"},
      {"lammps.states", "lmp-ropewalk", "binary: states against time, from the last of which LAMMPS goes on"},
      {"lammps-rows.csv", "lmp-ropewalk", "energies against time"},
      {"log.lammps", "lmp-ropewalk", "log of LAMMPS"},
  };
  return files;
}

std::string run_files_markdown() {
  std::string text = "| name | left by | for |\n|---|---|---|\n";
  for (const OutputFile& f : run_files()) text += fmt::format("| `{}` | {} | {} |\n", f.name, f.by, f.meaning);
  return text;
}

DirectoryLock create_run_directory(const RunDirectory& dir, bool force) {
  std::error_code error;
  const bool there = fs::exists(dir.path, error);
  if (there && !fs::is_directory(dir.path, error))
    throw InputError({dir.path, 0, "--out"}, "exists and is not a directory", "choose another name");
  if (there && !force && !fs::is_empty(dir.path, error))
    throw InputError(
        {dir.path, 0, "--out"}, "is not empty",
        "choose another name, give --force to replace an earlier run, or go on with `ropewalk resume`");
  refuse_foreign(dir.path, belongs_to_a_run, of_a_run, "--force");
  fs::create_directories(dir.path, error);
  if (error)
    throw InputError({dir.path, 0, "--out"}, fmt::format("cannot be made: {}", error.message()),
                     remedy_for_errno(error.value()));
  DirectoryLock lock(dir.path);
  remove_inside(dir.path, belongs_to_a_run, of_a_run, "--force", is_lock_file);
  return lock;
}

void empty_run_directory(const RunDirectory& dir) {
  remove_inside(dir.path, belongs_to_a_run, of_a_run, "", is_lock_file);
}

void remove_run(const RunDirectory& dir, const char* option) {
  if (!fs::exists(dir.path)) return;
  refuse_strange_files(dir);
  refuse_foreign(dir.path, belongs_to_a_run, of_a_run, option);
  {
    const DirectoryLock lock(dir.path);
    remove_inside(dir.path, belongs_to_a_run, of_a_run, option, is_lock_file);
  }
  std::error_code error;
  fs::remove(dir.path, error);
  if (error) throw file_error(dir.path, "cannot be removed", error.value());
}

void refuse_strange_files(const RunDirectory& dir) {
  std::error_code error;
  for (fs::directory_iterator at(dir.path, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (is_run_file(name)) refuse_strange(at->path().string(), name == "errors");
  }
  for (fs::directory_iterator at(dir.file("errors"), error), end; !error && at != end; at.increment(error)) {
    const bool run = fs::is_directory(at->path());
    refuse_strange(at->path().string(), run);
    if (run) refuse_strange_files({at->path().string()});
  }
}

void remove_run_parts(const RunDirectory& dir) {
  std::error_code error;
  std::vector<fs::path> parts;
  for (fs::directory_iterator at(dir.path, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!without_part(name).empty() && is_run_file(name)) parts.push_back(at->path());
  }
  for (const fs::path& path : parts) fs::remove(path, error);
}

bool has_checkpoint(const RunDirectory& dir) {
  return fs::exists(dir.checkpoint()) || fs::exists(dir.checkpoint_before());
}

void copy_parameters(const Scene& scene, const RunDirectory& to) {
  for (std::size_t k = 0; k < scene.sets.size(); ++k)
    write_file_atomically(to.parameters(k), read_file(scene.sets[k].path));
  const std::vector<std::string> files = scene.files_of_drives();
  for (std::size_t k = 0; k < files.size(); ++k) write_file_atomically(to.friction(k), read_file(files[k]));
}

void refuse_other_program(const RunDirectory& dir) {
  if (!fs::exists(dir.manifest())) return;
  const Manifest m = read_manifest(dir.manifest());
  refuse_missing_parts(m.own_parts, m.program, dir.path);
}

Scene read_run_scene(const RunDirectory& dir) {
  refuse_strange_files(dir);
  refuse_other_program(dir);
  if (!fs::exists(dir.scene()))
    throw InputError({dir.path, 0, ""}, "is not the directory of a run (no scene.toml in it)",
                     "name the directory that `ropewalk run --out` made");
  std::vector<std::string> sets = {dir.parameters(0)};
  while (fs::exists(dir.parameters(sets.size()))) sets.push_back(dir.parameters(sets.size()));
  Scene scene = read_scene(dir.scene(), sets);
  if (scene.from_file()) scene.source = std::make_shared<StateSource>(dir.state(), dir.state_memory());
  // A scene without a name has that of its file, which here is always scene.toml.
  if (fs::exists(dir.manifest())) {
    const Manifest m = read_manifest(dir.manifest());
    scene.name = m.scene;
    scene.missing_forces = m.own_forces;
  }
  return scene;
}

Observer make_observer(const Scene& scene, const Prepared& prepared) {
  Observer o;
  o.spacing = prepared.spacing;
  o.neighbour_radius = scene.observe.neighbour_radius > 0 ? scene.observe.neighbour_radius
                                                          : 0.5 * (1.0 + std::sqrt(3.0)) * prepared.spacing;
  // Inner tubes are those of the packing, whatever radius is typed for Q.
  o.shells = rope_shells(prepared.topology, prepared.state, 0.5 * (1.0 + std::sqrt(3.0)) * prepared.spacing);
  o.loading =
      loading_reference(prepared.topology, prepared.state, o.shells, ends_of(prepared.loads, prepared.topology),
                        o.spacing, o.neighbour_radius, prepared.interaction.law);
  o.size = rope_size(prepared.topology, o.loading.cells, scene.run.mass_scale);
  return o;
}

RopeObservation observe(const Observer& o, const Scene& scene, const Topology& topology, const State& state) {
  return observe(topology, state, o.shells, validities(scene, topology), o.neighbour_radius, o.spacing);
}

Watched watched_by_run(const Scene& scene, const Prepared& prepared, const Observer& o) {
  Watched out = watched_of(scene, prepared.topology, prepared.loads, prepared.interaction.law.get());
  if (o.loading.law && !o.loading.core.empty())
    out.pressures = [topology = prepared.topology, reference = o.loading](const State& state) {
      return tube_pressures(topology, state, reference);
    };
  return out;
}

LogRow log_row(const Observer& o, const Scene& scene, const Topology& topology, const State& state,
               const EnergyAccount& account) {
  return LogRow(
      {topology, state, observe(o, scene, topology, state), loading(topology, state, o.loading), o.size, account});
}

}  // namespace ropewalk
