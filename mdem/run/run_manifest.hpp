#pragma once

#include "run/run_parts.hpp"

namespace ropewalk {

// The content of manifest.json for a run as it stands. `status`: see Manifest.
Manifest manifest_of(const RunParts& run, const std::string& status, const std::string& reason);

}  // namespace ropewalk
