// The value of a key of a scene at which its state of rest ceases to be stable, or to be found, without running it: by
// bisection, with the state of rest at the largest value that is known to be stable as the start of the next one.
// Friction has no part in it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "io/outputs.hpp"

namespace ropewalk {

struct StaticThreshold {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  std::string point;
  double below = none, above = none;  // stable; unstable, or without a state of rest
  double growth = none;               // growth rate at `above`, 1/ns
  std::string motion;                 // that grows there
  std::string why;                    // there is no bracket, it is wide, or `above` has no state of rest
  int states = 0;                     // that were solved for
  double theory = none;               // in the unit of the key: no helix grows below

  bool found() const { return below < above; }
  double value() const { return 0.5 * (below + above); }
  double error() const { return 0.5 * (above - below); }
};

// Between the ends of the sweep's [threshold]. Throws InputError for a scene that statics does not take, and
// StaticsStopped.
StaticThreshold static_threshold(const Sweep& sweep, const SweepPoint& point);

// A row for each point.
std::string static_thresholds_csv(const std::vector<StaticThreshold>& all);
std::vector<OutputColumn> static_threshold_columns();

}  // namespace ropewalk
