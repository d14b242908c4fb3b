// The kinds of terms that shipped scenes can have. The room of scenes names them; this room cannot include it.
#pragma once

#include <vector>

#include "sim/forces/force_term.hpp"

namespace ropewalk {

// Called once, at the first term_kinds(). To be set by a static variable.
bool set_shipped_terms(std::vector<TermKind> (*terms)());

}  // namespace ropewalk
