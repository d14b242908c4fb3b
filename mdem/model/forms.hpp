// C++ reading of forms.h: forms on plain numbers, for loops that the compiler vectorises. All else calls bond.hpp,
// anharmonic.hpp and damping.hpp, which have the equations, and Eigen's vectors.
#pragma once

#include <cmath>

#include "model/dialect.h"

namespace ropewalk::forms {
using std::sqrt;
#include "model/forms.h"
}  // namespace ropewalk::forms

#undef FUNCTION
#undef GLOBAL
#undef DEFAULT_0
