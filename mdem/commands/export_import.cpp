// `export` and `import`: a run goes to LAMMPS and comes back. An exported directory is a run directory like any
// other, with the files of scene/lammps_files.hpp beside those of a run.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>

#include "commands/commands.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "model/error.hpp"
#include "run/colours.hpp"
#include "run/limit_watch.hpp"
#include "run/origin_changes.hpp"
#include "run/run_checkpoint.hpp"
#include "run/tell.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

Simulation simulation_at(const RunDirectory& dir, const Scene& scene, const Prepared& p, const RunCheckpoint& c) {
  Simulation s = start(scene, p);
  try {
    s.restore(c.simulation);
  } catch (const std::runtime_error& e) {
    throw InputError({dir.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  return s;
}

// Where a run of this scene, and no other, stands.
RunCheckpoint checkpoint_of(const RunDirectory& dir, const Scene& scene) {
  check_log_header(dir.log());
  const ResumePoint point = find_resume_point(dir);
  RunOrigin origin = origin_of(dir, scene);
  origin.instructions = point.checkpoint.origin.instructions;  // LAMMPS has its own
  judge_changes(changes_of(point.checkpoint.origin, origin, dir), false, dir);
  for (const std::string& remark : point.remarks) tell("note: " + remark);
  return point.checkpoint;
}

// Of a run that stands somewhere: its files up to the checkpoint.
void copy_run(const RunDirectory& from, const RunDirectory& to) {
  const Scene scene = read_run_scene(from);
  const RunCheckpoint c = checkpoint_of(from, scene);
  const auto copy = [](const std::string& a, const std::string& b, std::uint64_t bytes) {
    write_file_atomically(b, std::string_view(read_file(a)).substr(0, bytes));
  };
  const auto all = std::string::npos;
  copy(from.scene(), to.scene(), all);
  for (std::size_t k = 0; k < scene.sets.size(); ++k) copy(from.parameters(k), to.parameters(k), all);
  if (fs::exists(from.state())) copy(from.state(), to.state(), all);
  if (fs::exists(from.limits())) copy(from.limits(), to.limits(), all);
  copy(from.log(), to.log(), c.log.bytes);
  const FrameFormat format = format_of(from.frames());
  NewFrames(to.frames(format), format, 0, from.frames(), c.frames.bytes).replace();
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
  start.viscosity_inner = scene.damping.contact.inner;
  start.viscosity_outer = scene.damping.contact.outer;
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

constexpr const char* readme =
    "Run:              lmp-ropewalk -in in.rope\n"
    "Run on N ranks:   mpirun -np N lmp-ropewalk -in in.rope\n"
    "Bring it back:    ropewalk import .      (then observe, report or resume this directory)\n";

void write_lammps_files(const RunDirectory& run) {
  const LammpsDirectory dir{run.path};
  Scene scene = read_run_scene(run);
  const Prepared p = prepare(scene);
  const Simulation s = simulation_at(run, scene, p, read_checkpoint(run));
  write_file_atomically(dir.start(), start_json(start_of(scene, s)));
  write_file_atomically(dir.tubes(), tubes_csv(p.topology));
  StateHeader header;
  header.step = s.state().step;
  header.elements = p.topology.elements();
  header.time = s.state().time;
  header.work = s.work();
  header.dissipated = s.dissipated();
  write_file_atomically(dir.first_state(), state_file(header, s.state(), s.forces().force, s.forces().torque, s.memory()));
  write_file_atomically(dir.input(), lammps_input(script_of(scene, p, s)));
  write_file_atomically(dir.readme(), readme);
}

}  // namespace

int export_command(const ExportArguments& a) {
  const RunDirectory to{a.lammps};
  if (fs::is_directory(a.scene)) {
    const RunDirectory from{a.scene};
    refuse_what_lammps_lacks(read_run_scene(from));
    read_checkpoint(from);
    if (fs::exists(to.path) && fs::equivalent(from.path, to.path))
      throw InputError({to.path, 0, "--lammps"}, "is the run itself", "choose another directory");
    const DirectoryLock lock = create_run_directory(to, a.force);
    copy_run(from, to);
  } else {
    refuse_what_lammps_lacks(read_scene(a.scene));
    RunArguments run;
    run.scene = a.scene;
    run.out = a.lammps;
    run.force = a.force;
    run.quiet = a.quiet;
    begin_run(run);
  }
  write_lammps_files(to);
  if (!a.quiet) fmt::print("{0} written. Go on with: cd {0} && mpirun -np 2 lmp-ropewalk -in in.rope\n", to.path);
  return 0;
}

namespace {

// What LAMMPS has left, added to the files of a run.
class Import {
 public:
  explicit Import(const std::string& path)
      : dir_{path},
        files_{path},
        lock_(path),
        scene_(read_run_scene(dir_)),
        prepared_(prepare(scene_)),
        observer_(make_observer(scene_, prepared_)),
        checkpoint_(checkpoint_of(dir_, scene_)),
        watch_(watched_by_run(scene_, prepared_, observer_)),
        start_(simulation_at(dir_, scene_, prepared_, checkpoint_)),
        reached_(start_.state().step),
        gauges_(start_.gauges()),
        first_(start(scene_, prepared_).forces().energy) {}

  int go() {
    const LammpsStart began = read_start(files_);
    if (began.time_step != prepared_.time_step)
      throw InputError({files_.start(), 0, "time_step_ps"}, "is not that of the scene",
                       "has scene.toml been changed? Export the run again");
    if (!fs::exists(files_.rows()) || !fs::exists(files_.states()))
      throw InputError({files_.path, 0, ""}, "holds nothing that LAMMPS has done",
                       "run in.rope with lmp-ropewalk first, as README.txt says");
    for (const LammpsRow& row : read_lammps_rows(files_, prepared_.interaction.terms.size()))
      rows_[static_cast<std::int64_t>(row.step)] = row;
    remove_parts(dir_.path);
    log_ = read_file(dir_.log()).substr(0, checkpoint_.log.bytes);
    const std::string there = dir_.frames();
    frames_ = std::make_unique<NewFrames>(there, format_of(there), 0, there, checkpoint_.frames.bytes);
    const std::int64_t from = reached_;
    watch_.inherit_from(checkpoint_.limits.limits, from);
    take_states(files_.states());
    if (reached_ == from)
      throw InputError({files_.states(), 0, ""}, fmt::format("holds no whole state after step {}", from),
                       "let LAMMPS run further, or go on with `ropewalk resume`");
    write(from);
    return 0;
  }

 private:
  void take_states(const std::string& path) {
    LammpsStates states(path, prepared_.topology);
    State state;
    Vec3Array force, torque;
    while (states.next(state, force, torque)) {
      const auto row = rows_.find(state.step);
      if (state.step <= reached_ || row == rows_.end()) continue;
      state.time = row->second.time;
      force_.force = force;
      force_.torque = torque;
      memory_ = states.memory();
      add(state, row->second);
    }
  }

  void add(const State& state, const LammpsRow& from) {
    EnergyAccount account;
    account.time_step = prepared_.time_step;
    if (const MomentRamp* ramp = scene_.moment_ramp()) account.moment = ramp->moment_at(from.time);
    account.potential = {from.stretch, from.shear, from.bend, from.twist, from.vdw,
                         std::accumulate(from.terms.begin(), from.terms.end(), 0.0)};
    account.terms = term_energies(prepared_.interaction, from.terms);
    account.kinetic = from.kinetic;
    account.work = from.work;
    account.dissipated = from.dissipated;
    account.first_energy = checkpoint_.first_energy;
    account.first = first_;
    account.ends = readings_at(state);
    log_ += log_line(log_row(observer_, scene_, prepared_.topology, state, account));
    check_limits(state, account);
    (*frames_)->write(prepared_.topology, state, element_colours(prepared_.topology, prepared_.interaction, state));
    prepared_.state = state;
    last_ = from;
    reached_ = state.step;
    ++taken_;
  }

  // LAMMPS watches no limits: they are looked for in the states that it left.
  void check_limits(const State& state, const EnergyAccount& account) {
    NeighbourList list(prepared_.interaction, default_skin(prepared_.interaction));
    list.build(prepared_.topology, state);
    const bool relax = scene_.run.mode == RunOptions::Mode::relax;
    const double drift = relax ? std::numeric_limits<double>::quiet_NaN() : energy_drift(account);
    for (const std::string& line : watch_.check(prepared_.topology, state, list, drift, true)) tell(line);
  }

  // What the forces of this moment say: LAMMPS keeps no means.
  EndReadings readings_at(const State& state) {
    gauges_.follow(state);
    gauges_.forget_work();
    gauges_.sums.since = state.time;
    std::vector<PointLoad> loads;
    point_loads(prepared_.loads, state, state.time, loads);
    return gauges_.read_still(
        state,
        reactions_at_rest(prepared_.topology, prepared_.loads, loaded_elements(prepared_.loads), force_, state),
        loads);
  }

  // All is made before the first file is touched, and the checkpoint is written last: until it is there the run
  // stands where it stood, and all of this can be done again.
  void write(std::int64_t from) {
    Simulation simulation = start(scene_, prepared_);
    simulation.remember(memory_);
    simulation.inherit_from(force_.force, force_.torque, {last_.work, last_.dissipated});
    simulation.inherit_from(gauges_.sums);
    checkpoint_.log = mark_of(log_);
    checkpoint_.frames = (*frames_)->mark();
    checkpoint_.mark = nullptr;
    checkpoint_.limits.limits = watch_.records();
    checkpoint_.simulation = simulation.serialise();
    Manifest m = read_manifest(dir_.manifest());
    m.steps = reached_;
    m.status = last_.time + 0.5 * prepared_.time_step >= prepared_.duration ? "finished" : "interrupted";
    m.reason = fmt::format("steps {} to {} by LAMMPS", from, reached_);
    const std::string final_state = state_csv(prepared_.topology, prepared_.state);
    write_file_atomically(dir_.log(), log_);
    frames_->replace();
    write_file_atomically(dir_.final_state(), final_state);
    write_file_atomically(dir_.limits(), limits_json(checkpoint_.limits));
    write_file_atomically(dir_.manifest(), manifest_json(m));
    write_checkpoint(dir_, checkpoint_);
    write_report(dir_, scene_, prepared_for_report());
    fmt::print("{} states taken over, up to step {}, {:.4g} ps. Report: {}\n", taken_, reached_, last_.time,
               dir_.report());
    if (const std::string passed = passed_words(watch_.records()); !passed.empty())
      fmt::print("Limits passed: {}\n", passed);
  }

  // The report compares with the state at time zero.
  Prepared prepared_for_report() {
    Scene scene = scene_;
    return prepare(scene);
  }

  RunDirectory dir_;
  LammpsDirectory files_;
  DirectoryLock lock_;
  Scene scene_;
  Prepared prepared_;
  Observer observer_;
  RunCheckpoint checkpoint_;
  LimitWatch watch_;
  Simulation start_;  // where the run stood
  std::int64_t reached_ = 0;
  Gauges gauges_;
  Energies first_;
  std::map<std::int64_t, LammpsRow> rows_;
  LammpsRow last_;
  Forces force_;
  std::vector<double> memory_;  // of the force terms, in the last state
  std::string log_;
  std::unique_ptr<NewFrames> frames_;
  long taken_ = 0;
};

}  // namespace

int import_command(const ImportArguments& a) {
  if (!fs::exists(LammpsDirectory{a.dir}.start()))
    throw InputError({a.dir, 0, ""}, "was not made by `ropewalk export` (no lammps.json in it)",
                     "name the directory behind --lammps");
  return Import(a.dir).go();
}

}  // namespace ropewalk
