// `run` and `resume`: the loop around the simulation, its files and its signals.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>

#include "commands/commands.hpp"
#include "io/failure.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/frames/vtp.hpp"
#include "io/growing_file.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "plan/forecast.hpp"
#include "run/colours.hpp"
#include "run/limit_watch.hpp"
#include "run/origin_changes.hpp"
#include "run/pending_files.hpp"
#include "run/plan_check.hpp"
#include "run/progress.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_directory.hpp"
#include "run/stages.hpp"
#include "run/stop_watch.hpp"
#include "run/tell.hpp"
#include "run/wall_time.hpp"
#include "scene/finer.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "scene/watch.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/dynamics/refine.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string iso_time() {
  const std::time_t t = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&t));
  return text;
}

long every(double interval, double duration, long parts, double dt) {
  const double chosen = interval > 0 ? interval : duration / static_cast<double>(parts);
  return std::max(1L, std::lround(chosen / dt));
}

// What the command line asks for.
struct RunPolicy {
  bool quiet = false;
  OnLimit on_limit = OnLimit::warn;
  bool force = false;
  double wall_time = 0;  // s, since the program was started; 0: any
};

enum class StopReason { none, complete, signal, limit, refine, wall_time };

// Steps between two checks of the limits, at most: a check costs about as much as a step.
constexpr long check_every = 128, pause_every = 16;
constexpr double patience = 0.5;  // s, of who wants to stop a run
// Exit codes.
constexpr int stopped_with_reason = 3, stopped_at_limit = 5, stopped_by_wall_time = 6;

class Run {
 public:
  Run(RunDirectory dir, Scene scene, RunPolicy policy)
      : dir_(std::move(dir)),
        scene_(std::move(scene)),
        prepared_(prepare(scene_)),
        observer_(make_observer(scene_, prepared_)),
        simulation_(start(scene_, prepared_)),
        watch_(watched_by_run(scene_, prepared_, observer_)),
        stop_watch_(scene_.stops),
        policy_(policy) {
    first_ = simulation_.forces().energy;
    set_intervals();
    last_step_ = relaxes() ? -1 : step_at(prepared_.duration);
  }

  // From now on no other process writes in the directory.
  void hold(DirectoryLock lock) { lock_ = std::move(lock); }

  // A negative value means that the option was not given.
  void stop_at(long steps, double ps) {
    if (ps >= 0 && relaxes()) throw InputError({"", 0, "--until"}, "a relaxation has no time", "take --steps");
    if (ps >= 0) last_step_ = step_at(ps);
    if (steps >= 0) last_step_ = steps;
  }

  // Refuses an end that lies behind a run that goes on.
  void check_end_lies_ahead(long steps, double ps) const {
    const State& at = simulation_.state();
    if ((steps < 0 && ps < 0) || last_step_ > at.step) return;
    // Killed where it was to end anyway: what is left is to say so.
    if (last_step_ == at.step &&
        (!std::filesystem::exists(dir_.manifest()) || read_manifest(dir_.manifest()).status == "running"))
      return;
    throw InputError(
        {"", 0, ps >= 0 && steps < 0 ? "--until" : "--steps"},
        fmt::format("ends at step {}, and the run stands at step {}, {:.4g} ps", last_step_, at.step, at.time),
        "choose a later end, or run the scene anew");
  }

  // Refuses what the run could not carry out, before any file is written.
  void check_before_start() const {
    refuse_cooling(scene_, prepared_);
    if (policy_.on_limit != OnLimit::refine) return;
    const std::string why = why_not_finer(scene_, prepared_.topology);
    if (!why.empty()) throw InputError({"", 0, "--on-limit"}, "refine: " + why, "take warn or stop");
  }

  void say_notes() const {
    if (!policy_.quiet)
      for (const std::string& grade : grades_of(scene_)) tell("parameters " + grade);
    for (const auto& notes :
         {warnings_of(scene_, prepared_), warmth_of(scene_, prepared_), limits_ahead(scene_, prepared_)})
      for (const std::string& note : notes) tell("note: " + note);
  }

  void begin() {
    origin_ = origin_of(dir_, scene_);
    first_energy_ = simulation_.total_energy();
    begin_files();
  }

