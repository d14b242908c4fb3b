// Parameter sets side by side.
#pragma once

#include <string>
#include <vector>

#include "model/parameters.hpp"

namespace ropewalk {

// Rows of text: heads, then a line for each number, with the difference of each further set from the first.
std::vector<std::vector<std::string>> sets_table(const std::vector<ParameterSet>& sets);
std::string sets_json(const std::vector<ParameterSet>& sets);
// The table and the energies of tubes against strain, twist, curvature, distance and crossing angle.
std::string sets_page(const std::vector<ParameterSet>& sets);

}  // namespace ropewalk
