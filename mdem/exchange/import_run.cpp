#include "exchange/import_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "exchange/export_run.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "model/error.hpp"
#include "run/colours.hpp"
#include "run/events_file.hpp"
#include "run/limit_watch.hpp"
#include "run/moving_scene.hpp"
#include "run/pending_files.hpp"
#include "run/period_energies.hpp"
#include "sim/dynamics/step_control.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "scene/state_csv.hpp"
#include "scene/state_files.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/state/part_of_scene.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* run_again = "take lammps.states and lammps-rows.csv away and run in.rope again";

class Import {
 public:
  Import(const RunDirectory& dir, RunListener& listener)
      : listener_(listener),
        dir_(dir),
        files_{dir.path},
        lock_(dir.path),
        scene_(read_run_scene(dir_)),
        prepared_(prepare(scene_)),
        observer_(make_observer(scene_, prepared_)),
        checkpoint_(checkpoint_to_export(dir_, scene_, listener)),
        watch_(watched_by_run(scene_, prepared_, observer_)),
        start_(simulation_at(dir_, scene_, prepared_, checkpoint_)),
        reached_(start_.state().step),
        gauges_(start_.gauges()),
        first_(start(scene_, prepared_).forces().energy),
        first_of_period_(energies_of_period(start(scene_, prepared_))) {}

  ImportedRun go(bool accept_changes) {
    const LammpsStart began = read_start(files_);
    if (began.time_step != prepared_.time_step)
      throw InputError({files_.start(), 0, "time_step_ps"}, "is not that of the scene",
                       "has scene.toml been changed? Export the run again");
    if (!fs::exists(files_.rows()) || !fs::exists(files_.states()))
      throw InputError({files_.path, 0, ""}, "holds nothing that LAMMPS has done",
                       "run in.rope with lmp-ropewalk first, as README.txt says");
    hold_to_export(began, accept_changes);
    for (const LammpsRow& row : read_lammps_rows(files_, prepared_.interaction.terms.size())) {
      hold_to_steps(began, row);
      rows_[static_cast<std::int64_t>(row.step)] = row;
    }
    remove_run_parts(dir_);
    log_ = read_file(dir_.log()).substr(0, checkpoint_.files.log.bytes);
    const std::string there = dir_.frames();
    if (checkpoint_.files.events.bytes > 0) {
      event_text_ = read_file(dir_.events()).substr(0, checkpoint_.files.events.bytes);
      const double until = start_.state().time;
      const std::vector<TubeBreak> breaks = tube_breaks(dir_.events());
      told_of_break_ = std::any_of(breaks.begin(), breaks.end(),
                                   [&](const TubeBreak& b) { return b.time_ps > 0 && b.time_ps <= until; });
    }
    frames_ = std::make_unique<NewFrames>(there, format_of(there), 0, there, checkpoint_.files.frames.bytes);
    const std::int64_t from = reached_;
    watch_.inherit_from(checkpoint_.limits.limits, from);
    mark_ = energy_mark(start_);
    marked_at_ = from;
    take_states(files_.states(), began.id);
    if (reached_ == from)
      throw InputError({files_.states(), 0, ""}, fmt::format("holds no whole state after step {}", from),
                       "let LAMMPS run further, or go on with `ropewalk resume`");
    write(from);
    return {taken_, reached_, last_.time, passed_words(watch_.records()), at_rest_};
  }

 private:
  void take_states(const std::string& path, std::uint64_t of_export) {
    LammpsStates states(path, prepared_.topology, of_export);
    State state;
    Vec3Array force, torque;
    while (states.next(state, force, torque)) {
      if (state.step <= reached_) continue;
      std::vector<double> memory = states.memory();
      take_events(memory, state, path);
      const auto row = rows_.find(state.step);
      if (row == rows_.end()) continue;
      state.time = row->second.time;
      force_.force = force;
      force_.torque = torque;
      steps_ = states.header();
      memory_ = std::move(memory);
      add(state, row->second);
    }
  }

