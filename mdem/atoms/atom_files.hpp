// Reads atoms from LAMMPS data files, LAMMPS text dumps, XYZ and extended XYZ, frame by frame. Lengths in the files
// are Angstrom, velocities Angstrom/ps, or Angstrom/fs in a dump that says ITEM: UNITS real.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atoms/atom_box.hpp"

namespace ropewalk {

struct AtomFrame {
  std::vector<Vector3> positions;   // nm
  std::vector<Vector3> velocities;  // nm/ps; empty: the file has none
  std::vector<char> carbon;         // of each atom
  AtomBox box;
  double time = 0;  // ps
  std::int64_t step = 0;
};

// Frames of several files, one file after another. A data file beside dumps gives the species of their types and is
// no frame itself. The atoms of every frame are in the order of the first: dumps are sorted by their id, XYZ files
// keep theirs. What carbon is, the files say: by the element, or by the mass of a type; where there is one type and
// no mass, it is carbon.
class AtomFiles {
 public:
  // `time_step_fs`: of the steps of a dump that states no time.
  AtomFiles(std::vector<std::string> paths, double time_step_fs);
  ~AtomFiles();
  // False at the end. A last frame that is cut off is left out, and told by cut_off(). Throws InputError with the
  // line of what is wrong.
  bool next(AtomFrame& frame);
  // The file of the frame just read.
  const std::string& file() const;
  bool cut_off() const;
  bool states_time() const;  // false: times are steps times the time step that was given

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ropewalk
