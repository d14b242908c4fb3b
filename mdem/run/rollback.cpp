#include "run/rollback.hpp"

#include <fmt/format.h>

namespace ropewalk {

void Rollback::take_snapshot() {
  checkpoints_.take_snapshot();
}

bool Rollback::is_sound() const {
  return moving_.scene.contact.legacy_torque || account_closes(checkpoints_.snapshot()->energy, moving_.simulation);
}

bool Rollback::roll_back(const std::string& why, bool looked_closely) {
  Simulation& simulation = moving_.simulation;
  const int divided = simulation.divided();
  const double time = simulation.time();
  const std::int64_t step = simulation.step_count();
  if (divided >= StepControl::most) return false;
  const RunCheckpoint& c = *checkpoints_.snapshot();
  simulation.restore(c.simulation);
  if (looked_closely)
    simulation.divide_steps(moving_.control.shorten(divided, simulation.step_count()));
  else
    moving_.control.close_until = step;
  limits_.roll_back_to(c.limits, simulation.step_count());
  stops_.cut(simulation.step_count());
  checkpoints_.save_snapshot_over_later();
  files_.cut(c.files);
  if (!looked_closely) return true;
  // The remedy, after the semicolon of the message, is left out: a shorter step is what the run takes now.
  listener_.tell(fmt::format("{:.4g} ps: {}; back to {:.4g} ps, on with steps of {:.4g} fs", time,
                             why.substr(0, why.find(';')), simulation.time(),
                             simulation.time_step() / simulation.divided() / units::fs));
  return true;
}

}  // namespace ropewalk