  void restore(RunCheckpoint c) {
    try {
      if (c.mark) {
        simulation_.restore(c.mark->simulation);
        mark_.energy = energy_mark(simulation_);
      }
      simulation_.restore(c.simulation);
    } catch (const std::runtime_error& e) {
      throw InputError({dir_.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
    }
    keep_time_step();
    first_energy_ = c.first_energy;
    earlier_seconds_ = c.wall_seconds;
    control_ = c.control;
    origin_ = origin_of(dir_, scene_);
    open(c.log.bytes, c.frames.bytes);
    watch_.inherit_from(c.limits.limits, simulation_.state().step);
    refinements_ = c.limits.refinements;
    if (!stop_watch_.empty())
      for (const LogRow& earlier : read_log(dir_.log())) stop_watch_.add(earlier);
    // What was passed, and only said, may be cured now.
    if (policy_.on_limit == OnLimit::refine && passed_what_finer_cures()) at_once_ = check_limits(true);
    saved_step_ = written_step_ = simulation_.state().step;
    if (c.mark)
      mark_.checkpoint = c.mark;
    else
      set_mark();
    // Left by the end that it had before; written anew at the next.
    std::error_code ignored;
    for (const std::string& path : {dir_.final_state(), dir_.plan_check()}) std::filesystem::remove(path, ignored);
  }

  void announce() {
    write_manifest("running", "");
    write_limits();
  }

  // For somebody else to go on with.
  void leave() { write_manifest("interrupted", "not yet run"); }

  // `next`: the run in which it goes on, elements split.
  struct Result {
    int code = 0;
    std::unique_ptr<Run> next;
  };
  Result go() {
    started_ = now();
    try {
      switch (relaxes() ? relax_loop() : dynamics_loop()) {
        case StopReason::complete:
          return {finish(), nullptr};
        case StopReason::limit:
          return {stopped(), nullptr};
        case StopReason::refine:
          return {0, refined()};
        case StopReason::wall_time:
          return {interrupted(stopped_by_wall_time, "by --wall-time"), nullptr};
        case StopReason::signal:
        case StopReason::none:
          break;
      }
      return {interrupted(128 + stop_signal, fmt::format("by signal {}", static_cast<int>(stop_signal))), nullptr};
    } catch (const NumericalError& e) {
      return {failed(e), nullptr};
    } catch (const std::exception& e) {
      return {broken_off(failure_words(e)), nullptr};
    }
  }

 private:
  void open(std::uint64_t log_bytes, std::uint64_t frame_bytes) {
    log_ = std::make_unique<GrowingFile>(dir_.log(), log_bytes);
    const std::string there = dir_.frames();
    const FrameFormat format = std::filesystem::exists(there) ? format_of(there) : scene_.run.frames_format;
    frames_ = frame_writer(dir_.frames(format), format, frame_bytes, expected_frames_);
  }

  // Up to the checkpoint at the start, from which even the first minute can be resumed.
  void begin_files() {
    write_manifest("running", "");  // before the checkpoint: it has the name of the scene
    open(0, 0);
    log_->write(log_header());
    write_row();
    write_frame();
    written_step_ = simulation_.state().step;
    if (!relaxes() && simulation_.state().step < last_step_ && std::isfinite(simulation_.total_energy()))
      at_once_ = check_limits(true);
    save();
  }

  bool relaxes() const { return scene_.run.mode == RunOptions::Mode::relax; }

  void set_intervals() {
    const double dt = prepared_.time_step;
    const double span = prepared_.duration > 0 ? prepared_.duration : 1000 * dt;
    log_every_ = every(scene_.run.log_every, span, 400, dt);
    frames_every_ = every(scene_.run.frames_every, span, 40, dt);
    expected_frames_ = static_cast<std::size_t>(span / dt / static_cast<double>(frames_every_));
  }

  // The checkpoint may be of a scene with another time step, which then stays.
  void keep_time_step() {
    if (simulation_.time_step() == prepared_.time_step) return;
    const double limit = prepared_.limit.limit, step = simulation_.time_step();
    if (step >= limit)
      throw InputError({dir_.checkpoint(), 0, ""},
                       fmt::format("has a time step of {:.4g} fs, and the changed scene bears less than {:.4g} fs",
                                   step / units::fs, limit / units::fs),
                       "start the run anew with `ropewalk run`");
    tell(fmt::format("note: the time step stays {:.4g} fs", step / units::fs));
    prepared_.time_step = simulation_.time_step();
    counted_from_ = {simulation_.state().step, simulation_.state().time};
    set_intervals();
    if (!relaxes()) last_step_ = step_at(prepared_.duration);
  }

  // Steps are counted from zero, but where the time step was another one before.
  long step_at(double ps) const {
    return counted_from_.step + std::lround((ps - counted_from_.time) / prepared_.time_step);
  }

  bool passed_what_finer_cures() const {
    for (std::size_t k = 0; k < watch_.records().size(); ++k)
      if (watch_.records()[k].passed && limit_kinds()[k].cured_by_finer) return true;
    return false;
  }

  // Says what is passed for the first time, and whether the run is to end here for it.
  StopReason check_limits(bool with_pressure) {
    const std::vector<std::string> passed =
        watch_.check(prepared_.topology, simulation_.state(), simulation_.list(), drift(), with_pressure);
    for (const std::string& line : passed) tell(line);
    if (!passed.empty()) write_limits();
    if (policy_.on_limit == OnLimit::stop && !passed.empty()) return StopReason::limit;
    if (policy_.on_limit != OnLimit::refine || !watch_.finer_would_help()) return StopReason::none;
    const std::string why = why_not_finer(scene_, prepared_.topology);
    if (why.empty()) return StopReason::refine;
    if (!passed.empty()) tell("not refined: " + why + "; the run goes on as it is");
    return StopReason::none;
  }

  // Until something is written or checked, or somebody waits for an answer.
  long steps_to_next_check(long checked_every, double seconds_of_a_step) const {
    const long step = static_cast<long>(simulation_.state().step);
    long count = last_step_ - step;
    for (const long every : {checked_every, log_every_, frames_every_, pause_every, StepControl::window})
      count = std::min(count, every - step % every);
    return std::min(count, std::max(2L, static_cast<long>(patience / seconds_of_a_step)));
  }

  StopReason dynamics_loop() {
    Progress progress(policy_.quiet, static_cast<double>(simulation_.state().step),
                      static_cast<double>(last_step_));
    double checkpoint_at = now() + scene_.run.checkpoint_every;
    const long checked_every = std::min(log_every_, check_every);
    StopReason stop = StopReason::none;  // it ends after a step with energies: this one, or the next
    if (at_once_ != StopReason::none) return at_once_;
    if (!mark_.checkpoint) set_mark();
    double seconds = patience;  // of a step
    while (simulation_.state().step < last_step_) {
      const long count = stop == StopReason::none ? steps_to_next_check(checked_every, seconds) : 1;
      const std::int64_t step = simulation_.state().step + count;
      const bool last = step == last_step_, logged = step % log_every_ == 0 || last || stop != StopReason::none;
      const bool marked = step % StepControl::window == 0;
      const double began = now();
      try {
        simulation_.steps(count, logged || marked || last);
      } catch (const NumericalError& e) {
        if (!go_back(e.what())) throw;
        stop = StopReason::none;
        continue;
      }
      if ((marked || last) && !is_sound() && go_back("the account of energy did not close")) {
        stop = StopReason::none;
        continue;
      }
      seconds = std::max((now() - began) / static_cast<double>(count), 1e-9);
      if (stop == StopReason::none && (logged || step % checked_every == 0))
        stop = check_limits(last || step % frames_every_ == 0);
      if (last && stop == StopReason::refine) stop = StopReason::none;
      const bool ends = logged && stop != StopReason::none;
      if (logged) write_row();
      if (logged && !last && stop == StopReason::none && is_decided()) {
        write_frame();
        progress.done();
        return StopReason::complete;
      }
      if (step % frames_every_ == 0 || last || ends) write_frame();
      if (ends) return stop;
      if (stop_signal) return StopReason::signal;
      if (time_is_up()) return StopReason::wall_time;
      if (progress.due()) progress.show(static_cast<double>(step), status_text());
      if (marked) {
        control_.lengthen(simulation_);
        set_mark();
      }
      if (step % pause_every == 0 && now() > checkpoint_at) {
        save_if_possible();
        checkpoint_at = now() + scene_.run.checkpoint_every;
      }
    }
    progress.done();
    return StopReason::complete;
  }

  // --- The step that follows the motion ---

  // A state to go back to, and what a run knew there.
  struct Mark {
    std::shared_ptr<const RunCheckpoint> checkpoint;
    EnergyMark energy;
    std::int64_t step = 0;
  };

  void set_mark() {
    mark_.checkpoint = std::make_shared<const RunCheckpoint>(checkpoint_here());
    mark_.energy = energy_mark(simulation_);
    mark_.step = simulation_.state().step;
  }

  // A model that gains energy has no account to close.
  bool is_sound() const { return scene_.contact.legacy_torque || account_closes(mark_.energy, simulation_); }

  // False where steps are as short as they get: the failure stands.
  bool go_back(const std::string& why) {
    const int divided = simulation_.divided();
    const double time = simulation_.state().time;
    if (divided >= StepControl::most) return false;
    const RunCheckpoint& c = *mark_.checkpoint;
    simulation_.restore(c.simulation);
    control_.shorten(divided, simulation_);
    watch_.inherit_from(c.limits.limits, simulation_.state().step);
    stop_watch_.cut(simulation_.state().step);
    // A checkpoint later than this would know of more than the files then hold.
    if (saved_step_ > simulation_.state().step) write_state(c.log, c.frames);
    log_->cut(c.log.bytes);
    frames_->cut(c.frames.bytes);
    // The remedy, after the semicolon of the message, is left out: a shorter step is what the run takes now.
    tell(fmt::format("{:.4g} ps: {}; back to {:.4g} ps, on with steps of {:.3g} fs", time,
                     why.substr(0, why.find(';')), simulation_.state().time,
                     simulation_.time_step() / simulation_.divided() / units::fs));
    return true;
  }

  StopReason relax_loop() {
    Progress progress(policy_.quiet, 0, 0);
    StopReason stop = StopReason::none;
    const RelaxGoal& goal = scene_.run.goal;
    const auto began = static_cast<long>(simulation_.relaxation_began());
    const long max_steps = last_step_ >= 0 ? std::max(0L, last_step_ - began) : scene_.run.max_steps;
    double checkpoint_at = now() + scene_.run.checkpoint_every;
    const Relaxed end = simulation_.relax(goal, max_steps, [&](long k) {
      if (k % 100 == 0) {
        if (simulation_.state().step != written_step_) write_row();
        stop = check_limits(false);
        set_mark();
      }
      if (progress.due()) progress.show(static_cast<double>(k), relax_text());
      if (stop == StopReason::none && stop_signal) stop = StopReason::signal;
      if (stop == StopReason::none && time_is_up()) stop = StopReason::wall_time;
      if (stop == StopReason::none && k % pause_every == 0 && now() > checkpoint_at) {
        save_if_possible();
        checkpoint_at = now() + scene_.run.checkpoint_every;
      }
      return stop == StopReason::none;
    });
    progress.done();
    // In the middle of the relaxation, from where `resume` goes on.
    if (stop == StopReason::signal || stop == StopReason::wall_time) return stop;
    simulation_.end_relaxation();
    if (simulation_.state().step != written_step_) {
      write_row();
      write_frame();
    }
    if (stop == StopReason::none) stop = check_limits(true);
    if (stop != StopReason::none) return stop;
    at_rest_ = end.at_rest;
    const std::string left = fmt::format(
        "{:.2g} eV above the minimum, that of the bonds within {:.2g} of its value", end.above, end.error);
    if (at_rest_ && std::isinf(end.above))
      reason_ = fmt::format(
          "relaxed: largest force {:.3g} eV/nm; on a saddle, or along some soft motion the energy may still fall",
          end.force);
    else if (at_rest_)
      reason_ = fmt::format("relaxed: largest force below {:.3g} eV/nm; energy {}, by estimate", goal.force, left);
    else
      reason_ = fmt::format("not relaxed after {} steps: largest force {:.3g} eV/nm, {:.3g} asked for", max_steps,
                            end.force, goal.force);
    if (!at_rest_ && std::isinf(end.above))
      reason_ += "; the energy may still fall along some motion: no minimum is near";
    else if (!at_rest_ && std::isfinite(end.above))
      reason_ += fmt::format("; energy {}, {:.2g} asked for", left, goal.energy);
    return StopReason::complete;
  }

  std::string relax_text() const {
    const Energies& e = simulation_.forces().energy;
    return fmt::format("twist {:.0f}  bend {:.0f}  vdW {:.0f} eV", e.twist, e.bend, e.vdw);
  }

  std::string status_text() const {
    const State& s = simulation_.state();
    std::string text = fmt::format("{:8.2f} ps", s.time);
    if (const MomentRamp* ramp = scene_.moment_ramp())
      text += fmt::format("  moment {:5.1f} nN nm", ramp->moment_at(s.time) / units::nN_nm);
    return text + fmt::format("  beta {:5.1f} deg  Q {}  twist {:.0f}  bend {:.0f}  vdW {:.0f} eV",
                              last_row_["beta_deg"], last_row_["Q"], last_row_["twist_eV"], last_row_["bend_eV"],
                              last_row_["vdw_eV"]);
  }

  EnergyAccount account() const {
    const State& s = simulation_.state();
    EnergyAccount account;
    account.time_step = simulation_.time_step() / simulation_.divided();
    if (const MomentRamp* ramp = scene_.moment_ramp()) account.moment = ramp->moment_at(s.time);
    account.potential = simulation_.forces().energy;
    account.terms = term_energies(prepared_.interaction, simulation_.forces().term_energy);
    account.kinetic = kinetic_energy(prepared_.topology, s);
    account.work = simulation_.work();
    account.dissipated = simulation_.dissipated();
    account.heat = simulation_.heat();
    account.first_energy = first_energy_;
    account.first = first_;
    return account;
  }

  // NaN where it is not judged: in a relaxation, which makes its account close, and in the first window of the step
  // control, where next to nothing has moved.
  double drift() const {
    const std::int64_t step = simulation_.state().step;
    const bool relax = scene_.run.mode == RunOptions::Mode::relax;
    if (relax || (step < StepControl::window && step != last_step_))
      return std::numeric_limits<double>::quiet_NaN();
    return energy_drift(account());
  }

  LogRow row() {
    EnergyAccount now = account();
    now.ends = simulation_.read_gauges();
    return log_row(observer_, scene_, prepared_.topology, simulation_.state(), now);
  }

  bool is_decided() {
    if (stop_watch_.empty()) return false;
    reason_ = stop_watch_.decided(watch_.records());
    return !reason_.empty();
  }

  void write_row() {
    last_row_ = row();
    stop_watch_.add(last_row_);
    log_->write(log_line(last_row_));
  }

  void write_frame() {
    const ElementColours colours = element_colours(prepared_.topology, prepared_.interaction, simulation_.state());
    frames_->write(prepared_.topology, simulation_.state(), colours);
    if (!scene_.run.paraview) return;
    std::error_code error;
    std::filesystem::create_directories(dir_.paraview(), error);
    if (error) throw file_error(dir_.paraview(), "cannot be made", error.value());
    write_file_atomically(fmt::format("{}/frame-{:09d}.vtp", dir_.paraview(), simulation_.state().step),
                          vtp_frame(prepared_.topology, simulation_.state(), colours));
    write_pvd();
  }

  // Lists the frames that are there, so that it is right after a resume as well.
  void write_pvd() {
    std::vector<PvdEntry> entries;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.paraview(), error)) {
      const std::string name = entry.path().filename().string();
      long step = 0;
      if (std::sscanf(name.c_str(), "frame-%ld.vtp", &step) == 1)
        entries.push_back(
            {counted_from_.time + static_cast<double>(step - counted_from_.step) * prepared_.time_step, name});
    }
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    pending_.write(dir_.paraview() + "/rope.pvd", pvd_text(entries));
  }

