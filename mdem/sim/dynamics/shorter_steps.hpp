// A trial of some steps, with the remedy that a run has: where the motion blows up, it begins anew with every step
// divided in two.
#pragma once

#include "model/error.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

// Into so many shorter ones is a step divided at most.
inline constexpr int most_parts_of_a_step = 16;

// trial(simulation), of a copy of `begin`. Throws NumericalError where the shortest steps blow up as well, or
// shorter ones cannot help.
template <class Trial>
auto with_shorter_steps(const Simulation& begin, const Trial& trial) {
  for (int parts = begin.divided();; parts *= 2) {
    Simulation simulation = begin;
    if (parts > begin.divided()) simulation.divide_steps(parts);
    try {
      return trial(simulation);
    } catch (const NumericalError& e) {
      if (e.shorter_steps() == NumericalError::ShorterSteps::cannot_help || parts >= most_parts_of_a_step) throw;
    }
  }
}

}  // namespace ropewalk
