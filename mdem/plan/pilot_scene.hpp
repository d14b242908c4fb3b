// A scene made small enough to be run many times: the pilot of `plan`.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace ropewalk {

struct PilotScene {
  std::string text;
  double until = -1;  // ps, where it is run to; negative: to its end
  std::string words;  // "19 of 91 tubes, 27.1 of 67.8 nm"; empty: the whole scene
  // Factor from errors of the pilot to promised errors of the scene. A pilot with fewer tubes needs a larger
  // factor: it lacks the outer tubes, which bend most.
  double caution = 1;
};

// The scene takes `seconds`, the pilot about `affordable` or more where it cannot be smaller. In this order:
//
// 1. Shorter tubes in a rope under [twist], 20 elements at least. Ramp and hold are shortened alike, so that twist
// per
//    length, bends and speeds stay.
// 2. Fewer tubes in a rope, 7 at least; a smaller box of a film, as dense.
// 3. The first part of the time.
PilotScene pilot_scene(const Scene& scene, double seconds, double affordable);

}  // namespace ropewalk
