// `run` and `resume`: the loop around the simulation, its files and its signals.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>

#include "commands/commands.hpp"
#include "io/files.hpp"
#include "io/frames.hpp"
#include "model/error.hpp"
#include "plan/forecast.hpp"
#include "run/colours.hpp"
#include "run/limit_watch.hpp"
#include "run/progress.hpp"
#include "run/run_directory.hpp"
#include "run/stages.hpp"
#include "run/stop_watch.hpp"
#include "scene/finer.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "scene/watch.hpp"
#include "sim/dynamics/refine.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

volatile std::sig_atomic_t caught_signal = 0;
void on_signal(int signal) { caught_signal = signal; }

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::string iso_time() {
  const std::time_t t = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&t));
  return text;
}

// A file that grows; cut back to a known length when a run is resumed.
class Stream {
 public:
  Stream(std::string path, std::uint64_t keep) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "ab")) {
    if (!file_ || ftruncate(fileno(file_), static_cast<off_t>(keep)) != 0) fail();
    size_ = keep;
  }
  Stream(const Stream&) = delete;
  ~Stream() { std::fclose(file_); }

  void write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
    size_ += text.size();
  }
  void flush() {
    if (std::fflush(file_) != 0) fail();
  }
  std::uint64_t size() const { return size_; }
  // What was written after this did not happen.
  void cut(std::uint64_t keep) {
    flush();
    if (ftruncate(fileno(file_), static_cast<off_t>(keep)) != 0) fail();
    size_ = keep;
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError({path_, 0, ""}, fmt::format("cannot be written: {}", std::strerror(errno)),
                     fmt::format("{}; the last checkpoint stands", remedy_for_errno(errno)));
  }

  std::string path_;
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

long every(double interval, double duration, long parts, double dt) {
  const double chosen = interval > 0 ? interval : duration / static_cast<double>(parts);
  return std::max(1L, std::lround(chosen / dt));
}

// What the command line asks for.
struct RunPolicy {
  bool quiet = false;
  OnLimit on_limit = OnLimit::warn;
  bool force = false;
};

enum class StopReason { none, complete, signal, limit, refine };

// Steps between two checks of the limits, at most: a check costs about as much as a step.
constexpr long check_every = 128, pause_every = 16;
constexpr double patience = 0.5;     // s, of who wants to stop a run
constexpr int stopped_at_limit = 5;  // exit code

