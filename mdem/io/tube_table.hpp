// The table of `ropewalk observe --tubes`: tension, twist, curvature, slip and pressure of every tube.
#pragma once

#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "observe/loading.hpp"

namespace ropewalk {

std::vector<OutputColumn> tube_columns();
// A heading and one line for each tube.
std::string tube_table_csv(const Topology& topology, const State& state, const LoadingReference& reference);

}  // namespace ropewalk
