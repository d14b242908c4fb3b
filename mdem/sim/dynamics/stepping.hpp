// How a step goes: on one level or on two, and what turns the elements. See sim/dynamics/simulation.hpp.
#pragma once

namespace ropewalk {

struct Stepping {
  int contact_every = 1;     // inner steps in one step of the simulation
  bool runge_kutta = false;  // rotations by move_elements_runge_kutta
};

}  // namespace ropewalk
