// The loop of a run that goes to a minimum of the energy.
#pragma once

#include <string>

#include "run/run_parts.hpp"

namespace ropewalk {

class RelaxationLoop {
 public:
  explicit RelaxationLoop(RunParts& run) : run_(run) {}

  StopReason go();

 private:
  // Between two steps: whether it goes on.
  bool goes_on_after(long step);
  std::string words_of(const Relaxed& end, long max_steps) const;
  std::string status() const;

  RunParts& run_;
  StopReason stop_ = StopReason::none;
  long most_ = 0;  // steps
};

}  // namespace ropewalk
