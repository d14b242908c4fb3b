#include "exchange/export_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "model/error.hpp"
#include "run/begin_run.hpp"
#include "run/origin_changes.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// The files of a run up to its checkpoint.
void copy_run(const RunDirectory& from, const RunDirectory& to, RunListener& listener) {
  const Scene scene = read_run_scene(from);
  const RunCheckpoint c = checkpoint_to_export(from, scene, listener);
  const auto copy = [](const std::string& a, const std::string& b, std::uint64_t bytes) {
    write_file_atomically(b, std::string_view(read_file(a)).substr(0, bytes));
  };
  const auto all = std::string::npos;
  copy(from.scene(), to.scene(), all);
  copy_parameters(scene, to);
  if (fs::exists(from.state_memory())) copy(from.state_memory(), to.state_memory(), all);
  if (fs::exists(from.state())) copy(from.state(), to.state(), all);
  if (fs::exists(from.limits())) copy(from.limits(), to.limits(), all);
  copy(from.log(), to.log(), c.files.log.bytes);
  if (c.files.events.bytes > 0) copy(from.events(), to.events(), c.files.events.bytes);
  const FrameFormat format = format_of(from.frames());
  NewFrames(to.frames(format), format, 0, from.frames(), c.files.frames.bytes).replace();
  copy(from.manifest(), to.manifest(), all);
  write_checkpoint(to, c);
}

LammpsStart start_of(const Scene& scene, const Simulation& s) {
  LammpsStart start;
  start.step = s.state().step;
  start.time = s.state().time;
  start.time_step = s.time_step();
  start.work = s.work();
  start.dissipated = s.dissipated();
  start.heat = s.heat();
  start.lineage = scene.lineage;
  const TubeGroups& groups = s.topology().groups;
  if (!groups.strand_begin.empty())
    start.strand_begin.assign(groups.strand_begin.begin(), groups.strand_begin.end() - 1);
  start.strand_holes = groups.strand_holes;
  start.images = groups.images;
  start.period = groups.period;
  start.viscosity_inner = scene.damping.contact.inner;
  start.viscosity_outer = scene.damping.contact.outer;
  const bool others_break = std::any_of(scene.drives.begin(), scene.drives.end(),
                                        [](const auto& drive) { return drive->table().name == "failure"; });
  start.tubes_came_broken = !scene.memory.broken.empty() && !others_break;
  const RunDirectory here{"."};
  for (std::size_t k = 0; k < scene.sets.size(); ++k)
    start.parameters.push_back(fs::path(here.parameters(k)).filename().string());
  return start;
}

std::int64_t steps_between(double interval, double duration, double parts, double dt) {
  return std::max<std::int64_t>(1, std::llround((interval > 0 ? interval : duration / parts) / dt));
}

constexpr std::int64_t relax_every = 1000;  // steps

LammpsScript script_of(const Scene& scene, const Prepared& p, const Simulation& s) {
  const Interaction& in = p.interaction;
  LammpsScript script;
  script.name = scene.name;
  script.law = scene.contact.law;
  script.relax = scene.run.mode == RunOptions::Mode::relax;
  script.terms = static_cast<int>(in.terms.size());
  script.damped = in.damped_contact() || in.damping.bond.rate > 0 || in.damping.local > 0;
  script.driven = !p.loads.empty();
  script.long_in_z = scene.source->is_parallel();
  script.types = static_cast<int>(p.topology.types.size());
  // A single straight tube needs a box that is wide.
  constexpr double margin = 1;  // nm
  const Vec3Array& x = s.state().position;
  const auto range = [](const Column& c) { return std::minmax_element(c.begin(), c.end()); };
  const auto [x0, x1] = range(x.x);
  const auto [y0, y1] = range(x.y);
  const auto [z0, z1] = range(x.z);
  script.low = Vector3(*x0, *y0, *z0) - Vector3::Constant(margin);
  script.high = Vector3(*x1, *y1, *z1) + Vector3::Constant(margin);
  script.skin = default_skin(in);
  script.reach = copy_reach(p.topology, in, 0);
  script.excluded_elements = p.topology.fewest_within(in.excluded_arc());
  script.time_step = s.time_step();
  script.first_step = s.state().step;
  const double dt = s.time_step(), span = p.duration > 0 ? p.duration : 1000 * dt;
  script.steps = script.relax ? scene.run.max_steps : std::llround(p.duration / dt) - s.state().step;
  script.every = script.relax ? relax_every : steps_between(scene.run.frames_every, span, 40, dt);
  return script;
}

