// A tube of atoms at rest, as its parameter set describes it: where the lattice stands before elements move it.
#pragma once

#include "atoms/lattice.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

struct TubeReference {
  Honeycomb honeycomb;
  Chirality chirality;
  TubeShape shape;     // relaxed, with its natural twist
  double poisson = 0;  // -d ln r / d strain
};

// Throws InputError for a filament, and where radius and atoms per length of the set are not those of its (n,m), within
// 10 %.
TubeReference reference_of(const ParameterSet& set);

}  // namespace ropewalk
