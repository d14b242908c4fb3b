// The pilots of a plan, side by side, each in a process of its own with one thread.
#pragma once

#include <string>
#include <vector>

#include "io/removal.hpp"
#include "plan/planner.hpp"

namespace ropewalk {

class PilotRuns {
 public:
  // `scene_path`: where the scene stands. Runs are kept in a temporary folder as long as this is there.
  PilotRuns(std::string scene_path, int jobs) : path_(std::move(scene_path)), jobs_(jobs) {}

  // Throws InputError where a signal ends it (io/stop_signals.hpp).
  std::vector<PilotEnd> operator()(const std::vector<PilotTask>& tasks);
  double seconds() const { return seconds_; }  // processor time of all so far

 private:
  int work(const std::string& run, const PilotTask& task) const;

  std::string path_;
  int jobs_;
  TemporaryFolder folder_;
  int count_ = 0;
  double seconds_ = 0;
};

// Processor time of a whole run of the model, s: that of its pilot where this was the whole scene. Otherwise the
// steps of the whole take as long as those of the pilot, but for the ratio of the two at their starts. 0: not
// known.
double seconds_of_run(const PlannedModel& model, const Plan& plan, const std::string& path);

}  // namespace ropewalk
