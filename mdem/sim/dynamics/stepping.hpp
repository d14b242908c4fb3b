// How a simulation steps: on one level or on two, with which rotation, with which thermostat.
#pragma once

#include <memory>

#include "sim/dynamics/thermostat.hpp"

namespace ropewalk {

struct Stepping {
  int contact_every = 1;                              // inner steps in one step of the simulation
  bool runge_kutta = false;                           // rotations by move_elements_runge_kutta
  std::shared_ptr<const Thermostat> thermostat = {};  // on one level only; none: constant energy
};

}  // namespace ropewalk
