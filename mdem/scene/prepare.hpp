// From a scene to what the simulator takes: interaction, loads, state and time step.
#pragma once

#include "scene/build.hpp"
#include "scene/scene.hpp"
#include "scene/scene_to_model.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

struct Prepared {
  Topology topology;
  State state;
  Interaction interaction;
  LoadsAndConstraints loads;
  double spacing = 0;  // nm, of the untwisted rope; 0 where there is none
  TimeStepLimit limit;
  double time_step = 0;  // ps, of contact: what a step of the simulation takes
  Stepping stepping;
  double duration = 0;  // ps
};

// Throws InputError for a typed time step above the limit, for loads on elements that do not exist, for tubes of a
// state file inside one another (unless they are to be relaxed) and for a moment that a single tube cannot bear.
Prepared prepare(Scene& scene);
// Of the stability limit, where no time step is typed.
double automatic_step_fraction(const Scene& scene);

// The simulation of a prepared scene, with the scene's list skin. Throws InputError where its first step would end
// the run, or a bond slips already.
Simulation start(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
