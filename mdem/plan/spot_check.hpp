// A run held against a finer model: from where it ended, a short stretch is run once more with its own model and
// once finer, and what is observed is compared.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/prepare.hpp"

namespace ropewalk {

struct SpotCheck {
  std::string how;
  struct Comparison {
    double here = 0, finer = 0;
    double error() const;  // relative to the finer one
  };
  std::map<std::string, Comparison> observables;
};

// The finer model has elements of half the length where loads allow (with another one between every two, so that
// the rope keeps its shape and its ends) with the same dissipation per length, nodes and cutoff of the law, double
// precision, one level, the tubes' own masses and half the default time step. A relaxed scene is relaxed again;
// another goes on for `stretch` ps, and means over the second half are compared: what another model would have
// changed on the way to this end does not show, and an angle that swings for tens of ps needs such a stretch.
// "energy" is that above the scene's start in the same model. `scene` as prepare() left it.
SpotCheck spot_check(const Scene& scene, const Prepared& prepared, const State& end, double stretch);

}  // namespace ropewalk