  // Those since the state before. They count once a later state does.
  void take_events(std::vector<double>& memory, const State& state, const std::string& path) {
    try {
      for (TermEvent& e : ropewalk::take_events(memory, prepared_.topology.elements())) {
        if (!(e.time <= state.time + prepared_.time_step))
          throw std::runtime_error(fmt::format("it has an event at {:.9g} ps", e.time));
        events_.push_back(std::move(e));
      }
    } catch (const std::runtime_error& e) {
      throw InputError({path, 0, ""}, fmt::format("state of step {}: {}", state.step, e.what()), run_again);
    }
  }

  // Refuses files of LAMMPS that differ from those that the export wrote.
  void hold_to_export(const LammpsStart& began, bool accept_changes) const {
    for (const std::string& path : {files_.input(), files_.tubes(), files_.first_state()}) {
      const auto sum = began.sums.find(fs::path(path).filename().string());
      if (sum == began.sums.end() || (fs::exists(path) && hash_hex(read_file(path)) == sum->second)) continue;
      if (!accept_changes)
        throw InputError({path, 0, ""}, fs::exists(path) ? "is not as it was exported" : "is not there any more",
                         "bring it back, or give --accept-changes where the change does not move the elements");
      listener_.tell(fmt::format("note: {} is not as it was exported", path));
    }
  }

  void hold_to_steps(const LammpsStart& began, const LammpsRow& row) const {
    if (scene_.run.mode == RunOptions::Mode::relax) return;
    const double time = began.time + (row.step - static_cast<double>(began.step)) * began.time_step;
    if (!(std::fabs(row.time - time) <= 1e-6 * (std::fabs(time) + began.time_step)))
      throw InputError({files_.rows(), 0, "time_ps"},
                       fmt::format("is {:.9g} at step {:.0f}, which is at {:.9g} by the export", row.time, row.step,
                                   time),
                       run_again);
  }

  // Energies follow from a state, what it remembers, and the scene. Returns the tubes, cut where they have broken.
  Topology hold_to_scene(const State& state, const NeighbourList& list, const LammpsRow& row) const {
    Interaction in = prepared_.interaction;
    in.damping = {};
    Forces own(state.size());
    ForceEngine engine;
    try {
      engine.set_memory(in, memory_, prepared_.topology.elements());
      engine.prepare_again(prepared_.topology, list, state);
    } catch (const std::runtime_error& e) {
      throw InputError({files_.states(), 0, ""}, fmt::format("state of step {}: {}", state.step, e.what()), run_again);
    }
    engine.compute(prepared_.topology, in, list, state, own);
    const double bonds = row.stretch + row.shear + row.bend + row.twist;
    for (const auto& [name, here, there] : {std::tuple{"bonds", own.energy.bonds(), bonds},
                                            std::tuple{"contacts", own.energy.vdw, row.vdw},
                                            std::tuple{"motion", kinetic_energy(prepared_.topology, state), row.kinetic}})
      if (!(std::fabs(here - there) <= 1e-4 * (1 + std::fabs(here))))
        throw InputError({files_.rows(), 0, ""},
                         fmt::format("has {:.9g} eV in {} at step {:.0f}, and the state of that step has {:.9g} by "
                                     "the scene",
                                     there, name, row.step, here),
                         run_again);
    const std::vector<char>* broken = engine.terms().broken_bonds();
    return broken ? cut_behind(prepared_.topology, *broken) : prepared_.topology;
  }

