// What a state of rest by Newton's method costs, before it is solved for. The parts of a step are timed once at the
// state as it is; how many of them a state takes is that of ropes of 7 to 91 tubes under couples.
#pragma once

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct StaticsCost {
  double first_seconds = 0;      // time of the first state, from a start that does not rest
  double next_seconds = 0;       // time of the next state along a schedule
  double stability_seconds = 0;  // time of the verdict on each state; 0: its modes would take too long
  double bytes = 0;              // memory of the tangent, and of the simulations that a step keeps
  double decomposition_bytes = 0;
};
// Throws std::runtime_error for a force term without a tangent.
StaticsCost statics_cost(const Simulation& simulation);

}  // namespace ropewalk
