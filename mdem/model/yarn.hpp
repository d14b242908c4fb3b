// The angle of a yarn's surface: a yarn of diameter d (nm) with T turns per length (1/nm) has tan(beta) = pi d T, beta
// the angle between its surface fibres and its axis (helix of pitch 1/T on a cylinder of diameter d).
#pragma once

#include <cmath>

#include "model/units.hpp"

namespace ropewalk {

inline double yarn_slope(double turns, double diameter) { return units::pi * diameter * turns; }
inline double yarn_turns(double angle, double diameter) { return std::tan(angle) / (units::pi * diameter); }

}  // namespace ropewalk
