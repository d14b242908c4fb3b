// Thermal velocities.
#pragma once

#include "scene/random.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Degrees of freedom of free rigid elements without net linear and angular momentum.
inline double thermal_freedoms(const State& state) { return 6.0 * static_cast<double>(state.size()) - 6.0; }

// Linear momentum, and angular momentum about the centre of mass with the elements' own spins.
struct Momenta {
  Vector3 linear = Vector3::Zero();   // eV ps/nm
  Vector3 angular = Vector3::Zero();  // eV ps
};
Momenta net_momenta(const Topology& topology, const State& state);

// Maxwell's distribution for translation and rotation, then no net momenta, then scaled such that the kinetic
// energy is exactly thermal_freedoms kT/2. At least two elements.
void set_thermal_velocities(const Topology& topology, double temperature, Random& random, State& state);

}  // namespace ropewalk
