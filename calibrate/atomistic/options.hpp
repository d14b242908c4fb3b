// Checks of what a calibration is asked for, before LAMMPS starts.
#pragma once

#include "atomistic/stiffness.hpp"

namespace ropewalk::calibrate {

// Throw InputError for a tube that is too narrow (`a`: lattice constant, nm), and for windows and lengths that are none.
void check_tube(Chirality c, double a);
void check_options(const StiffnessOptions& options);

}  // namespace ropewalk::calibrate