  // What a checkpoint knows of log and frames is on the disk before it.
  void sync_files() {
    log_->sync();
    frames_->sync();
  }

  void save() {
    sync_files();
    write_state(log_->mark(), frames_->mark());
  }

  void write_state(const FileMark& log, const FileMark& frames) {
    const double began = now();
    RunCheckpoint c = checkpoint_here();
    c.log = log;
    c.frames = frames;
    if (mark_.checkpoint && mark_.checkpoint->simulation != c.simulation) c.mark = mark_.checkpoint;
    c.origin = origin_;
    write_checkpoint(dir_, c);
    saved_step_ = simulation_.state().step;
    checkpoint_fails_ = false;
    write_limits();
    pending_.try_again();
    longest_save_ = std::max(longest_save_, now() - began);
  }

  // The checkpoint before stands, and there is another chance.
  void save_if_possible() {
    sync_files();
    try {
      write_state(log_->mark(), frames_->mark());
    } catch (const InputError& e) {
      if (!checkpoint_fails_) tell(fmt::format("{}; the run goes on, and it is tried again", e.what()));
      checkpoint_fails_ = true;
    }
  }

  RunCheckpoint checkpoint_here() const {
    RunCheckpoint c;
    c.log = log_->mark();
    c.frames = frames_->mark();
    c.first_energy = first_energy_;
    c.wall_seconds = wall();
    c.control = control_;
    c.limits = {watch_.records(), refinements_};
    c.simulation = simulation_.serialise();
    return c;
  }

