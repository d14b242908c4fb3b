// How long a run may take, for batch systems that end it after that.
#pragma once

#include <string>

#include "io/clocks.hpp"

namespace ropewalk {

// When this program was started, by steady_seconds().
double program_start();

// "5400" (seconds), "1:30:00" or "2-12:00:00" (days before the hyphen); empty: 0. Throws InputError.
double seconds_of_wall_time(const std::string& text);

struct WallTime {
  double allowed = 0;  // s; 0: any
  double since = steady_seconds();

  // `last_save`: what the longest checkpoint has taken, s. The run ends as long before its time as a last one may
  // take.
  bool is_up(double last_save) const;
};

// The time that a run has taken, with that before it was resumed.
struct RunClock {
  std::string begun = iso_time();
  double earlier = 0, since = steady_seconds();  // s

  double seconds() const { return earlier + steady_seconds() - since; }
  static std::string iso_time();  // now, UTC
};

}  // namespace ropewalk
