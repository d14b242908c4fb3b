// How a simulation steps: with which rotation, with which thermostat.
#pragma once

#include <memory>

#include "sim/dynamics/thermostat.hpp"

namespace ropewalk {

struct Stepping {
  bool runge_kutta = false;                           // rotations by move_elements_runge_kutta
  std::shared_ptr<const Thermostat> thermostat = {};  // none: constant energy
};

}  // namespace ropewalk
