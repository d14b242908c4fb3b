// `run` and `resume`: the loop around the simulation, its files and its signals.
#include <fmt/format.h>
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
#include <memory>

#include "commands/colours.hpp"
#include "commands/commands.hpp"
#include "commands/progress.hpp"
#include "commands/run_directory.hpp"
#include "io/files.hpp"
#include "io/frames.hpp"
#include "model/error.hpp"
#include "scene/scene_toml.hpp"
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

 private:
  [[noreturn]] void fail() const {
    throw InputError({path_, 0, ""}, fmt::format("cannot be written: {}", std::strerror(errno)),
                     "free some space or choose another --out; the last checkpoint stands");
  }

  std::string path_;
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

long every(double interval, double duration, long parts, double dt) {
  const double chosen = interval > 0 ? interval : duration / static_cast<double>(parts);
  return std::max(1L, std::lround(chosen / dt));
}

class Run {
 public:
  Run(RunDirectory dir, Scene scene, bool quiet)
      : dir_(std::move(dir)),
        scene_(std::move(scene)),
        prepared_(prepare(scene_)),
        observer_(make_observer(scene_, prepared_)),
        simulation_(start(scene_, prepared_)),
        quiet_(quiet) {
    const double dt = prepared_.time_step;
    const double span = prepared_.duration > 0 ? prepared_.duration : 1000 * dt;
    log_every_ = every(scene_.run.log_every, span, 400, dt);
    frames_every_ = every(scene_.run.frames_every, span, 40, dt);
    last_step_ = std::lround(prepared_.duration / dt);
  }

  void stop_at(long steps) { last_step_ = steps; }
  void stop_at_time(double ps) { last_step_ = std::lround(ps / prepared_.time_step); }

  void begin() {
    first_energy_ = simulation_.total_energy();
    open(0, 0);
    log_->write(log_header());
    write_row();
    write_frame();
  }

