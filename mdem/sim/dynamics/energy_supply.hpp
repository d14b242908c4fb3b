// The energy that has crossed the boundary of the model since the start.
#pragma once

namespace ropewalk {

// All in eV.
struct EnergySupply {
  double work = 0;        // done by loads and constraints on the elements
  double dissipated = 0;  // taken out by damping
  double heat = 0;        // brought in by the thermostat, negative where it cools

  // The energy that the elements must hold (eV), less that of the start. What the total energy differs by is the
  // error of the integration.
  double supplied() const { return work - dissipated + heat; }
};

}  // namespace ropewalk
