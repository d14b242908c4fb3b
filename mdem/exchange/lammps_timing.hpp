// The simulator on N threads and LAMMPS on N ranks, by turns in one run, since the speed of a machine wanders from
// minute to minute.
#pragma once

#include <algorithm>
#include <string>

#include "scene/prepare.hpp"

namespace ropewalk {

// The times of all steps, s. Processor time is that of all threads or ranks, waiting included.
struct StepsTime {
  double wall = 1e300, processor = 1e300;

  void take_shorter(const StepsTime& o) {
    wall = std::min(wall, o.wall);
    processor = std::min(processor, o.processor);
  }
};

struct LammpsTiming {
  StepsTime native, lammps;
};
// The shortest times of `rounds` rounds of steps from the start. `lammps`: the program lmp-ropewalk. `plain`:
// LAMMPS by the plain forms. Throws InputError where LAMMPS fails.
LammpsTiming time_beside_lammps(Scene scene, const std::string& lammps, int ranks, long steps, bool plain,
                                int rounds);

}  // namespace ropewalk
