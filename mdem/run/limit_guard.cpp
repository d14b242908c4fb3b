#include "run/limit_guard.hpp"

#include <fmt/format.h>

#include <limits>

#include "scene/finer.hpp"

namespace ropewalk {

LimitGuard::LimitGuard(OnLimit on_limit, bool may_refine, const MovingScene& moving, const RunSchedule& schedule,
                       RunFiles& files, RunListener& listener)
    : on_limit_(on_limit),
      moving_(moving),
      schedule_(schedule),
      files_(files),
      listener_(listener),
      watch_(watched_by_run(moving.scene, moving.prepared, moving.observer),
             may_refine && on_limit != OnLimit::refine &&
                 why_not_finer(moving.scene, moving.prepared.topology).empty()) {}

void LimitGuard::check_before_start() const {
  if (on_limit_ != OnLimit::refine) return;
  const std::string why = why_not_refined();
  if (!why.empty()) throw InputError({"", 0, "--on-limit"}, "refine: " + why, "take warn or stop");
}

std::string LimitGuard::why_not_refined() const {
  if (moving_.simulation.broken_bonds()) return "tubes have broken";
  return why_not_finer(moving_.scene, moving_.prepared.topology);
}

void LimitGuard::inherit(const LimitsFile& earlier, std::int64_t step) {
  watch_.inherit_from(earlier.limits, step);
  refinements_ = earlier.refinements;
}

// NaN where it is not judged: in a relaxation, which makes its account close, and in the first window of the step
// control, where next to nothing has moved.
double LimitGuard::drift() const {
  const std::int64_t step = moving_.state().step;
  if (moving_.relaxes() || (step < StepControl::window && step != schedule_.scene_end()))
    return std::numeric_limits<double>::quiet_NaN();
  return energy_drift(moving_.account());
}

StopReason LimitGuard::check(bool with_pressure) {
  const Topology& topology = moving_.prepared.topology;
  const std::vector<std::string> passed = watch_.check(
      topology, moving_.simulation.tubes_now(), moving_.state(), moving_.simulation.list(),
      {drift(), moving_.relaxes() ? std::numeric_limits<double>::quiet_NaN() : moving_.account().kinetic},
      with_pressure);
  // The heading at its end is that of the limit.
  for (const std::string& line : passed)
    if (told_.insert(line.substr(line.rfind(' ') + 1)).second) listener_.tell(line);
  if (!passed.empty()) write();
  if (on_limit_ == OnLimit::stop && !passed.empty()) return StopReason::limit;
  if (on_limit_ != OnLimit::refine || !watch_.finer_would_help()) return StopReason::none;
  const std::string why = why_not_refined();
  if (why.empty()) return StopReason::refine;
  if (!passed.empty()) listener_.tell("not refined: " + why + "; the run goes on as it is");
  return StopReason::none;
}

std::string LimitGuard::words_of(const NumericalError& e) const {
  const Topology& topology = moving_.prepared.topology;
  std::string text = e.what();
  const std::string number = fmt::format("element {}:", e.element());
  const std::size_t at = text.find(number);
  if (e.element() < 0 || e.element() >= topology.elements() || at == std::string::npos) return text;
  return text.replace(at, number.size(), place_in_words(topology, held(), e.element()) + ":");
}

bool LimitGuard::would_refine() const {
  if (on_limit_ != OnLimit::refine) return false;
  for (std::size_t k = 0; k < records().size(); ++k)
    if (records()[k].passed && limit_kinds()[k].cured_by_finer) return true;
  return false;
}

}  // namespace ropewalk
