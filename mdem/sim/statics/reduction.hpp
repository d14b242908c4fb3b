// The motions that the constraints of a state allow, as coordinates in which the modes of the state are found: each
// free unknown of an element, the motions of what a clamp ties together, and in a slice of an endless rope its own
// elements with their images, and the period where it is free (allowed_motions.hpp).
#pragma once

#include <optional>
#include <string>

#include "sim/dynamics/modes.hpp"

namespace ropewalk {

// None, and the reason in `why`, where there are none of this kind.
std::optional<Reduction> reduction_of(const Simulation& simulation, std::string& why);

// eV/nm: the largest of these forces that constraints leave, torques over the radius.
double largest_free_force(const Simulation& simulation, const Eigen::VectorXd& force);

}  // namespace ropewalk
