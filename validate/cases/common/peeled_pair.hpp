// Two adhering tubes that are pulled apart at one end.
#pragma once

#include "cases/common/bundle.hpp"

namespace ropewalk::validate {

struct Peel {
  double opening = 0;  // of each end from rest, nm
  double force = 0;    // on each end, eV/nm
  double release = 0;  // force times sine of the slope, both tubes, eV/nm
};
// At rest, with the ends of both tubes of 50 elements moved apart by this opening (nm, each). crack: the length (nm) over
// which the start is open. Throws NumericalError where the rest takes too many steps.
Peel peel(const ParameterSet& set, double opening, double crack);

}  // namespace ropewalk::validate
