// The messages of `sweep` while its points run.
#pragma once

#include <functional>

#include "campaign/sweep_runs.hpp"

namespace ropewalk {

class SweepProgress {
 public:
  // The clock starts here.
  SweepProgress(const CampaignDirectory& dir, const std::vector<SweepPoint>& points, const SweepRuns& runs,
                bool quiet);

  void start_failed(const SweepPoint& start) const;
  // Says how many points are done already.
  void begin();
  void ended(const SweepPoint& point, int status);
  void clear_line() const;

 private:
  void say(const std::string& line) const;

  const CampaignDirectory& dir_;
  const std::vector<SweepPoint>& points_;
  const SweepRuns& runs_;
  bool quiet_;
  std::size_t done_ = 0;
  double work_left_ = 0, work_to_do_ = 0, began_, next_line_ = 0;
};

// Says on stderr, also with --quiet, where the messages of a point are that did not end.
void tell_not_ended(const CampaignDirectory& dir, const std::string& point);

// Says that a signal stopped the command, which may be given again. Returns its exit code.
int tell_stop();

// `solve` looks for states of rest in this process, by so many threads, since each state takes some seconds; its
// exit code, or that of tell_stop() where a signal stopped it.
int solve_here(int threads, const std::function<int()>& solve);

}  // namespace ropewalk