  void restore(const RunCheckpoint& c) {
    try {
      simulation_.restore(c.simulation);
    } catch (const std::runtime_error& e) {
      throw InputError({dir_.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
    }
    first_energy_ = c.first_energy;
    earlier_seconds_ = c.wall_seconds;
    open(c.log_bytes, c.frame_bytes);
  }

  // For somebody else to go on with.
  void leave() {
    save();
    write_manifest("interrupted", "not yet run");
  }

  int go() {
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    started_ = now();
    write_manifest("running", "");
    try {
      const bool relax = scene_.run.mode == RunOptions::Mode::relax;
      const bool complete = relax ? relax_loop() : dynamics_loop();
      return complete ? finish() : interrupted();
    } catch (const NumericalError& e) {
      return failed(e);
    }
  }

 private:
  void open(std::uint64_t log_bytes, std::uint64_t frame_bytes) {
    log_ = std::make_unique<Stream>(dir_.log(), log_bytes);
    frames_ = std::make_unique<Stream>(dir_.frames(), frame_bytes);
  }

  bool dynamics_loop() {
    Progress progress(quiet_, static_cast<double>(simulation_.state().step), static_cast<double>(last_step_));
    double checkpoint_at = now() + scene_.run.checkpoint_every;
    while (simulation_.state().step < last_step_) {
      const std::int64_t step = simulation_.state().step + 1;
      const bool last = step == last_step_, logged = step % log_every_ == 0 || last;
      simulation_.step(logged);
      if (logged) write_row();
      if (step % frames_every_ == 0 || last) write_frame();
      if (caught_signal) return false;
      if (progress.due()) progress.show(static_cast<double>(step), status_text());
      if (step % 16 == 0 && now() > checkpoint_at) {
        save();
        checkpoint_at = now() + scene_.run.checkpoint_every;
      }
    }
    progress.done();
    return true;
  }

  bool relax_loop() {
    Progress progress(quiet_, 0, 0);
    const long most = last_step_ > 0 ? last_step_ : scene_.run.max_steps;
    at_rest_ = simulation_.relax(scene_.run.force_tolerance, most, [&](long k) {
      if (k % 100 == 0) write_row();
      if (progress.due()) progress.show(static_cast<double>(k), status_text());
      return caught_signal == 0;
    });
    progress.done();
    write_row();
    write_frame();
    if (caught_signal) return false;
    reason_ = at_rest_ ? fmt::format("relaxed: largest force below {:.3g} eV/nm", scene_.run.force_tolerance)
                       : fmt::format("not relaxed after {} steps: largest force {:.3g} eV/nm, {:.3g} asked for",
                                     most, simulation_.largest_force(), scene_.run.force_tolerance);
    return true;
  }

  std::string status_text() const {
    const State& s = simulation_.state();
    std::string text = fmt::format("{:8.2f} ps", s.time);
    for (const TwistDrive& twist : prepared_.drive.twist)
      text += fmt::format("  moment {:5.1f} nN nm", twist.moment_at(s.time) / units::nN_nm);
    return text + fmt::format("  beta {:5.1f} deg  Q {}  twist {:.0f}  bend {:.0f}  vdW {:.0f} eV", last_row_.beta,
                              last_row_.charge, last_row_.twist, last_row_.bend, last_row_.vdw);
  }

  LogRow row() {
    const Energies& e = simulation_.forces().energy;
    const State& s = simulation_.state();
    LogRow r;
    r.step = static_cast<double>(s.step);
    r.time = s.time;
    for (const TwistDrive& twist : prepared_.drive.twist) r.moment = twist.moment_at(s.time) / units::nN_nm;
    r.stretch = e.stretch;
    r.shear = e.shear;
    r.bend = e.bend;
    r.twist = e.twist;
    r.vdw = e.vdw;
    r.kinetic = kinetic_energy(prepared_.topology, s);
    r.work = simulation_.work();
    r.dissipated = simulation_.dissipated();
    r.balance = e.potential() + r.kinetic - r.work + r.dissipated - first_energy_;
    fill_geometry(look(observer_, scene_, prepared_.topology, s), r);
    return r;
  }

  void write_row() {
    last_row_ = row();
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
    RunCheckpoint c;
    c.log_bytes = log_->size();
    c.frame_bytes = frames_->size();
    c.first_energy = first_energy_;
    c.wall_seconds = wall();
    c.simulation = simulation_.serialise();
    write_checkpoint(dir_, c);
  }

  double wall() const { return earlier_seconds_ + now() - started_; }

  void write_manifest(const char* status, const std::string& reason) const {
    Manifest m;
    m.version = version;
    m.git_id = git_id;
    m.compiler = compiler;
    m.build_type = build_type;
    m.threads = omp_get_max_threads();
    m.seed = scene_.seed;
    m.scene_hash = scene_.hash;
    m.parameter_hash = scene_.parameters().hash;
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
    save();
    write_manifest(at_rest_ ? "finished" : "not relaxed", reason_);
    write_report(dir_, scene_, prepared_);
    fmt::print("{}{} steps, {:.1f} ps, {:.0f} s. Report: {}\n", reason_.empty() ? "" : reason_ + "\n",
               simulation_.state().step, simulation_.state().time, wall(), dir_.report());
    if (at_rest_) return 0;
    fmt::print(stderr, "ropewalk: {}; go on with `ropewalk resume {}`, or raise run.max_steps\n", reason_,
               dir_.path);
    return 4;
  }

  int interrupted() {
    save();
    const std::string reason =
        fmt::format("stopped by signal {} at {:.3f} ps", static_cast<int>(caught_signal), simulation_.state().time);
    write_manifest("interrupted", reason);
    fmt::print(stderr, "\n{}; go on with: ropewalk resume {}\n", reason, dir_.path);
    return 128 + caught_signal;
  }

  int failed(const NumericalError& e) {
    write_file_atomically(dir_.failed_state(), state_csv(prepared_.topology, simulation_.state()));
    write_manifest("failed", e.what());
    fmt::print(stderr, "\nropewalk: {}. State written to {}\n", e.what(), dir_.failed_state());
    return 3;
  }

  RunDirectory dir_;
  Scene scene_;
  Prepared prepared_;
  Observer observer_;
  Simulation simulation_;
  std::unique_ptr<Stream> log_, frames_;
  LogRow last_row_;
  std::string reason_;
  std::string started_at_ = iso_time();
  double first_energy_ = 0, earlier_seconds_ = 0, started_ = now();
  long log_every_ = 1, frames_every_ = 1, last_step_ = 0;
  bool quiet_ = false;
  bool at_rest_ = true;  // false: a relaxation ran out of steps
};

}  // namespace

void use_threads(int threads) {
  if (threads > 0) omp_set_num_threads(threads);
}

namespace {

Run new_run(const RunArguments& a) {
  const RunDirectory dir{a.out};
  Scene scene = read_scene(a.scene);
  Run run(dir, scene, a.quiet);  // everything that can be wrong is found before a file is touched
  create_run_directory(dir, a.force);
  write_file_atomically(dir.scene(), scene.text);
  for (std::size_t k = 0; k < scene.sets.size(); ++k)
    write_file_atomically(dir.parameters(k), read_file(scene.sets[k].path));
  if (const auto* state = std::get_if<StateSource>(&scene.source))
    write_file_atomically(dir.state(), read_file(state->file));
  for (const std::string& warning : warnings_of(scene)) fmt::print(stderr, "ropewalk: note: {}\n", warning);
  if (a.steps >= 0) run.stop_at(a.steps);
  run.begin();
  return run;
}

}  // namespace

int run_command(const RunArguments& a) {
  use_threads(a.threads);
  return new_run(a).go();
}

void begin_run(const RunArguments& a) { new_run(a).leave(); }

int resume_command(const ResumeArguments& a) {
  use_threads(a.threads);
  const RunDirectory dir{a.dir};
  const RunCheckpoint checkpoint = read_checkpoint(dir);
  Run run(dir, read_run_scene(dir), a.quiet);
  if (a.until_ps >= 0) run.stop_at_time(a.until_ps);
  if (a.steps >= 0) run.stop_at(a.steps);
  run.restore(checkpoint);
  return run.go();
}

}  // namespace ropewalk
