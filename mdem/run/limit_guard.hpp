// The guard of a run's limits: it says which are passed, keeps limits.json, and may end the run at one.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "model/error.hpp"
#include "run/limit_watch.hpp"
#include "run/run_files.hpp"
#include "run/run_schedule.hpp"
#include "run/stop_reason.hpp"

namespace ropewalk {

class LimitGuard {
 public:
  // `may_refine`: whether who runs it could give --on-limit refine.
  LimitGuard(OnLimit on_limit, bool may_refine, const MovingScene& moving, const RunSchedule& schedule,
             RunFiles& files, RunListener& listener);

  // Throws InputError where elements are to be split and cannot be.
  void check_before_start() const;
  // Tells the limits passed for the first time; returns whether the run is to end here for one. The pressure costs
  // several steps.
  StopReason check(bool with_pressure);

  // Takes over the limits of a run that goes on, without those passed after `step`.
  void inherit(const LimitsFile& earlier, std::int64_t step);
  // The run went back to a state with these records.
  void roll_back_to(const LimitsFile& earlier, std::int64_t step) { watch_.inherit_from(earlier.limits, step); }
  void add(const RefinementRecord& refinement) { refinements_.push_back(refinement); }

  OnLimit on_limit() const { return on_limit_; }
  // Whether a limit that was passed, and only said, may be cured now.
  bool would_refine() const;
  const std::vector<LimitRecord>& records() const { return watch_.records(); }
  const std::vector<Held>& held() const { return watch_.held(); }
  // The message with tube, element and clamp in place of the element's number in the scene.
  std::string words_of(const NumericalError& e) const;
  LimitsFile file() const { return {watch_.records(), refinements_}; }
  void write() { files_.write_limits(file()); }

 private:
  double drift() const;
  // Why the elements cannot be split now; empty: they can. Where a tube is broken, half of an element would come to
  // stand in the gap.
  std::string why_not_refined() const;

  OnLimit on_limit_;
  const MovingScene& moving_;
  const RunSchedule& schedule_;
  RunFiles& files_;
  RunListener& listener_;
  LimitWatch watch_;
  std::set<std::string> told_;  // limits: once, also where the run went back and passed one again
  std::vector<RefinementRecord> refinements_;
};

}  // namespace ropewalk
