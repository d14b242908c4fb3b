#include "run/run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/bath_words.hpp"
#include "io/error_exit.hpp"
#include "io/log.hpp"
#include "model/error.hpp"
#include "run/dynamics_loop.hpp"
#include "run/load_steps_loop.hpp"
#include "run/pending_files.hpp"
#include "run/refined_run.hpp"
#include "run/relaxation_loop.hpp"
#include "run/results.hpp"
#include "run/run_manifest.hpp"
#include "run/stages.hpp"
#include "scene/network_words.hpp"

namespace ropewalk {
namespace {

StopReason go_loop(RunParts& parts) {
  if (parts.moving.scene.statics.steps > 0) return LoadStepsLoop(parts).go();
  return parts.moving.relaxes() ? RelaxationLoop(parts).go() : DynamicsLoop(parts).go();
}

}  // namespace

void Run::write_manifest(const char* status, const std::string& reason) {
  parts_.files.write_manifest(manifest_of(parts_, status, reason));
}

void Run::write_end(const char* status, const std::string& reason) {
  const RunDirectory& dir = parts_.files.directory();
  write_manifest(status, reason);
  report_or_tell(dir, parts_.listener,
                 [&] { parts_.files.write_report(report_of(dir, parts_.moving.scene, parts_.moving.prepared)); });
  parts_.files.try_again();
}

RunResult Run::go() {
  parts_.clock.since = steady_seconds();
  try {
    switch (go_loop(parts_)) {
      case StopReason::limit:
        return stopped_at_limit();
      case StopReason::refine:
        return refined();
      case StopReason::wall_time:
        return stopped(RunEnd::wall_time);
      case StopReason::asked:
        return stopped(RunEnd::asked);
      case StopReason::complete:
      case StopReason::none:
        break;
    }
    return finish();
  } catch (const NumericalError& e) {
    return failed(e);
  } catch (const std::exception& e) {
    return broken_off(e);
  }
}

RunResult Run::result(RunEnd end, const std::string& reason) const {
  RunResult r;
  r.end = end;
  r.directory = parts_.files.directory();
  r.reason = reason;
  r.passed = passed_words(parts_.limits.records());
  r.beyond_since = beyond_sentence(parts_.limits.records());
  r.worst = worst_words(parts_.limits.records());
  r.beyond = beyond_limits(parts_.limits.records());
  if (!parts_.moving.relaxes()) r.damping = damping_words(parts_.last_row);
  r.missing = parts_.files.missing();
  r.steps = parts_.step();
  r.time_ps = parts_.moving.simulation.time();
  r.wall_seconds = parts_.clock.seconds();
  r.relaxes = parts_.moving.relaxes();
  return r;
}

// Without them where its files were taken away meanwhile.
void Run::add_results(RunResult& r) const {
  try {
    if (parts_.moving.relaxes()) return;
    r.results = result_sentences(results_of(r.directory, parts_.moving.prepared));
    if (const ThermostatOptions* bath = parts_.moving.scene.bath())
      if (const std::string words = bath_words(read_log(r.directory.log()), bath->coupling); !words.empty())
        r.results.push_back(words);
  } catch (const InputError&) {
  }
}

RunResult Run::finish() {
  parts_.checkpoints.write_results();
  write_end(parts_.at_rest ? "finished" : "not relaxed", parts_.reason);
  RunResult r = result(parts_.at_rest ? RunEnd::finished : RunEnd::not_relaxed, parts_.reason);
  r.remedy = parts_.remedy;
  r.network = network_words(parts_.moving.scene, parts_.moving.simulation.tubes_now(), parts_.state());
  if (r.missing.empty()) {
    const bool whole =
        parts_.moving.relaxes() || !parts_.reason.empty() || parts_.step() >= parts_.schedule.scene_end();
    if (whole) r.expected = judge(parts_.moving.scene.expected, r.directory);
    add_results(r);
  } else {
    r.end = RunEnd::incomplete;
  }
  return r;
}

RunResult Run::stopped_at_limit() {
  parts_.checkpoints.write_results();
  const std::string reason = fmt::format("stopped at {:.3f} ps where a limit was passed: {}", parts_.state().time,
                                         passed_words(parts_.limits.records()));
  write_end("stopped", reason);
  RunResult r = result(RunEnd::at_limit, reason);
  add_results(r);
  return r;
}

RunResult Run::stopped(RunEnd end) {
  write_limits();  // no final state, which takes as long as a checkpoint: batch systems wait for some seconds only
  const std::string reason =
      fmt::format("stopped {} at {:.3f} ps", parts_.asked_by, parts_.moving.simulation.time());
  write_manifest("interrupted", reason);
  parts_.files.try_again();
  return result(end, reason);
}

// This run ends here, whole; the next one is made of it. With the first checkpoint of the next one `resume` goes on
// there: all results of this run stand before.
RunResult Run::refined() {
  const RunDirectory& from = parts_.files.directory();
  const RunDirectory to = finer_directory(from);
  DirectoryLock lock = write_finer_scene(from, parts_.moving.scene, parts_.moving.prepared, parts_.state().time,
                                         parts_.settings.force);
  auto next = std::make_unique<Run>(to, read_run_scene(to), parts_.settings, parts_.listener);
  next->hold(std::move(lock));
  const RefinementRecord split = go_on_finer(parts_, next->parts_);
  parts_.limits.add(split);
  parts_.checkpoints.write_results();
  parts_.files.try_again();
  next->begin_files();
  parts_.checkpoints.save_kept();
  write_end("refined",
            fmt::format("every element was split at {:.3f} ps; it goes on in {}", split.time_ps, split.to));
  parts_.listener.tell(refinement_words(split, to));
  RunResult r;
  r.next = std::move(next);
  return r;
}

RunResult Run::failed(const NumericalError& e) {
  write_limits();
  try {
    parts_.files.write_events(parts_.moving);
  } catch (const InputError& no_room) {
    parts_.listener.tell(fmt::format("{}; the last events are missing there", no_room.what()));
  }
  parts_.files.write_failed_state(parts_.moving);
  const std::string why = parts_.limits.words_of(e);
  write_end("failed", why);
  RunResult r = result(RunEnd::failed, why);
  add_results(r);
  r.error = std::current_exception();
  return r;
}

// The last good state is saved if that is still possible.
RunResult Run::broken_off(const std::exception& e) {
  const std::string why = error_words(e);
  std::exception_ptr error = std::current_exception();
  try {
    parts_.checkpoints.save_snapshot();
  } catch (const std::exception&) {
    // The last checkpoint stands.
  }
  write_manifest("interrupted", why);
  RunResult r = result(RunEnd::broken_off, why);
  r.error = std::move(error);
  return r;
}

RunResult go_through(std::unique_ptr<Run> run) {
  for (;;) {
    RunResult result = run->go();
    if (!result.next) return result;
    run = std::move(result.next);
  }
}

}  // namespace ropewalk
