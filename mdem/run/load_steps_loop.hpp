// The loop of a run that goes through the schedules of its loads from one state of rest to the next.
//
// A row of the log, a frame, a row of equilibria.csv and a checkpoint belong to each state of rest. A run that is
// stopped between two of them goes on from the last one, to the same bytes.
#pragma once

#include <string>
#include <vector>

#include "io/equilibria.hpp"
#include "run/run_parts.hpp"
#include "sim/statics/newton.hpp"

namespace ropewalk {

class LoadStepsLoop {
 public:
  explicit LoadStepsLoop(RunParts& run);

  StopReason go();

 private:
  bool begins() const { return found_.empty(); }
  std::size_t next() const;  // index of the next time
  Statics rest_at(double time);
  bool goes_on();
  void write(const Statics& end);
  std::string words_of_end(const Statics& end);
  std::string words_of_curve() const;
  std::string load_words(double time) const;

  RunParts& run_;
  std::vector<double> times_;  // ps
  Equilibria found_;
  StopReason stop_ = StopReason::none;
};

}  // namespace ropewalk
