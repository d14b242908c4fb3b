#pragma once

#include "run/run_parts.hpp"

namespace ropewalk {

// What manifest.json says of a run now. `status`: see Manifest.
Manifest manifest_of(const RunParts& run, const std::string& status, const std::string& reason);

}  // namespace ropewalk
