// Rollback: restores the last good snapshot of a run after a blow-up or an energy error. Steps are shorter from
// there on (sim/dynamics/step_control.hpp).
#pragma once

#include <string>

#include "run/checkpoints.hpp"
#include "run/stop_watch.hpp"

namespace ropewalk {

class Rollback {
 public:
  Rollback(MovingScene& moving, RunFiles& files, LimitGuard& limits, StopWatch& stops, Checkpoints& checkpoints,
           RunListener& listener)
      : moving_(moving),
        files_(files),
        limits_(limits),
        stops_(stops),
        checkpoints_(checkpoints),
        listener_(listener) {}

  // The present state is good.
  void take_snapshot();
  // A model that gains energy has no account to close.
  bool is_sound() const;
  // The next steps are shorter, or looked at more closely if they have not been. False where steps are as short as
  // they get: the failure stands.
  bool roll_back(const std::string& why, bool looked_closely);

 private:
  MovingScene& moving_;
  RunFiles& files_;
  LimitGuard& limits_;
  StopWatch& stops_;
  Checkpoints& checkpoints_;
  RunListener& listener_;
};

}  // namespace ropewalk
