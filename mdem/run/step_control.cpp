#include "run/step_control.hpp"

#include <algorithm>

namespace ropewalk {

void StepControl::shorten(int divided, Simulation& simulation) {
  const std::int64_t step = simulation.step_count();
  simulation.divide_steps(2 * divided);
  const bool too_early = kept_until > 0 && step >= kept_until;  // they had just been put together again
  if (too_early) keep = std::min(2 * keep, most_keep);
  kept_until = step + keep;
}

bool StepControl::looks_closely(const Simulation& simulation) const {
  const std::int64_t step = simulation.step_count();
  return step < close_until || simulation.divided() > 1 || keep > least_keep || step < kept_until;
}

void StepControl::lengthen(Simulation& simulation) {
  const std::int64_t step = simulation.step_count();
  if (step < kept_until) return;
  if (simulation.divided() > 1) {
    simulation.divide_steps(simulation.divided() / 2);
    kept_until = step + least_keep;
  } else if (keep > least_keep) {
    keep = std::max(keep / 2, least_keep);
    kept_until = step + least_keep;
  }
}

}  // namespace ropewalk