  void add(const State& state, const LammpsRow& from) {
    NeighbourList list(prepared_.interaction, default_skin(prepared_.interaction));
    list.build(prepared_.topology, state);
    const Topology tubes_now = hold_to_scene(state, list, from);
    EnergyAccount account;
    account.time_step = prepared_.time_step;
    account.moment = moment_at(end_drives(prepared_.loads, prepared_.topology), from.time);
    account.potential = {from.stretch, from.shear, from.bend,
                         from.twist,   from.vdw,   std::accumulate(from.terms.begin(), from.terms.end(), 0.0)};
    account.terms = term_readings(prepared_.interaction, from.terms, from.accounts);
    account.kinetic = from.kinetic;
    account.work = from.work;
    account.dissipated = from.dissipated;
    account.heat = from.heat;
    account.first_energy = checkpoint_.first_energy;
    account.first = first_;
    account.ends = readings_at(state);
    if (first_of_period_)
      account.period = EnergyAccount::Period{*energies_of_period(prepared_.topology, tubes_now, prepared_.interaction, state,
                                                                 account.potential.terms),
                                             *first_of_period_};
    log_ += log_line(log_row(observer_, scene_, tubes_now, state, account));
    check_limits(tubes_now, state, list, account);
    check_account(account, state.step);
    (*frames_)->write(prepared_.topology, state,
                      element_colours(prepared_.topology, prepared_.interaction, state, tubes_now));
    add_events();
    prepared_.state = state;
    last_ = from;
    reached_ = state.step;
    ++taken_;
  }

  void add_events() {
    if (events_.empty()) return;
    if (event_text_.empty()) event_text_ = events_header();
    event_text_ += event_lines(prepared_.topology, events_);
    const auto first = std::find_if(events_.begin(), events_.end(), is_break);
    if (!told_of_break_ && first != events_.end()) {
      listener_.tell(fmt::format("the first tube broke at {:.4g} ps: {}; events.csv lists every break", first->time,
                                 place_in_words(prepared_.topology, watch_.held(), first->a)));
      told_of_break_ = true;
    }
    events_.clear();
  }

  // LAMMPS watches no limits: they are looked for in the states that it left.
  void check_limits(const Topology& tubes_now, const State& state, const NeighbourList& list,
                    const EnergyAccount& account) {
    const bool relax = scene_.run.mode == RunOptions::Mode::relax;
    const RunEnergies energies = relax ? RunEnergies() : RunEnergies{energy_drift(account), account.kinetic};
    for (const std::string& line : watch_.check(prepared_.topology, tubes_now, state, list, energies, true))
      listener_.tell(line);
  }

  // Judges the energy balance as the step control of `run` does, over a window of at least the same length.
  void check_account(const EnergyAccount& account, std::int64_t step) {
    if (scene_.run.mode == RunOptions::Mode::relax || step < marked_at_ + StepControl::window) return;
    const EnergyMark now{account.potential.potential() + account.kinetic,
                         {account.work, account.dissipated, account.heat}};
    const bool closes = account_closes(mark_, now, account.kinetic, account.potential.bonds(),
                                       account.potential.vdw, prepared_.state.size());
    if (!closes && !told_of_account_)
      listener_.tell(fmt::format(
          "note: from step {} to {} the energy balance does not close: set run.time_step_fs to half of {:.4g}, and "
          "export and run it again",
          marked_at_, step, prepared_.time_step / units::fs));
    told_of_account_ = told_of_account_ || !closes;
    mark_ = now;
    marked_at_ = step;
  }

  // Readings by the forces of this moment: LAMMPS keeps no means. The run may have been stopped between two rows:
  // what it had summed up since the last one belongs to no row.
  EndReadings readings_at(const State& state) {
    gauges_.follow(state);
    gauges_.forget_work();
    for (Gauges::Sum& sum : gauges_.sums.of) sum.force_time = sum.torque_time = {};
    gauges_.sums.since = state.time;
    std::vector<PointLoad> loads;
    point_loads(prepared_.loads, state, state.time, loads);
    return gauges_.read_still(
        state,
        reactions_at_rest(prepared_.topology, prepared_.loads, loaded_elements(prepared_.loads), force_, state),
        loads);
  }

  // An import that was killed has left what this one writes, or the beginning of it.
  void refuse_strange_events() const {
    if (checkpoint_.files.events.bytes > 0 || !fs::exists(dir_.events())) return;
    if (event_text_.rfind(read_file(dir_.events()), 0) != 0)
      throw InputError({dir_.events(), 0, ""}, "has events of another run: this one had none when it was exported",
                       "take the file away");
  }