// Above the progress line, where there is one.
void say(const std::string& line) {
  fmt::print(stderr, "{}ropewalk: {}\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", line);
}

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
    const double dt = prepared_.time_step;
    const double span = prepared_.duration > 0 ? prepared_.duration : 1000 * dt;
    log_every_ = every(scene_.run.log_every, span, 400, dt);
    frames_every_ = every(scene_.run.frames_every, span, 40, dt);
    first_ = simulation_.forces().energy;
    last_step_ = scene_.run.mode == RunOptions::Mode::relax ? -1 : std::lround(prepared_.duration / dt);
  }

  // A negative value means that the option was not given.
  void stop_at(long steps, double ps) {
    if (ps >= 0 && scene_.run.mode == RunOptions::Mode::relax)
      throw InputError({"", 0, "--until"}, "a relaxation has no time", "take --steps");
    if (ps >= 0) last_step_ = std::lround(ps / prepared_.time_step);
    if (steps >= 0) last_step_ = steps;
  }

  // Refuses an end that lies behind a run that goes on.
  void check_end_lies_ahead(long steps, double ps) const {
    const State& at = simulation_.state();
    if ((steps < 0 && ps < 0) || last_step_ > at.step) return;
    // Killed where it was to end anyway: what is left is to say so.
    if (last_step_ == at.step && read_manifest(dir_.manifest()).status == "running") return;
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
      for (const std::string& grade : grades_of(scene_)) fmt::print(stderr, "ropewalk: parameters {}\n", grade);
    for (const std::string& note : warnings_of(scene_, prepared_.topology))
      fmt::print(stderr, "ropewalk: note: {}\n", note);
    for (const std::string& note : warmth_of(scene_, prepared_)) fmt::print(stderr, "ropewalk: note: {}\n", note);
    for (const std::string& note : limits_ahead(scene_, prepared_))
      fmt::print(stderr, "ropewalk: note: {}\n", note);
  }

  void begin() {
    first_energy_ = simulation_.total_energy();
    begin_files();
  }

  void restore(const RunCheckpoint& c) {
    check_log_header(dir_.log());
    try {
      if (c.mark) {
        simulation_.restore(c.mark->simulation);
        mark_.energy = energy_mark(simulation_);
      }
      simulation_.restore(c.simulation);
    } catch (const std::runtime_error& e) {
      throw InputError({dir_.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
    }
    first_energy_ = c.first_energy;
    earlier_seconds_ = c.wall_seconds;
    control_ = c.control;
    open(c.log_bytes, c.frame_bytes);
    if (std::filesystem::exists(dir_.limits())) {
      const LimitsFile earlier = read_limits(dir_.limits());
      watch_.inherit_from(earlier.limits, simulation_.state().step);
      refinements_ = earlier.refinements;
    }
    if (!stop_watch_.empty())
      for (const LogRow& earlier : read_log(dir_.log())) stop_watch_.add(earlier);
    mark_.limits = watch_.records();
    if (c.mark)
      mark_.checkpoint = c.mark;
    else
      set_mark();
  }

  // For somebody else to go on with.
  void leave() {
    save();
    write_manifest("interrupted", "not yet run");
  }

  // `next`: the run in which it goes on, elements split.
  struct Result {
    int code = 0;
    std::unique_ptr<Run> next;
  };
  Result go() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    started_ = now();
    for (const std::string& of_an_earlier_end : {dir_.final_state(), dir_.plan_check()})
      std::filesystem::remove(of_an_earlier_end);
    write_manifest("running", "");
    try {
      const bool relax = scene_.run.mode == RunOptions::Mode::relax;
      switch (relax ? relax_loop() : dynamics_loop()) {
        case StopReason::complete:
          return {finish(), nullptr};
        case StopReason::limit:
          return {stopped(), nullptr};
        case StopReason::refine:
          return {0, refined()};
        case StopReason::signal:
        case StopReason::none:
          break;
      }
      return {interrupted(), nullptr};
    } catch (const NumericalError& e) {
      return {failed(e), nullptr};
    }
  }

 private:
  void open(std::uint64_t log_bytes, std::uint64_t frame_bytes) {
    log_ = std::make_unique<Stream>(dir_.log(), log_bytes);
    frames_ = std::make_unique<Stream>(dir_.frames(), frame_bytes);
  }

  void begin_files() {
    open(0, 0);
    log_->write(log_header());
    write_row();
    write_frame();
  }

  // Says what is passed for the first time, and whether the run is to end here for it.
  StopReason check_limits(bool with_pressure) {
    const std::vector<std::string> passed =
        watch_.check(prepared_.topology, simulation_.state(), simulation_.list(), drift(), with_pressure);
    for (const std::string& line : passed) say(line);
    if (!passed.empty()) write_limits();
    if (policy_.on_limit == OnLimit::stop && !passed.empty()) return StopReason::limit;
    if (policy_.on_limit != OnLimit::refine || !watch_.finer_would_help()) return StopReason::none;
    const std::string why = why_not_finer(scene_, prepared_.topology);
    if (why.empty()) return StopReason::refine;
    if (!passed.empty()) say("not refined: " + why + "; the run goes on as it is");
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
    if (simulation_.state().step < last_step_ && std::isfinite(simulation_.total_energy()))
      stop = check_limits(true);
    if (stop != StopReason::none) return stop;
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
      if (caught_signal) return StopReason::signal;
      if (progress.due()) progress.show(static_cast<double>(step), status_text());
      if (marked) {
        control_.lengthen(simulation_);
        set_mark();
      }
      if (step % pause_every == 0 && now() > checkpoint_at) {
        save();
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
    std::vector<LimitRecord> limits;
    EnergyMark energy;
  };

  void set_mark() {
    mark_.checkpoint = std::make_shared<const RunCheckpoint>(checkpoint_here());
    mark_.limits = watch_.records();
    mark_.energy = energy_mark(simulation_);
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
    log_->cut(c.log_bytes);
    frames_->cut(c.frame_bytes);
    watch_.inherit_from(mark_.limits, simulation_.state().step);
    stop_watch_.cut(simulation_.state().step);
    // The remedy, after the semicolon of the message, is left out: a shorter step is what the run takes now.
    say(fmt::format("{:.4g} ps: {}; back to {:.4g} ps, on with steps of {:.3g} fs", time,
                    why.substr(0, why.find(';')), simulation_.state().time,
                    simulation_.time_step() / simulation_.divided() / units::fs));
    return true;
  }

  StopReason relax_loop() {
    Progress progress(policy_.quiet, 0, 0);
    StopReason stop = StopReason::none;
    const RelaxGoal& goal = scene_.run.goal;
    const long max_steps = last_step_ >= 0 ? std::max(0L, last_step_ - static_cast<long>(simulation_.state().step))
                                           : scene_.run.max_steps;
    const Relaxed end = simulation_.relax(goal, max_steps, [&](long k) {
      if (k % 100 == 0) {
        write_row();
        stop = check_limits(false);
      }
      if (progress.due()) progress.show(static_cast<double>(k), status_text());
      return caught_signal == 0 && stop == StopReason::none;
    });
    progress.done();
    write_row();
    write_frame();
    if (caught_signal) return StopReason::signal;
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

  std::string status_text() const {
    const State& s = simulation_.state();
    std::string text = fmt::format("{:8.2f} ps", s.time);
    if (scene_.twist) text += fmt::format("  moment {:5.1f} nN nm", scene_.twist->moment_at(s.time) / units::nN_nm);
    return text + fmt::format("  beta {:5.1f} deg  Q {}  twist {:.0f}  bend {:.0f}  vdW {:.0f} eV",
                              last_row_["beta_deg"], last_row_["Q"], last_row_["twist_eV"], last_row_["bend_eV"],
                              last_row_["vdw_eV"]);
  }

  EnergyAccount account() const {
    const State& s = simulation_.state();
    EnergyAccount account;
    account.time_step = simulation_.time_step() / simulation_.divided();
    if (scene_.twist) account.moment = scene_.twist->moment_at(s.time);
    account.potential = simulation_.forces().energy;
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
    log_->flush();
  }

  void write_frame() {
    const ElementColours colours = element_colours(prepared_.topology, prepared_.interaction, simulation_.state());
    frames_->write(dump_frame(prepared_.topology, simulation_.state(), colours));
    frames_->flush();
    if (!scene_.run.paraview) return;
    std::filesystem::create_directories(dir_.paraview());
    write_file_atomically(fmt::format("{}/frame-{:09d}.vtp", dir_.paraview(), simulation_.state().step),
                          vtp_frame(prepared_.topology, simulation_.state(), colours));
    write_pvd();
  }

  // Lists the frames that are there, so that it is right after a resume as well.
  void write_pvd() {
    std::vector<PvdEntry> entries;
    for (const auto& entry : std::filesystem::directory_iterator(dir_.paraview())) {
      const std::string name = entry.path().filename().string();
      long step = 0;
      if (std::sscanf(name.c_str(), "frame-%ld.vtp", &step) == 1)
        entries.push_back({static_cast<double>(step) * prepared_.time_step, name});
    }
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    write_file_atomically(dir_.paraview() + "/rope.pvd", pvd_text(entries));
  }

  void save() {
    log_->flush();
    frames_->flush();
    RunCheckpoint c = checkpoint_here();
    if (mark_.checkpoint && mark_.checkpoint->simulation != c.simulation) c.mark = mark_.checkpoint;
    write_checkpoint(dir_, c);
    write_limits();
  }

  RunCheckpoint checkpoint_here() const {
    RunCheckpoint c;
    c.log_bytes = log_->size();
    c.frame_bytes = frames_->size();
    c.first_energy = first_energy_;
    c.wall_seconds = wall();
    c.control = control_;
    c.simulation = simulation_.serialise();
    return c;
  }

  void save_end() {
    save();
    write_file_atomically(dir_.final_state(), state_csv(prepared_.topology, simulation_.state()));
  }

  void write_limits() const { write_file_atomically(dir_.limits(), limits_json({watch_.records(), refinements_})); }

  double wall() const { return earlier_seconds_ + now() - started_; }

  void write_manifest(const char* status, const std::string& reason) const {
    Manifest m;
    m.version = version;
    m.git_id = git_id;
    m.compiler = compiler;
    m.build_type = build_type;
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
    write_file_atomically(dir_.manifest(), manifest_json(m));
  }

  int finish() {
    save_end();
    write_manifest(at_rest_ ? "finished" : "not relaxed", reason_);
    write_report(dir_, scene_, prepared_);
    const std::string passed = passed_words(watch_.records());
    if (!passed.empty()) fmt::print("Limits passed: {}\n", passed);
    fmt::print("{}{} steps, {:.1f} ps, {:.0f} s. Report: {}\n", reason_.empty() ? "" : reason_ + "\n",
               simulation_.state().step, simulation_.state().time, wall(), dir_.report());
    if (at_rest_) return 0;
    fmt::print(stderr, "ropewalk: {}; go on with `ropewalk resume {}`, or raise run.max_steps\n", reason_,
               dir_.path);
    return 4;
  }

  int stopped() {
    save_end();
    const std::string reason = fmt::format("stopped at {:.3f} ps where a limit was passed: {}",
                                           simulation_.state().time, passed_words(watch_.records()));
    write_manifest("stopped", reason);
    write_report(dir_, scene_, prepared_);
    say(fmt::format("{}; go on all the same with: ropewalk resume {}", reason, dir_.path));
    return stopped_at_limit;
  }

  EnergyParts energies() const {
    return {simulation_.forces().energy, kinetic_energy(prepared_.topology, simulation_.state())};
  }

  // This run ends here, whole; the next one is made of it.
  std::unique_ptr<Run> refined() {
    save_end();
    const RunDirectory to = write_finer_scene(dir_, scene_, prepared_, simulation_.state().time, policy_.force);
    auto next = std::make_unique<Run>(to, read_run_scene(to), policy_);
    next->inherit_from(*this);
    refinements_ = next->refinements_;
    write_limits();
    const RefinementRecord& r = refinements_.back();
    write_manifest("refined",
                   fmt::format("every element was split at {:.3f} ps; it goes on in {}", r.time_ps, r.to));
    write_report(dir_, scene_, prepared_);
    const Energies &b = r.before.potential, &a = r.after.potential;
    say(fmt::format(
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
    begin_files();
    save();
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

  int interrupted() {
    save_end();
    const std::string reason =
        fmt::format("stopped by signal {} at {:.3f} ps", static_cast<int>(caught_signal), simulation_.state().time);
    write_manifest("interrupted", reason);
    fmt::print(stderr, "\n{}; go on with: ropewalk resume {}\n", reason, dir_.path);
    return 128 + caught_signal;
  }

  int failed(const NumericalError& e) {
    write_limits();
    write_file_atomically(dir_.failed_state(), state_csv(prepared_.topology, simulation_.state()));
    write_manifest("failed", e.what());
    try {
      write_report(dir_, scene_, prepared_);
    } catch (const std::exception&) {
      // The failure is what counts; a state beyond all measure may not be drawn.
    }
    fmt::print(stderr, "\nropewalk: {}. State written to {}\n", e.what(), dir_.failed_state());
    return 3;
  }

  RunDirectory dir_;
  Scene scene_;
  Prepared prepared_;
  Observer observer_;
  Simulation simulation_;
  std::unique_ptr<Stream> log_, frames_;
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
  long log_every_ = 1, frames_every_ = 1, last_step_ = 0;
  RunPolicy policy_;
  bool at_rest_ = true;  // false: a relaxation ran out of steps
};

}  // namespace

void use_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

namespace {

// A run that may be refined must find the place for it free.
void check_finer_directory(const RunDirectory& dir, const RunPolicy& policy) {
  const RunDirectory finer = finer_directory(dir);
  if (policy.on_limit == OnLimit::refine && !policy.force && std::filesystem::exists(finer.path))
    throw InputError({finer.path, 0, "--on-limit"}, "exists, and a refined run would go on there",
                     "take it away or choose another name for the run");
}

std::unique_ptr<Run> new_run(const Scene& scene, const RunArguments& a) {
  const RunDirectory dir{a.out};
  const RunPolicy policy{a.quiet, on_limit_of(a.on_limit), a.force};
  // Everything that can be wrong is found before a file is touched.
  auto run = std::make_unique<Run>(dir, scene, policy);
  run->check_before_start();
  run->stop_at(a.steps, a.until_ps);
  check_finer_directory(dir, policy);
  create_run_directory(dir, a.force);
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
  if (!std::filesystem::exists(dir.limits())) return;
  const LimitsFile file = read_limits(dir.limits());
  if (file.refinements.empty() || file.refinements.back().from != name_of(dir)) return;
  const RunDirectory next = finer_directory(dir);
  if (!std::filesystem::exists(next.checkpoint())) return;
  throw InputError({dir.path, 0, ""},
                   fmt::format("had its elements split at {:.4g} ps", file.refinements.back().time_ps),
                   "go on with: ropewalk resume " + next.path);
}

}  // namespace

int run_command(const RunArguments& a) {
  use_threads(a.threads);
  return go_through(new_run(read_scene(a.scene), a));
}

int run_scene(const Scene& scene, const RunArguments& a) { return go_through(new_run(scene, a)); }

void begin_run(const RunArguments& a) { new_run(read_scene(a.scene), a)->leave(); }

int resume_command(const ResumeArguments& a) {
  use_threads(a.threads);
  const RunDirectory dir{a.dir};
  const RunCheckpoint checkpoint = read_checkpoint(dir);
  refuse_refined(dir);
  const RunPolicy policy{a.quiet, on_limit_of(a.on_limit), false};
  check_finer_directory(dir, policy);
  auto run = std::make_unique<Run>(dir, read_run_scene(dir), policy);
  run->stop_at(a.steps, a.until_ps);
  run->restore(checkpoint);
  run->check_end_lies_ahead(a.steps, a.until_ps);
  return go_through(std::move(run));
}

}  // namespace ropewalk
