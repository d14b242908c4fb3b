// From a scene to what the simulator takes: interaction, drive, state and time step.
#pragma once

#include "scene/build.hpp"
#include "scene/scene.hpp"
#include "sim/simulation.hpp"

namespace ropewalk {

struct Prepared {
  Topology topology;
  State state;
  Interaction interaction;
  Drive drive;
  double spacing = 0;  // nm, of the untwisted rope; 0 where there is none
  TimeStepLimit limit;
  double time_step = 0;  // ps, of contact: what a step of the simulation takes
  Stepping stepping;
  double duration = 0;  // ps
};

// Throws InputError for a typed time step above the limit and for loads on elements that do not exist.
Prepared prepare(Scene& scene);

// The simulation of a prepared scene, with the scene's list skin.
Simulation start(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