  void save_end() {
    save_if_possible();
    if (checkpoint_fails_) save();
    simulation_.end_relaxation();  // saved as it was; this file is of a state at rest
    pending_.write(dir_.final_state(), state_csv(prepared_.topology, simulation_.state()));
  }

  void write_limits() { pending_.write(dir_.limits(), limits_json({watch_.records(), refinements_})); }

  // As long before --wall-time as a last checkpoint may take.
  bool time_is_up() const {
    if (policy_.wall_time <= 0) return false;
    const double reserve = std::min(5 + 3 * longest_save_, 0.5 * policy_.wall_time);
    return seconds_since_start() > policy_.wall_time - reserve;
  }

  double wall() const { return earlier_seconds_ + now() - started_; }

  void write_manifest(const char* status, const std::string& reason) {
    Manifest m;
    m.version = version;
    m.git_id = git_id;
    m.compiler = compiler;
    m.build_type = build_type;
    m.instructions = instructions_in_use();
    m.threads = omp_get_max_threads();
    m.seed = scene_.start.seed;
    m.scene_hash = scene_.hash;
    m.parameter_hash = scene_.parameters().hash;
    m.grade = fmt::format("{}", fmt::join(grades_of(scene_), "; "));
    m.started = started_at_;
    m.wall_seconds = wall();
    m.steps = simulation_.state().step;
    m.time_step_fs = prepared_.time_step / units::fs;
    m.status = status;
    m.reason = reason;
    m.scene = scene_.name;
    pending_.write(dir_.manifest(), manifest_json(m));
  }

