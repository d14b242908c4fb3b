// Whether a thermostat held its temperature, from the log of the run.
//
// In a bath of the coupling g the kinetic energy K of the tubes changes by 2 g (K_0 - K), with that of its temperature
// K_0. Losses that it replaces, P, so leave them at K/K_0 = K/(K + P/2g).
#pragma once

#include <string>
#include <vector>

#include "io/log.hpp"

namespace ropewalk {

// A sentence where friction and damping took so much in the second half of the run that the tubes were more than 1 %
// too cold; else empty. The strength of friction takes energy only where tubes slide, so that nobody knows it
// beforehand. `coupling` in 1/ps.
std::string bath_words(const std::vector<LogRow>& log, double coupling);

}  // namespace ropewalk
