#include "run/accuracy.hpp"

#include "model/error.hpp"
#include "plan/outcome.hpp"
#include "plan/spot_check.hpp"
#include "run/run_checkpoint.hpp"

namespace ropewalk {

Accuracy accuracy_against(const RunDirectory& dir, const RunDirectory& other) {
  const auto outcome = [&](const RunDirectory& run) {
    const std::vector<LogRow> log = read_log(run.log());
    if (log.empty()) throw InputError({run.log(), 0, ""}, "has no rows", "run the scene first");
    return outcome_of(log, usual_observables(), read_run_scene(run).run.mode == RunOptions::Mode::relax);
  };
  const Outcome here = outcome(dir), reference = outcome(other);
  Accuracy out{"the end of another run, means over the last quarter", {}};
  for (const auto& [name, error] : differences(here, reference))
    out.found[name] = {here.of.at(name).value, reference.of.at(name).value, error};
  return out;
}

Accuracy accuracy_by_stretch(const RunDirectory& dir, double stretch) {
  Scene scene = read_run_scene(dir);
  const RunCheckpoint checkpoint = read_checkpoint(dir);
  const Prepared prepared = prepare(scene);
  const Simulation simulation = simulation_at(dir, scene, prepared, checkpoint);
  const SpotCheck spot = spot_check(scene, prepared, simulation.state(), stretch);
  Accuracy out{spot.how, {}};
  for (const auto& [name, pair] : spot.observables) out.found[name] = {pair.here, pair.finer, pair.error()};
  return out;
}

}  // namespace ropewalk