  // What cannot be written or drawn is said; it can be made later.
  void write_end(const char* status, const std::string& reason) {
    write_manifest(status, reason);
    try {
      pending_.write(dir_.report(), report_of(dir_, scene_, prepared_));
    } catch (const std::exception& e) {
      tell(fmt::format("no report: {}; make it with: ropewalk report {}", failure_words(e), dir_.path));
    }
    pending_.try_again();
  }

  int finish() {
    save_end();
    write_end(at_rest_ ? "finished" : "not relaxed", reason_);
    const std::string passed = passed_words(watch_.records());
    if (!passed.empty()) print(fmt::format("Limits passed: {}\n", passed));
    if (pending_.empty()) {
      const std::string promise = plan_words(dir_, scene_, read_manifest(dir_.manifest()));
      if (!promise.empty()) print(promise + "\n");
    }
    const std::string time = relaxes() ? "" : fmt::format("{:.1f} ps, ", simulation_.state().time);
    print(fmt::format("{}{} steps, {}{:.0f} s. Report: {}\n", reason_.empty() ? "" : reason_ + "\n",
                      simulation_.state().step, time, wall(), dir_.report()));
    if (!pending_.empty()) {
      tell(fmt::format("the run is done, but for {}; write them with: ropewalk resume {}", pending_.names(),
                       dir_.path));
      return stopped_with_reason;
    }
    if (at_rest_) return 0;
    tell(fmt::format("{}; go on with `ropewalk resume {}`, or raise run.max_steps", reason_, dir_.path));
    return 4;
  }

