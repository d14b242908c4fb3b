// Reads atoms from LAMMPS data files, LAMMPS text dumps, XYZ and extended XYZ, frame by frame. Lengths in the files
// are Angstrom, velocities Angstrom/ps, or Angstrom/fs in a dump that says ITEM: UNITS real.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "atoms/atom_box.hpp"
#include "model/honeycomb.hpp"

namespace ropewalk {

struct AtomFrame {
  std::vector<Vector3> positions;   // nm
  std::vector<Vector3> velocities;  // nm/ps; empty: the file has none
  std::vector<char> species;        // species of each atom: 1 or 2, that of a sublattice of the tubes; 0: another
  AtomBox box;
  double time = 0;  // ps
  std::int64_t step = 0;
};

// Frames of one simulation. The atoms of every frame are in the order of the first.
class AtomSource {
 public:
  virtual ~AtomSource() = default;
  // False at the end. Throws InputError where something is wrong.
  virtual bool next(AtomFrame& frame) = 0;
  // Source of the current frame: a file, or a name for messages.
  virtual const std::string& file() const = 0;
  virtual bool cut_off() const { return false; }     // the last frame was, and is left out
  virtual bool states_time() const { return true; }  // false: times are steps times the time step that was given
};

// Frames of several files, one file after another. A data file beside dumps gives the species of their types and is
// no frame itself. Dumps are sorted by their id, XYZ files keep their order. The species is named by the
// element, or by the mass of a type; where there is one type and no mass, it is carbon. The first frame of a
// further file is left out where it has the time of the frame before it.
class AtomFiles : public AtomSource {
 public:
  // `time_step_fs`: of the steps of a dump that states no time. `honeycomb`: of the tubes.
  AtomFiles(std::vector<std::string> paths, double time_step_fs, const Honeycomb& honeycomb = {});
  ~AtomFiles() override;
  // Errors name the line of what is wrong.
  bool next(AtomFrame& frame) override;
  const std::string& file() const override;
  bool cut_off() const override;
  bool states_time() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ropewalk
