// A run stepped again to the moment at which it passed a limit, since frames lie apart.
#pragma once

#include <optional>
#include <string>

#include "exchange/atoms_of_state.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

// How long that takes (s), by the time that the run took; empty: `why` says why it cannot be done.
std::optional<double> seconds_to_step_again(const RunDirectory& dir, const LimitPlace& place, std::string& why);

// The state at that moment. A run has the same bits whenever it is made by one program, and whether it was is seen:
// the limit must be passed at the same step and place. Empty: it is not, or the listener asked for an end, as `why`
// says. The run is made in a temporary folder; the listener hears of its progress alone.
std::optional<AtomicState> state_at_limit(const RunDirectory& dir, const LimitPlace& place, RunListener& listener,
                                          std::string& why);

}  // namespace ropewalk
