// Times at which a rope rests while its loads go through their schedules: quasi-static loading.
#pragma once

#include <vector>

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

// ps, rising: the time at which the first schedule begins to change, and `steps` later ones. They are spread evenly
// over the stretches in which something changes; the end of each such stretch is one of them, so that there are
// more than `steps` where the schedules have more stretches. Empty: no load or constraint changes.
std::vector<double> load_step_times(const LoadsAndConstraints& loads, int steps);

}  // namespace ropewalk
