// The loop of a run over time steps.
#pragma once

#include <string>

#include "run/run_parts.hpp"

namespace ropewalk {

class DynamicsLoop {
 public:
  explicit DynamicsLoop(RunParts& run) : run_(run) {}

  // Throws NumericalError where the motion blows up and shorter steps do not help.
  StopReason go();

 private:
  // A number of steps after which something is due. What is due follows from the scene alone, and not from where
  // the run is to stop, so that a run that goes on is the one that was never stopped.
  struct Stretch {
    long count = 0;
    std::int64_t step = 0;  // at its end
    bool closely = false;   // a device is looked at as often as this processor
    bool last = false, logged = false, marked = false, framed = false, checked = false;
  };
  Stretch next_stretch() const;
  // False where the run went back.
  bool advance(const Stretch& stretch);
  // Whether the run ends after it.
  StopReason end_of(const Stretch& stretch);
  bool is_decided();
  std::string status() const;

  RunParts& run_;
  double seconds_of_a_step_ = RunSchedule::patience;
};

}  // namespace ropewalk
