// States of rest of a scene without running it: Newton's method under the loads as they are in the end.
//
// Friction, links, failure and baths have no part in it: a scene with one of them is refused.
#pragma once

#include <string>
#include <vector>

#include "io/equilibria.hpp"
#include "observe/rope_shape.hpp"
#include "run/moving_scene.hpp"
#include "sim/statics/stability.hpp"

namespace ropewalk {

// The scene as a relaxation by Newton's method, with FIRE where contacts have yet to form. Throws InputError where
// it has drives that need time.
Scene static_scene(Scene scene);

struct StaticRest {
  std::string from;  // "below"
  bool at_rest = false;
  std::string why;                    // it is not at rest
  double twist = 0, beta = 0, Q = 0;  // deg, deg
  int steps = 0;                      // of Newton's method
  RopeShape shape = RopeShape::straight;
  StabilityVerdict stability;
  Equilibrium found;  // where it came to
  State state;

  std::string branch() const;  // as RestSide::branch()
};

// Where a signal stopped a search for states of rest (io/stop_signals.hpp).
struct StaticsStopped {};

// The state of rest nearest to where the scene begins. With `begin` elements begin there. Throws StaticsStopped.
StaticRest static_rest(const Scene& scene, const std::string& from, const State* begin = nullptr);

// Both ways along the motion that grows fastest, by a part of a radius; none where it is not known.
std::vector<State> along_growing_motion(const Scene& scene, const StaticRest& rest);

// Describes the fastest growing motion in the words of `modes`; empty: this motion is not known.
std::string growing_motion_words(const Scene& scene, const StaticRest& rest);

// What they say together, in a sentence or two. `tolerance`: part of the twist within which two are one state.
std::string static_rest_words(const std::vector<StaticRest>& rests, double tolerance);

// A row for each, and all of them with the words.
std::string static_rest_csv(const std::vector<StaticRest>& rests);
std::string static_rest_json(const std::vector<StaticRest>& rests, const std::string& words);
std::vector<OutputColumn> static_rest_columns();

}  // namespace ropewalk
