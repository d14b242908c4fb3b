// events.csv: what force terms did in the course of a run (ForceTerm::events), in the order of time.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

std::vector<OutputColumn> event_columns();
std::string events_csv(const Topology& topology, const std::vector<TermEvent>& events);

}  // namespace ropewalk
