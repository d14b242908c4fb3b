// The runs of a sweep, side by side, each in a process of its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "campaign/campaign.hpp"
#include "run/limit_watch.hpp"

namespace ropewalk {

// The points with these names, or numbers from 1; all where none is named. Throws InputError.
std::vector<SweepPoint> chosen_points(const std::vector<SweepPoint>& points, const std::vector<std::string>& only);

class SweepRuns {
 public:
  // again: failed points as well.
  SweepRuns(const Sweep& sweep, const CampaignDirectory& dir, const std::vector<SweepPoint>& points,
            OnLimit on_limit, int jobs, bool again)
      : sweep_(sweep), dir_(dir), points_(points), on_limit_(on_limit), jobs_(jobs), again_(again) {}

  // Waiting, begun, or to be run again.
  bool is_to_run(const SweepPoint& point) const;
  // The runs that points share. `failed` hears of those that did not reach their end.
  void run_starts(const std::function<void(const SweepPoint& start)>& failed) const;
  // `ended` hears of each point with the status of its process (io/processes.hpp). Ends early by
  // io/stop_signals.hpp.
  void run_points(const std::function<void(const SweepPoint& point, int status)>& ended) const;

 private:
  void branch_off(const SweepPoint& point) const;
  int run_point(const SweepPoint& point) const;

  const Sweep& sweep_;
  const CampaignDirectory& dir_;
  const std::vector<SweepPoint>& points_;
  OnLimit on_limit_;
  int jobs_;
  bool again_;
};

// Processor time of each point, s, by timing a few of them; NaN where none can be timed. `untimed` hears why.
std::vector<double> seconds_of_points(
    const Sweep& sweep, const std::vector<SweepPoint>& points,
    const std::function<void(const SweepPoint& point, const std::exception& failure)>& untimed);

}  // namespace ropewalk
