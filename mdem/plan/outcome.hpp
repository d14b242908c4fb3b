// The outcome of a run, and how far the outcomes of two runs differ.
//
// The outcome of a motion is the mean over the last quarter of its time, that of a relaxation its last row.
// "energy" is the potential energy since the start (eV); every other observable is a column of log.csv. The
// difference of two runs is relative to the larger of the value itself and a tenth of the largest value on the way;
// for the parts of the energy that is a tenth of the energy. It is at least one degree, 0.01 nN or 0.01 nN nm. So a
// part that hardly counts is not held to per cents.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/log.hpp"

namespace ropewalk {

struct Outcome {
  struct Value {
    double value = 0;
    double scale = 0;  // what differences are relative to; 0: nothing happens in it
  };
  std::map<std::string, Value> of;
};

// The outcome of a log with at least one row, for these observables. Throws std::invalid_argument for a name that
// is neither "energy" nor a column of the log.
Outcome outcome_of(const std::vector<LogRow>& log, const std::vector<std::string>& observables, bool relaxed);

// The observables that are compared where the user names none.
const std::vector<std::string>& usual_observables();

// |value - reference| over the scale of the reference, for observables that have a scale and are finite in both.
std::map<std::string, double> differences(const Outcome& run, const Outcome& reference);

}  // namespace ropewalk
