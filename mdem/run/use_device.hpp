// The device that a user names.
#pragma once

#include <string>

#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

inline constexpr char no_device[] = "none";
inline bool names_device(const std::string& option) { return !option.empty() && option != no_device; }

// Moves the simulation on this device (sim/device/device.hpp has the names). Throws InputError for the option
// --device where there is none of that name, where it does not suit the scene, or where it fails at once.
void use_device(Simulation& simulation, const std::string& name);

}  // namespace ropewalk
