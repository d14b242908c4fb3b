// Frames for other programs. The LAMMPS text dump opens in OVITO (particles as capsules or cylinders along
// their local z), LAMMPS (read_dump, rerun), MDAnalysis and ASE, and is what `ropewalk observe` and `report` read
// back; VTP/PVD opens in ParaView.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/outputs.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// Per-element values to colour by.
struct ElementColours {
  std::vector<double> bond_energy;     // eV: half of each adjoining bond
  std::vector<double> vdw_energy;      // eV: half of each pair
  std::vector<double> bending_moment;  // eV: EI times curvature
  std::vector<double> twist_angle;     // rad: mean of the adjoining bonds
};

// One frame as text of the dump format, with the columns of frame_columns(); columns of colours that are not given
// are left out. TIMESTEP is the step; c_time_ps has the time. The shape is not called shapex, shapey, shapez,
// since OVITO takes these for diameters.
std::string dump_frame(const Topology& topology, const State& state, const ElementColours& colours);

struct DumpFrame {
  State state;             // velocities are not in the file: zero
  ElementColours colours;  // empty where the file has no such column
};

// Reads the frames one after another. Throws InputError with the number of the wrong line. A last frame that is
// incomplete, as after a kill, is left out.
class DumpReader {
 public:
  explicit DumpReader(const std::string& path);
  ~DumpReader();
  DumpReader(const DumpReader&) = delete;
  DumpReader& operator=(const DumpReader&) = delete;
  bool next(const Topology& topology, DumpFrame& frame);  // false at the end of the file
  std::uint64_t position() const;                         // bytes, behind the frame just read

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// One VTP file with a polyline per tube and the point data of vtp_arrays(), without colours that are not given.
std::string vtp_frame(const Topology& topology, const State& state, const ElementColours& colours);

// The list of VTP files that ParaView opens as one animation.
struct PvdEntry {
  double time;       // ps
  std::string file;  // relative to the .pvd
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

std::vector<OutputColumn> frame_columns();
std::vector<OutputColumn> vtp_arrays();

}  // namespace ropewalk
