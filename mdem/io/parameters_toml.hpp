// The file of a parameter set; its format is described in model/parameters.hpp.
#pragma once

#include <string>

#include "model/parameters.hpp"

namespace ropewalk {

// Throws InputError for a file that is missing, not of this format, incomplete, without units or origins, or
// physically impossible.
ParameterSet read_parameters(const std::string& path);

}  // namespace ropewalk
