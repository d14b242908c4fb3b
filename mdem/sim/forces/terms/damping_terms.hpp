// The dampings of an interaction that are force terms. The forms are those of model/damping.hpp. The damping of
// bonds is computed with the bonds.
#pragma once

#include <memory>

#include "model/damping.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

// Acts on pairs of elements within the reach of the viscosity, where there is contact.
std::unique_ptr<ForceTerm> contact_viscosity_term(const ContactViscosity& viscosity);

// PFC's local damping, of the strength alpha: acts on the sum of all forces in the kick.
std::unique_ptr<ForceTerm> local_damping_term(double alpha);

}  // namespace ropewalk
