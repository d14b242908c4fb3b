// Frames for other programs. The LAMMPS text dump opens in OVITO (particles as capsules or cylinders along
// their local z) and is what `ropewalk observe` and `report` read back; VTP/PVD opens in ParaView.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Per-element values to colour by.
struct ElementColours {
  std::vector<double> bond_energy;     // eV: half of each adjoining bond
  std::vector<double> vdw_energy;      // eV: half of each pair
  std::vector<double> bending_moment;  // eV: EI times curvature
  std::vector<double> twist_angle;     // rad: mean of the adjoining bonds
};

// One frame as text of the dump format: columns
//   id mol type x y z c_orient[1..4] c_shape[1..3] then the colours that are given.
// orientation x,y,z,w; shape radius, radius, length; nm; id and mol from 1; TIMESTEP is the step, ITEM: TIME the
// time in ps. Not shapex, shapey, shapez, which OVITO takes for diameters.
std::string dump_frame(const Topology& topology, const State& state, const ElementColours& colours);

struct DumpFrame {
  State state;             // velocities are not in the file: zero
  ElementColours colours;  // those that are in the file
};

// Reads the frames back one after another. Throws InputError with the line of what is wrong; a frame that the
// end of the file cuts off, as after a kill, is left out.
class DumpReader {
 public:
  explicit DumpReader(const std::string& path);
  ~DumpReader();
  DumpReader(const DumpReader&) = delete;
  DumpReader& operator=(const DumpReader&) = delete;
  bool next(const Topology& topology, DumpFrame& frame);  // false at the end of the file

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// One VTP file with a polyline per tube, point data `director` (body x axis), `axis` and the colours.
std::string vtp_frame(const Topology& topology, const State& state, const ElementColours& colours);

// The list of VTP files that ParaView opens as one animation.
struct PvdEntry {
  double time;       // ps
  std::string file;  // relative to the .pvd
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace ropewalk
