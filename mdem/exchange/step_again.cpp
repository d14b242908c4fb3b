#include "exchange/step_again.hpp"

#include <algorithm>

#include "io/removal.hpp"
#include "model/error.hpp"
#include "run/begin_run.hpp"
#include "run/run_checkpoint.hpp"
#include "sim/contact/line/engine.hpp"

namespace ropewalk {
namespace {

// Passes progress and requests for an end on, and no remarks, which the run has made once.
class ProgressAlone : public RunListener {
 public:
  explicit ProgressAlone(RunListener& to) : to_(to) {}
  void tell(const std::string&) override {}
  std::string asked_to_stop() override { return to_.asked_to_stop(); }
  void begin_loop(double done, double total) override { to_.begin_loop(done, total); }
  bool wants_progress() override { return to_.wants_progress(); }
  void progress(double done, const std::string& status) override { to_.progress(done, status); }
  void end_loop() override { to_.end_loop(); }

 private:
  RunListener& to_;
};

bool is_passed_there(const std::vector<LimitRecord>& limits, const LimitPlace& place) {
  return std::any_of(limits.begin(), limits.end(), [&](const LimitRecord& r) {
    return r.key == place.limit && r.passed && r.passed_at_step == place.step && r.passed_tube == place.tube &&
           r.passed_element == place.element;
  });
}

}  // namespace

std::optional<double> seconds_to_step_again(const RunDirectory& dir, const LimitPlace& place, std::string& why) {
  const Manifest m = read_manifest(dir.manifest());
  if (m.status == "taken from atoms") {
    why = "its frames were taken from atoms";
    return std::nullopt;
  }
  if (m.steps < 1) {
    why = "its manifest has no steps";
    return std::nullopt;
  }
  return m.wall_seconds * static_cast<double>(place.step) / static_cast<double>(m.steps);
}

std::optional<AtomicState> state_at_limit(const RunDirectory& dir, const LimitPlace& place, RunListener& listener,
                                          std::string& why) {
  const Manifest m = read_manifest(dir.manifest());
  if (!use_instructions(m.instructions)) {
    why = "it was run with " + m.instructions + ", which this processor has not got";
    return std::nullopt;
  }
  const TemporaryFolder work;
  const RunDirectory again{work.file("again")};
  Scene scene = read_run_scene(dir);
  ProgressAlone progress(listener);
  RunSettings settings;
  settings.steps = place.step;
  settings.may_refine = false;
  try {
    const RunResult result = go_through(begin_run(scene, again, settings, progress));
    if (result.end == RunEnd::asked) {
      why = result.reason;
      return std::nullopt;
    }
  } catch (const InputError& e) {
    why = e.what();
    return std::nullopt;
  }
  const RunCheckpoint end = read_checkpoint(again);
  const Prepared prepared = prepare(scene);
  const Simulation simulation = simulation_at(again, scene, prepared, end);
  if (simulation.state().step != place.step || !is_passed_there(end.limits.limits, place)) {
    why = "this program on this processor does not pass the limit at that step";
    return std::nullopt;
  }
  AtomicState out = state_in_scene(scene, prepared, simulation.state());
  if (const std::vector<char>* broken = simulation.broken_bonds()) out.broken = *broken;
  return out;
}

}  // namespace ropewalk