std::uint64_t id_of(const RunDirectory& run, const LammpsStart& start, const std::string& tubes,
                    const std::string& state) {
  std::string sums = hash_hex(read_file(run.scene())) + hash_hex(tubes) + hash_hex(state);
  for (const std::string& set : start.parameters) sums += hash_hex(read_file(run.path + "/" + set));
  return std::stoull(hash_hex(sums), nullptr, 16);
}

constexpr const char* readme =
    "Run:              lmp-ropewalk -in in.rope\n"
    "Run on N ranks:   mpirun -np N lmp-ropewalk -in in.rope      (or, with SLURM: sbatch job.sh)\n"
    "Bring it back:    ropewalk import .      (then observe, report or resume this directory)\n";

void write_lammps_files(const RunDirectory& run, RunListener& listener) {
  const LammpsDirectory dir{run.path};
  Scene scene = read_run_scene(run);
  const Prepared p = prepare(scene);
  const RunCheckpoint c = read_checkpoint(run);
  const Simulation s = simulation_at(run, scene, p, c);
  StateHeader header;
  header.step = s.state().step;
  header.elements = p.topology.elements();
  header.time = s.state().time;
  header.work = s.work();
  header.dissipated = s.dissipated();
  header.heat = s.heat();
  header.set(s.divided(), c.control);
  LammpsStart start = start_of(scene, s);
  const LammpsScript script = script_of(scene, p, s);
  const double apart = static_cast<double>(script.every) * script.time_step;
  if (const double wanted = scene.run.log_every; wanted > 0 && wanted < apart * (1 - 1e-9) && !script.relax)
    listener.tell(fmt::format("note: a row of the log needs a state, and LAMMPS writes one every {:.4g} ps: "
                              "log_every_ps = {:.4g} has no say; for as many rows set run.frames_every_ps = {:.4g} "
                              "and export again",
                              apart, wanted, wanted));
  const std::string tubes = tubes_csv(p.topology);
  const auto state = [&] { return state_file(header, s.state(), s.forces().force, s.forces().torque, s.memory()); };
  start.id = header.of_export = id_of(run, start, tubes, state());
  for (const auto& [path, content] : {std::pair{dir.tubes(), tubes}, std::pair{dir.first_state(), state()},
                                      std::pair{dir.input(), lammps_input(script)}}) {
    start.sums[fs::path(path).filename().string()] = hash_hex(content);
    write_file_atomically(path, content);
  }
  write_file_atomically(dir.start(), start_json(start));
  write_file_atomically(dir.job(), lammps_job(script, p.topology.elements()));
  write_file_atomically(dir.readme(), readme);
}

void refuse_full(const RunDirectory& to, bool force) {
  std::error_code error;
  if (!force && fs::is_directory(to.path, error) && !fs::is_empty(to.path, error))
    throw InputError({to.path, 0, "--lammps"}, "is not empty",
                     "choose another directory, or give --force to replace an earlier run or export");
}

}  // namespace

RunCheckpoint checkpoint_to_export(const RunDirectory& dir, const Scene& scene, RunListener& listener) {
  check_log_header(dir.log());
  const ResumePoint point = find_resume_point(dir);
  RunOrigin origin = origin_of(dir, scene);
  origin.instructions = point.checkpoint.origin.instructions;  // LAMMPS has its own
  const std::vector<std::string> changes =
      judged_changes(changes_of(point.checkpoint.origin, origin, dir), false, dir);
  for (const std::string& note : changes) listener.tell("note: " + note);
  for (const std::string& note : point.remarks) listener.tell("note: " + note);
  return point.checkpoint;
}

void export_scene(const Scene& scene, const RunDirectory& to, bool force, RunListener& listener) {
  refuse_what_lammps_lacks(scene);
  refuse_full(to, force);
  RunSettings settings;
  settings.force = force;
  // LAMMPS goes on with it, or `resume`.
  begin_run(scene, to, settings, listener)->write_manifest("interrupted", "not yet run");
  write_lammps_files(to, listener);
}

void export_run(const RunDirectory& from, const RunDirectory& to, bool force, RunListener& listener) {
  refuse_what_lammps_lacks(read_run_scene(from));
  read_checkpoint(from);
  if (fs::exists(to.path) && fs::equivalent(from.path, to.path))
    throw InputError({to.path, 0, "--lammps"}, "is the run itself", "choose another directory");
  refuse_full(to, force);
  const DirectoryLock lock = create_run_directory(to, force);
  copy_run(from, to, listener);
  write_lammps_files(to, listener);
}

}  // namespace ropewalk