  int stopped() {
    save_end();
    const std::string reason = fmt::format("stopped at {:.3f} ps where a limit was passed: {}",
                                           simulation_.state().time, passed_words(watch_.records()));
    write_end("stopped", reason);
    tell(fmt::format("{}; go on all the same with: ropewalk resume {}", reason, dir_.path));
    return stopped_at_limit;
  }

  EnergyParts energies() const {
    return {simulation_.forces().energy, kinetic_energy(prepared_.topology, simulation_.state())};
  }

  // This run ends here, whole; the next one is made of it.
  std::unique_ptr<Run> refined() {
    save_end();
    const RunDirectory to = finer_directory(dir_);
    DirectoryLock lock = write_finer_scene(dir_, scene_, prepared_, simulation_.state().time, policy_.force);
    auto next = std::make_unique<Run>(to, read_run_scene(to), policy_);
    next->hold(std::move(lock));
    next->inherit_from(*this);
    refinements_ = next->refinements_;
    write_limits();
    const RefinementRecord& r = refinements_.back();
    write_end("refined", fmt::format("every element was split at {:.3f} ps; it goes on in {}", r.time_ps, r.to));
    const Energies &b = r.before.potential, &a = r.after.potential;
    tell(fmt::format(
        "refined at {:.4g} ps: {} elements of {:.4g} nm became {} of {:.4g} nm; energy {:.6g} -> {:.6g} eV (bonds "
        "{:+.3g}, contact {:+.3g}, kinetic {:+.3g}); it goes on in {}",
        r.time_ps, r.elements_before, r.length_before, r.elements_after, r.length_after, r.before.total(),
        r.after.total(), a.bonds() - b.bonds(), a.vdw - b.vdw, r.after.kinetic - r.before.kinetic, to.path));
    return next;
  }

