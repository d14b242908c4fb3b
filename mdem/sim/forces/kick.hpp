// The kick of an integrator: velocities by forces, with the terms that act in it (ForceTerm::acts_in_kick).
#pragma once

#include "sim/forces/forces.hpp"

namespace ropewalk {

// v += F dt/m,  w += M dt/I  of the elements of a segment. `terms`: those that act in the kick, or null. Returns
// the energy (eV) that they take out: the work of their forces at the mean of the velocities before and after.
double kick(const Topology& topology, const ForceTerms* terms, const ForceRows& total, double dt, const Segment& of,
            State& state);

}  // namespace ropewalk
