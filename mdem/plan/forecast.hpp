// Forecast, before a run, of the limits of the model that a scene will pass, and of how far its torque is from
// rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/prepare.hpp"

namespace ropewalk {

// A sentence for each, by the upper estimates of plan/demands.hpp: what the scene begins with, and what the load
// brings it to, with the time when it gets there. Before them, when tubes break by [failure]; limits are foreseen until
// a quarter later than the strongest break.
std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& prepared);

// What of this scene limits_ahead() leaves out, as a sentence; empty: nothing.
std::string not_foreseen(const Scene& scene, const Prepared& prepared);

// Where a moment on each tube makes a helix of the straight rope, by plan/sliding_rope.hpp. None: it does not, or
// the theory is not for this scene.
std::optional<std::string> helix_ahead(const Scene& scene, const Prepared& prepared);

// An upper estimate of limits.shock. Twist runs along a rope under a moment at its ends as a wave. A rope whose
// moment M rises slowly winds by ML/GJ, and a tube at the distance rho from the axis moves with the speed rho
// (L/GJ)(dM/dt)(s/L - 1/2), or s/L where the other end is held. The kinetic energy of this tube is m rho^2 L (L/GJ
// dM/dt)^2/24, or /6. The wave lags behind the moment and then winds the rope up to twice as fast: the estimate is
// four times this energy, of all tubes, over the energy of twist under the whole moment. 1: the moment acts at
// once. 0: not estimated. Case limit-shock compares runs with the estimate.
double expected_shock(const Scene& scene, const Prepared& prepared);

// How far a prescribed turn is from rest. Twist travels along a rope as a wave of the speed (K/J)^1/2, with the
// stiffness K against twist and the moment of inertia J per length. A clamp that begins to turn at the rate w sends
// out the torque w (K J)^1/2, which goes to and fro: the ends feel it one after the other. The mean torque is that
// of
//   M = sum(GJ) phi + sum(EA rho^4) phi^3/2
// at the twist phi per length, with the distance rho of a tube from the axis; where the length is not held, the
// square of the mean of rho^2 is taken off. The estimate is an upper one: runs show 0.3 to 0.8 of it, since
// damping, rounded corners and the faster twist of each tube about its own axis weaken the wave. A slice of an
// endless rope gets its twist at both ends, each of which turns at w/2 against the middle: the torque of the wave
// is the same. Runs of 19 tubes show 0.2 of it.
struct QuasiStatic {
  bool slice = false;
  double travel = 0;  // travel of sound from end to end of the untwisted rope, ps
  double time = 0;    // time of the turn, ps
  double drag = 0;    // of a bath at rest on the turning rope, over the mean torque: what the driven end bears more
  double error = 0;   // half the difference of the torques at both ends, over the mean torque of the turn
};
// Nothing for a scene in which no end is turned, or in which clamps do not hold both ends.
std::optional<QuasiStatic> quasi_static(const Scene& scene, const Prepared& prepared);
std::string words_of(const QuasiStatic& q);

}  // namespace ropewalk
