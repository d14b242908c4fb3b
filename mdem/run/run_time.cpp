#include "run/run_time.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/frames/dump.hpp"
#include "io/plain_text.hpp"
#include "io/processes.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "plan/features.hpp"
#include "plan/scene_edit.hpp"
#include "run/begin_run.hpp"
#include "run/colours.hpp"
#include "scene/scene_toml.hpp"
#include "scene/watch.hpp"
#include "scene/wound.hpp"
#include "sim/dynamics/shorter_steps.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

constexpr double enough = 0.2;  // time spent on each thing that is timed, s
constexpr long min_steps = 12, max_steps = 2000;
constexpr double usual_frames = 40, usual_rows = 400;
constexpr double frames_in_report = 6;  // frames in a report

// --- Steps ---

double seconds_of_a_step(const Simulation& begin) {
  return with_shorter_steps(begin, [](Simulation& s) {
    s.steps(5, false);
    const double began = processor_seconds();
    long count = 0;
    while (count < min_steps || (count < max_steps && processor_seconds() - began < enough)) {
      s.steps(min_steps, false);
      count += min_steps;
    }
    return (processor_seconds() - began) / static_cast<double>(count);
  });
}

double seconds_from(const Scene& scene, const Prepared& p, State state) {
  return seconds_of_a_step(Simulation(p.topology, p.interaction, p.loads, std::move(state), p.time_step,
                                      scene.contact.skin, p.stepping));
}

double seconds_from_the_start(const Scene& scene, const Prepared& p) { return seconds_of_a_step(start(scene, p)); }

// Turned so far, or as far as the rope bears to be laid: it keeps its cross-section, and turned too far its tubes
// lie in one another.
double seconds_turned_by(const Scene& scene, const Prepared& p, double turn, double rate, double time) {
  constexpr double less = 0.7, least = 0.2;  // of the turn
  for (double part = 1; part > least; part *= less) {
    State state = wound(p.state, part * turn, rate);
    state.time = time;
    try {
      return seconds_from(scene, p, std::move(state));
    } catch (const NumericalError&) {
    }
  }
  return seconds_from_the_start(scene, p);
}

// Mean over ramp and hold.
double seconds_in_turned_rope(const Scene& scene, const Prepared& p, const SceneFeatures& f) {
  const double ramp = std::min(f.ramp(), p.duration), share = p.duration > 0 ? ramp / p.duration : 0.0;
  const double turn = f.ramp() > 0 ? f.turn * ramp / f.ramp() : f.turn;
  double seconds = 0;
  if (share > 0) seconds += share * seconds_turned_by(scene, p, 0.5 * turn, turn / ramp, 0.5 * ramp);
  if (share < 1) seconds += (1 - share) * seconds_turned_by(scene, p, turn, 0, ramp);
  return seconds;
}

double seconds_of_steps(const Scene& scene, const Prepared& p) {
  const SceneFeatures f = features_of(scene, p);
  const bool turned = scene.source->is_parallel() && f.contact && f.turn > 0;
  return turned ? seconds_in_turned_rope(scene, p, f) : seconds_from_the_start(scene, p);
}

void time_relaxation(const Scene& scene, const Prepared& p, RunTime& t) {
  Simulation s = start(scene, p);
  const double began = processor_seconds();
  const bool at_rest = s.relax(scene.run.goal, scene.run.max_steps, [&](long) {
                          return processor_seconds() - began < 2 * enough;
                        }).at_rest;
  const auto steps = static_cast<double>(std::max<std::int64_t>(s.state().step, 1));
  t.each = (processor_seconds() - began) / steps;
  t.steps = at_rest ? steps : 0;
}

// --- All else ---

// How many rows and frames, and what one of them takes.
struct Outputs {
  double rows = 0, row = 0, frames = 0, frame = 0;
};