  // State, time, account and record of the run before the splitting. Steps are counted as if it had been this fine
  // from the start; the balance of energy goes on from its value, since the jump is no error of integration.
  void inherit_from(const Run& coarse) {
    Prepared at = prepared_;
    at.state = halved(coarse.prepared_.topology, coarse.simulation_.state());
    if (scene_.run.mode == RunOptions::Mode::dynamics) {
      at.state.step = std::llround(at.state.time / prepared_.time_step);
      const double dt = coarse.prepared_.time_step;  // the scene's own end, if it was not told another one
      if (coarse.last_step_ != std::lround(coarse.prepared_.duration / dt))
        stop_at(-1, static_cast<double>(coarse.last_step_) * dt);
    }
    simulation_ = start(scene_, at);
    simulation_.remember(coarse.simulation_.halved_memory());
    simulation_.inherit_from(simulation_.forces().force, simulation_.forces().torque, coarse.simulation_.account());
    simulation_.set_gauges(observer_.loading.ends, prepared_.state);
    simulation_.inherit_from(coarse.simulation_.gauges().sums);
    first_ = coarse.first_;
    record_refinement(coarse);
    first_energy_ = coarse.first_energy_ + simulation_.total_energy() - coarse.simulation_.total_energy();
    earlier_seconds_ = coarse.wall();
    std::vector<LimitRecord> records = coarse.watch_.records();
    for (std::size_t k = 0; k < records.size(); ++k)
      if (limit_kinds()[k].cured_by_finer) records[k] = {};
    watch_.inherit_from(records, at.state.step);
    origin_ = origin_of(dir_, scene_);
    begin_files();
  }

  void record_refinement(const Run& coarse) {
    RefinementRecord r;
    r.from = name_of(coarse.dir_);
    r.to = name_of(dir_);
    r.time_ps = simulation_.state().time;
    r.step_before = coarse.simulation_.state().step;
    r.step_after = simulation_.state().step;
    r.length_before = coarse.scene_.element_length;
    r.length_after = scene_.element_length;
    r.elements_before = coarse.prepared_.topology.elements();
    r.elements_after = prepared_.topology.elements();
    r.before = coarse.energies();
    r.after = energies();
    refinements_ = coarse.refinements_;
    refinements_.push_back(r);
  }

  int interrupted(int code, const std::string& by) {
    save_end();
    const std::string reason = fmt::format("stopped {} at {:.3f} ps", by, simulation_.state().time);
    write_manifest("interrupted", reason);
    pending_.try_again();
    tell_as_is(fmt::format("\n{}; go on with: ropewalk resume {}\n", reason, dir_.path));
    return code;
  }

  int failed(const NumericalError& e) {
    write_limits();
    pending_.write(dir_.failed_state(), state_csv(prepared_.topology, simulation_.state()));
    write_end("failed", e.what());
    tell_as_is(fmt::format("\nropewalk: {}. State written to {}\n", e.what(), dir_.failed_state()));
    return stopped_with_reason;
  }

  // A full disk, no memory: the last good state is saved if that is still possible.
  int broken_off(const std::string& why) {
    try {
      if (mark_.checkpoint && mark_.step > saved_step_) {
        sync_files();
        RunCheckpoint c = *mark_.checkpoint;
        c.origin = origin_;
        write_checkpoint(dir_, c);
      }
    } catch (const std::exception&) {
      // The last checkpoint stands.
    }
    write_manifest("interrupted", why);
    tell(fmt::format("{}; then go on with: ropewalk resume {}", why, dir_.path));
    return stopped_with_reason;
  }

  RunDirectory dir_;
  Scene scene_;
  Prepared prepared_;
  Observer observer_;
  Simulation simulation_;
  DirectoryLock lock_;
  std::unique_ptr<GrowingFile> log_;
  std::unique_ptr<FrameWriter> frames_;
  PendingFiles pending_;
  RunOrigin origin_;
  LimitWatch watch_;
  StopWatch stop_watch_;
  StepControl control_;
  Mark mark_;
  std::vector<RefinementRecord> refinements_;
  LogRow last_row_;
  std::string reason_;
  std::string started_at_ = iso_time();
  Energies first_;  // potential at the start
  double first_energy_ = 0, earlier_seconds_ = 0, started_ = now();
  struct {
    std::int64_t step = 0;
    double time = 0;
  } counted_from_;
  long log_every_ = 1, frames_every_ = 1, last_step_ = 0;
  std::size_t expected_frames_ = 0;  // of the whole scene
  std::int64_t saved_step_ = -1;
  std::int64_t written_step_ = -1;  // of a relaxation: its row and frame were there when it began or went on
  double longest_save_ = 0;         // s
  bool checkpoint_fails_ = false;
  StopReason at_once_ = StopReason::none;  // before the first step
  RunPolicy policy_;
  bool at_rest_ = true;  // false: a relaxation ran out of steps
};

}  // namespace

void use_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

