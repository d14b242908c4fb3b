// Frames for ParaView: VTP files and the PVD file that lists them.
#pragma once

#include <string>
#include <vector>

#include "io/frames/colours.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// One VTP file with a polyline per tube and the point data of vtp_arrays(), without colours that are not given.
std::string vtp_frame(const Topology& topology, const State& state, const ElementColours& colours);

// The list of VTP files that ParaView opens as one animation.
struct PvdEntry {
  double time;       // ps
  std::string file;  // relative to the .pvd
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

std::vector<OutputColumn> vtp_arrays();

}  // namespace ropewalk
