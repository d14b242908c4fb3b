// Where a method fails: the place is found by bisection on the method itself, and theory stands beside it.
#pragma once

#include "cases/common/chain.hpp"

namespace ropewalk {

// Where `fails` turns from false to true, to `relative` of the value; `low` must hold and `high` fail, else NaN.
double limit_between(const std::function<bool(double)>& fails, double low, double high, double relative = 1e-3);

// Whether a state shaken by tiny random velocities blows up within `steps`: the simulator stops, or the kinetic
// energy grows a millionfold.
bool blows_up(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps = 500);

// Factor by which the kinetic energy of such a state has grown after so many steps; endless where the simulator
// stops.
double growth(const Topology& topology, const Interaction& interaction, const State& state, double time_step,
              long steps);

// The largest angular frequency (rad/ps) of small motions about a state at rest, from the eigenvalues of its
// stiffness by differences of the forces.
double stiffest_frequency(const Topology& topology, const Interaction& interaction, const State& state);

// The step at which dt^2 K + 2 dt D reaches the eigenvalue 4, K and D the stiffness and the damping over the masses
// by differences of the forces: 2/w without damping.
double largest_damped_step(const Topology& topology, const Interaction& interaction, const State& state);

// The set with elements so many times as long.
ParameterSet with_elements(ParameterSet set, double factor);

}  // namespace ropewalk
