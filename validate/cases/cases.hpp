// The cases, each defined in the file of its name.
#pragma once

#include "core/case.hpp"

namespace ropewalk {

Case stretch_and_cantilever_case();
Case euler_buckling_case();
Case greenhill_case();
Case michell_ring_case();
Case ring_energy_case();
Case wave_speeds_case();

}  // namespace ropewalk