  // All is made before the first file is touched, and the checkpoint is written last: until it is there the run
  // stands where it stood, and all of this can be done again.
  void write(std::int64_t from) {
    refuse_strange_events();
    Simulation simulation = start(scene_, prepared_);
    simulation.set_memory(memory_);
    simulation.divide_steps(static_cast<int>(steps_.divided));
    simulation.inherit_from(force_.force, force_.torque, {last_.work, last_.dissipated, last_.heat});
    simulation.inherit_from(gauges_.sums);
    checkpoint_.files.log = mark_of(log_);
    checkpoint_.files.frames = (*frames_)->mark();
    if (!event_text_.empty()) checkpoint_.files.events = mark_of(event_text_);
    checkpoint_.files.log.step = checkpoint_.files.frames.step = reached_;
    checkpoint_.snapshot = nullptr;
    checkpoint_.control = steps_.control();
    checkpoint_.ends_for = StopReason::none;
    checkpoint_.limits.limits = watch_.records();
    checkpoint_.simulation = simulation.serialise();
    Manifest m = read_manifest(dir_.manifest());
    m.steps = reached_;
    m.status = last_.time + 0.5 * prepared_.time_step >= prepared_.duration ? "finished" : "interrupted";
    m.reason = fmt::format("steps {} to {} by LAMMPS", from, reached_);
    const StateFiles end = state_files(simulation, dir_.final_state());
    if (scene_.run.mode == RunOptions::Mode::relax) judge_rest(simulation, m);
    write_file_atomically(dir_.log(), log_);
    if (!event_text_.empty()) write_file_atomically(dir_.events(), event_text_);
    frames_->replace();
    if (!end.memory.empty()) write_file_atomically(dir_.final_memory(), end.memory);
    write_file_atomically(dir_.final_state(), end.state);
    write_file_atomically(dir_.limits(), limits_json(checkpoint_.limits));
    write_file_atomically(dir_.manifest(), manifest_json(m));
    write_checkpoint(dir_, checkpoint_);
    report_or_tell(dir_, listener_, [&] { write_report(dir_, scene_, prepared_for_report()); });
  }

  // LAMMPS relaxes until forces are small. That the energy of the bonds is near the minimum's is looked for here.
  void judge_rest(Simulation& simulation, Manifest& m) {
    const Relaxed end = simulation.relax(scene_.run.goal, 0, [](long) { return true; });
    at_rest_ = end.at_rest;
    if (at_rest_) return;
    m.status = "not relaxed";
    m.reason += fmt::format(
        ", which looks at forces alone: the largest is {:.3g} eV/nm, and the energy of the bonds is known within "
        "{:.2g} of its value, {:.2g} asked for",
        end.force, end.error, scene_.run.goal.energy);
    listener_.tell(fmt::format("note: not at rest after {}; go on: ropewalk resume {}", m.reason, dir_.path));
  }

  // The report compares with the state at time zero.
  Prepared prepared_for_report() {
    Scene scene = scene_;
    return prepare(scene);
  }

  RunListener& listener_;
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
  std::optional<Energies> first_of_period_;  // none: no slice
  std::map<std::int64_t, LammpsRow> rows_;
  LammpsRow last_;
  EnergyMark mark_;  // before the states that are not judged yet
  std::int64_t marked_at_ = 0;
  bool told_of_account_ = false, told_of_break_ = false, at_rest_ = true;
  Forces force_;
  std::vector<double> memory_;  // force terms' memory in the last state
  StateHeader steps_;           // header of the last state: into how many parts steps are divided
  std::vector<TermEvent> events_;  // since the last state that was taken
  std::string log_, event_text_;
  std::unique_ptr<NewFrames> frames_;
  long taken_ = 0;
};

}  // namespace

ImportedRun import_run(const RunDirectory& dir, bool accept_changes, RunListener& listener) {
  return Import(dir, listener).go(accept_changes);
}

}  // namespace ropewalk