Outputs time_outputs(const Scene& scene, const Prepared& p, const RunTime& t) {
  Outputs o;
  const Simulation s = start(scene, p);
  const Observer observer = make_observer(scene, p);
  LimitWatch watch(watched_of(scene, p.topology, p.loads, p.interaction.law.get()));
  const double began = processor_seconds();
  const LogRow row = log_row(observer, scene, p.topology, s.state(), {});
  watch.check(p.topology, s.state(), s.list(), {}, false);
  log_line(row);
  o.row = processor_seconds() - began;
  const ElementColours colours = element_colours(p.topology, p.interaction, s.state());
  if (scene.run.frames_format == FrameFormat::dump) dump_frame(p.topology, s.state(), colours);
  o.frame = processor_seconds() - began - o.row;
  if (t.relaxes) {
    o.rows = std::ceil(t.steps / 100) + 1;  // as a relaxation writes them
    o.frames = 2;
    return o;
  }
  o.rows = scene.run.log_every > 0 ? p.duration / scene.run.log_every : usual_rows;
  o.frames = scene.run.frames_every > 0 ? p.duration / scene.run.frames_every : usual_frames;
  o.rows = std::min(o.rows, t.steps);
  o.frames = std::min(o.frames, t.steps);
  return o;
}

class Nobody : public RunListener {
  void tell(const std::string&) override {}
};

// Processor time of the first steps of a run, with all its files. Throws where it fails.
double seconds_of_a_run(const std::string& text, const std::string& path, std::int64_t steps) {
  const TemporaryFolder scratch;
  const std::string seconds = scratch.file("seconds");
  bool ended = false;
  const auto work = [&] {
    try {
      use_threads(1);
      Nobody nobody;
      RunSettings settings;
      settings.steps = steps;
      const Scene scene = scene_of_text(text, path);
      const RunEnd end = go_through(begin_run(scene, {scratch.file("run")}, settings, nobody)).end;
      if (end != RunEnd::finished && end != RunEnd::not_relaxed) return 1;
      write_file_atomically(seconds, fmt::format("{:.9g}", processor_seconds()));
      return 0;
    } catch (const std::exception&) {
      return 1;
    }
  };
  run_processes({{work, [&](int status) { ended = WIFEXITED(status) && WEXITSTATUS(status) == 0; }}}, 1);
  if (!ended)
    throw std::runtime_error(fmt::format(
        "a short run of the scene, to see what it takes, failed in {}: see whether there is room (TMPDIR "
        "names another place), and try the scene with `ropewalk run`",
        scratch.path()));
  return leading_number(read_file(seconds)).value_or(0);
}

void time_outputs_of_a_run(const std::string& text, const std::string& path, const Scene& scene, const Prepared& p,
                           RunTime& t) {
  const Outputs all = time_outputs(scene, p, t);
  const double affordable = std::max(enough / (t.each + all.row), static_cast<double>(min_steps));
  const double steps = std::max(1.0, std::min(affordable, t.relaxes ? t.steps : all.rows));
  Outputs some;
  some.rows = t.relaxes ? steps / 100 + 1 : steps;
  const double apart = std::max(1.0, std::floor(steps / std::max(frames_in_report, all.frames * steps / all.rows)));
  some.frames = t.relaxes ? 2 : steps / apart;
  std::string brief = text;
  if (!t.relaxes) {
    brief = with_key(brief, "run", "log_every_ps", fmt::format("{:.17g}", p.time_step));
    brief = with_key(brief, "run", "frames_every_ps", fmt::format("{:.17g}", apart * p.time_step));
  }
  const double seconds = seconds_of_a_run(brief, path, std::llround(steps));
  t.outputs = std::max(0.0, seconds - std::floor(steps) * t.each) + (all.rows - some.rows) * all.row +
              (all.frames - some.frames) * all.frame;
}

}  // namespace

RunTime time_run(const std::string& text, const std::string& path) {
  const int threads = threads_in_use();
  use_threads(1);
  Scene scene = scene_of_text(text, path);
  const Prepared p = prepare(scene);
  RunTime t;
  t.elements = p.topology.elements();
  t.relaxes = scene.run.mode == RunOptions::Mode::relax;
  if (t.relaxes) {
    time_relaxation(scene, p, t);
    t.at_start = t.each;
  } else {
    t.at_start = seconds_from_the_start(scene, p);
    t.each = seconds_of_steps(scene, p);
    t.steps = std::max(1.0, p.duration / p.time_step);
  }
  time_outputs_of_a_run(text, path, scene, p, t);
  use_threads(threads);
  return t;
}

}  // namespace ropewalk
