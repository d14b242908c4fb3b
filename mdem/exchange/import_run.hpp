// Runs come back from LAMMPS.
#pragma once

#include <string>

#include "run/run_directory.hpp"
#include "run/run_listener.hpp"

namespace ropewalk {

struct ImportedRun {
  long states = 0;  // taken over
  std::int64_t step = 0;
  double time = 0;      // ps
  std::string passed;   // limits, in words; empty: none
  bool at_rest = true;  // a relaxation: as the scene asks
};

// Adds what LAMMPS has left in an exported directory to the files of the run. Throws InputError where that does not
// belong to the run, or is nothing; the run then stands where it stood. `accept_changes`: of files of the export.
ImportedRun import_run(const RunDirectory& dir, bool accept_changes, RunListener& listener);

}  // namespace ropewalk