namespace {

// A run that may be refined must find the place for it free.
void check_finer_directory(const RunDirectory& dir, const RunPolicy& policy, bool resumed) {
  const RunDirectory finer = finer_directory(dir);
  if (resumed && !has_checkpoint(finer)) return;  // killed while it was made: see write_finer_scene()
  if (policy.on_limit == OnLimit::refine && !policy.force && std::filesystem::exists(finer.path))
    throw InputError({finer.path, 0, "--on-limit"}, "exists, and a refined run would go on there",
                     "take it away or choose another name for the run");
}

std::unique_ptr<Run> new_run(const Scene& scene, const RunArguments& a) {
  const RunDirectory dir{a.out};
  const RunPolicy policy{a.quiet, on_limit_of(a.on_limit), a.force, seconds_of_wall_time(a.wall_time)};
  // Everything that can be wrong is found before a file is touched.
  auto run = std::make_unique<Run>(dir, scene, policy);
  run->check_before_start();
  run->stop_at(a.steps, a.until_ps);
  listen_to_stop_signals();
  check_finer_directory(dir, policy, false);
  run->hold(create_run_directory(dir, a.force));
  write_file_atomically(dir.scene(), scene.text);
  for (std::size_t k = 0; k < scene.sets.size(); ++k)
    write_file_atomically(dir.parameters(k), read_file(scene.sets[k].path));
  if (scene.from_file()) write_file_atomically(dir.state(), read_file(scene.source->file()));
  run->say_notes();
  run->begin();
  return run;
}

int go_through(std::unique_ptr<Run> run) {
  for (;;) {
    Run::Result result = run->go();
    if (!result.next) return result.code;
    run = std::move(result.next);
  }
}

// A run whose elements were split goes on elsewhere.
void refuse_refined(const RunDirectory& dir) {
  const RunDirectory next = finer_directory(dir);
  if (!has_checkpoint(next)) return;
  const std::vector<RefinementRecord> splits = read_checkpoint(next).limits.refinements;
  if (splits.empty() || splits.back().from != name_of(dir)) return;
  throw InputError({dir.path, 0, ""}, fmt::format("had its elements split at {:.4g} ps", splits.back().time_ps),
                   "go on with: ropewalk resume " + next.path);
}

}  // namespace

int run_command(const RunArguments& a) {
  use_threads(a.threads);
  use_instructions(a.instructions);
  return go_through(new_run(read_scene(a.scene), a));
}

int run_scene(const Scene& scene, const RunArguments& a) { return go_through(new_run(scene, a)); }

void begin_run(const RunArguments& a) { new_run(read_scene(a.scene), a)->leave(); }

namespace {

// Those that the run was begun with, so that it gives the same bits, unless others are asked for.
void use_instructions_of(const RunOrigin& origin, const std::string& asked_for) {
  const std::string& name = asked_for.empty() ? origin.instructions : asked_for;
  if (!use_instructions(name) && asked_for.empty())
    throw InputError({"", 0, "--instructions"},
                     fmt::format("the run was begun with {}, which this processor has not got", name),
                     fmt::format("go on elsewhere, or give one of {} for other last digits",
                                 fmt::join(instruction_sets(), ", ")));
  if (origin.instructions != instructions_in_use())
    tell(fmt::format("note: instruction set {} -> {}: last digits differ", origin.instructions,
                     instructions_in_use()));
}

}  // namespace

int resume_command(const ResumeArguments& a) {
  use_threads(a.threads);
  const RunDirectory dir{a.dir};
  const RunPolicy policy{a.quiet, on_limit_of(a.on_limit), false, seconds_of_wall_time(a.wall_time)};
  read_checkpoint(dir);  // is there one at all?
  refuse_refined(dir);
  check_finer_directory(dir, policy, true);
  DirectoryLock lock(dir.path);
  remove_parts(dir.path);
  remove_parts(dir.paraview());
  check_log_header(dir.log());
  ResumePoint point = find_resume_point(dir);
  use_instructions_of(point.checkpoint.origin, a.instructions);
  const Scene scene = read_run_scene(dir);
  RunOrigin origin = origin_of(dir, scene);
  origin.instructions = point.checkpoint.origin.instructions;  // spoken of already
  judge_changes(changes_of(point.checkpoint.origin, origin, dir), a.accept_changes, dir);
  for (const std::string& remark : point.remarks) tell("note: " + remark);
  // The next one that is written must not take the place of the only good one.
  if (point.path != dir.checkpoint()) std::filesystem::remove(dir.checkpoint());
  auto run = std::make_unique<Run>(dir, scene, policy);
  run->hold(std::move(lock));
  run->restore(std::move(point.checkpoint));
  run->stop_at(a.steps, a.until_ps);
  run->check_end_lies_ahead(a.steps, a.until_ps);
  listen_to_stop_signals();
  run->announce();
  return go_through(std::move(run));
}

}  // namespace ropewalk
