// The scene of a case: scene.toml in its folder, which `ropewalk run` takes as it is.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/scene_toml.hpp"

namespace ropewalk::validate {

// Paths of values and what a case writes there: {"rope.length_nm", "81.4"}, {"grip.1.tubes", "[3]"}; see
// plan/scene_edit.hpp.
using ChangedValues = std::vector<std::pair<std::string, std::string>>;

// The scene of the case with this parameter set in place of its own, and with other values. Numbers that depend on
// the tube, as lengths in elements, are such values.
Scene scene_of_case(const std::string& name, const ParameterSet& set, const ChangedValues& values);

}  // namespace ropewalk::validate
