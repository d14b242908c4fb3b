// The file of a parameter set; its format is described in model/parameters.hpp.
#pragma once

#include <string>

#include "model/parameters.hpp"

namespace ropewalk {

// Throws InputError for a file that is missing, not of this format, incomplete, without units or origins, or
// physically impossible.
ParameterSet read_parameters(const std::string& path);

// The text of a parameter file from its meta data, quantities, universal law and provenance; `comment` heads it.
// What is written is read back bit for bit.
std::string parameters_text(const ParameterSet& set, const std::string& comment);

}  // namespace ropewalk
