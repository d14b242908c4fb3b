// Kicks with PFC3D's local damping (model/damping.hpp), for comparison with that program.
#pragma once

#include "sim/forces/forces.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

//   v += (F - alpha |F| sign(v)) dt/m,   w += (M - alpha |M| sign(w)) dt/I
// of all elements, component by component. Returns the energy that the brake takes out (eV).
double kick_with_local_damping(const Topology& topology, double alpha, const Forces& forces, double dt,
                               State& state);

}  // namespace ropewalk
