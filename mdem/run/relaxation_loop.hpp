// The loop of a run that goes to a minimum of the energy.
#pragma once

#include <optional>
#include <string>

#include "run/run_parts.hpp"
#include "sim/statics/newton.hpp"

namespace ropewalk {

class RelaxationLoop {
 public:
  explicit RelaxationLoop(RunParts& run) : run_(run) {}

  StopReason go();

 private:
  // Between two steps: whether it goes on.
  bool goes_on_after(long step);
  // FIRE alone, or Newton's method with it or without.
  Relaxed relax(long most, const std::function<bool(long)>& progress);
  std::string words_of(const Relaxed& end, long max_steps) const;
  std::string words_of(const Statics& end, long max_steps);
  std::string status() const;

  RunParts& run_;
  StopReason stop_ = StopReason::none;
  long most_ = 0;  // steps
  std::optional<NewtonStatics> newton_;
  Statics statics_;  // its last result
};

}  // namespace ropewalk
