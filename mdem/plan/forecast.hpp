// Forecast, before a run, of the limits of the model that a scene will pass.
#pragma once

#include <string>
#include <vector>

#include "scene/prepare.hpp"

namespace ropewalk {

// A sentence for each, by the upper estimates of features_of(); where the load grows, with the time when it gets there.
std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& prepared);

}  // namespace ropewalk
