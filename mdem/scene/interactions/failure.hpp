// Tubes that break: the table [failure], and tubes of a state file that have broken before.
#pragma once

#include <memory>

#include "sim/forces/force_term.hpp"

namespace ropewalk {

// For a scene without [failure]: no further bond breaks.
std::shared_ptr<const ForceTerm> broken_tubes_term(const Topology& topology);

}  // namespace ropewalk
