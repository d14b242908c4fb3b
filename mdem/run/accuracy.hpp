// How far a run is off: its end against that of a finer run of the same scene, or its state gone on with for a
// stretch by its own model and a finer one.
#pragma once

#include <map>
#include <string>

#include "run/run_directory.hpp"

namespace ropewalk {

struct Accuracy {
  struct Value {
    double here = 0, finer = 0;
    double error = 0;  // relative, as plan/outcome.hpp has it
  };
  std::string against;                 // finer model, in words
  std::map<std::string, Value> found;  // error of each observable
};

// Compares the logs of two runs. Throws InputError for a run without rows.
Accuracy accuracy_against(const RunDirectory& dir, const RunDirectory& finer);
// `stretch`: ps.
Accuracy accuracy_by_stretch(const RunDirectory& dir, double stretch);

}  // namespace ropewalk
