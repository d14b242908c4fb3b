// Frames as a LAMMPS text dump, which opens in OVITO (particles as capsules or cylinders along their local z),
// LAMMPS (read_dump, rerun), MDAnalysis and ASE.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/frames/frames.hpp"

namespace ropewalk {

// One frame, with the columns of frame_columns(); columns of colours that are not given are left out. TIMESTEP is
// the step; c_time_ps has the time. The shape is not called shapex, shapey, shapez, since OVITO takes these for
// diameters.
std::string dump_frame(const Topology& topology, const State& state, const ElementColours& colours);

// Throws InputError with the number of the wrong line.
class DumpReader : public FrameReader {
 public:
  explicit DumpReader(const std::string& path);
  ~DumpReader() override;
  bool next(const Topology& topology, StoredFrame& frame) override;
  std::size_t count(const Topology& topology) override;
  void seek(std::size_t frame) override;
  std::uint64_t position() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::vector<OutputColumn> frame_columns();

}  // namespace ropewalk
