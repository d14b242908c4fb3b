// Makes what the simulator takes from a scene: interaction, loads, state and time step.
#pragma once

#include <string>
#include <vector>

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
  double spacing = 0;  // spacing in the untwisted rope, nm; 0: there is no rope
  TimeStepLimit limit;
  double time_step = 0;  // ps
  Stepping stepping;
  double duration = 0;  // ps
};

// Throws InputError for a typed time step above the limit, for loads on elements that do not exist, for tubes of a
// state file inside one another (unless they are to be relaxed) and for a moment that a single tube cannot bear.
Prepared prepare(Scene& scene);
// Fraction of the stability limit that an untyped time step takes; an upper bound in warm scenes.
double automatic_step_fraction(const Scene& scene);

// It has a thermostat, or a temperature at the start that is not to be lost. Its automatic step keeps
// excess_of_positions() to this.
bool is_warm(const Scene& scene);
inline constexpr double warm_excess = 0.02;

// Throws InputError where damping would take most of the heat that the scene starts with before the run ends, or
// most of that of its thermostat at any time. Not part of prepare(), so that runs that are there already can be
// read.
void refuse_cooling(const Scene& scene, const Prepared& prepared);
// Effects of time step and damping on the temperature of a scene that has one; a sentence each.
std::vector<std::string> warmth_of(const Scene& scene, const Prepared& prepared);

// The elements at both ends: those that loads name, or else the first and last of every tube.
EndElements ends_of(const LoadsAndConstraints& loads, const Topology& topology);

// The simulation of a prepared scene, with the scene's list skin. Throws InputError where its first step would end
// the run, or a bond slips already.
Simulation start(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
