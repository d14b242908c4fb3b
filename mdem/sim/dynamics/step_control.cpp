#include "sim/dynamics/step_control.hpp"

#include <algorithm>

namespace ropewalk {

int StepControl::shorten(int divided, std::int64_t step) {
  const bool too_early = kept_until > 0 && step >= kept_until;  // they had just been put together again
  if (too_early) keep = std::min(2 * keep, most_keep);
  kept_until = step + keep;
  return 2 * divided;
}

int StepControl::lengthen(int divided, std::int64_t step) {
  if (step < kept_until) return divided;
  if (divided > 1) {
    kept_until = step + least_keep;
    return divided / 2;
  }
  if (keep > least_keep) {
    keep = std::max(keep / 2, least_keep);
    kept_until = step + least_keep;
  }
  return divided;
}

bool StepControl::looks_closely(int divided, std::int64_t step) const {
  return step < close_until || divided > 1 || keep > least_keep || step < kept_until;
}

}  // namespace ropewalk
