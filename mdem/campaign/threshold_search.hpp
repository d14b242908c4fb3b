// The search for critical values at the points of a sweep, side by side, each in a process of its own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "campaign/threshold.hpp"

namespace ropewalk {

class ThresholdSearch {
 public:
  // Reads the scenes at both ends of the range. Throws InputError for a key or value that is wrong. `only`: numbers
  // from 1 or names of the points that go() searches; empty: all.
  ThresholdSearch(Sweep sweep, CampaignDirectory dir, const std::vector<std::string>& only = {});

  // Makes the directory. Throws InputError where it holds runs or trials of other scenes, unless `force` is set.
  void begin(bool force);
  // Takes trials of an earlier search (trials.csv). Returns how many of the file are of other scenes, and all.
  std::pair<std::size_t, std::size_t> take(const std::string& trials);

  // `ended` hears of each point, and whether its search came to its end. Tables and page are written again
  // from time to time, and at the end. Ends early by io/stop_signals.hpp.
  void go(int jobs, const std::function<void(const SweepPoint& point, bool well)>& ended);

  // Tables and page of what is known.
  void write(bool with_pictures = true) const;

  std::size_t size() const { return chosen_.size(); }
  const std::vector<SweepPoint>& points() const { return points_; }
  std::vector<PhasePoint> results() const { return phase_points(dir_, sweep_, points_, known_); }
  // The verdict on a point, in words.
  std::string words_of(const SweepPoint& point) const;

 private:
  Scene scene_at(const SweepPoint& point, double value) const;
  void refuse_other_scenes(bool force) const;
  int try_at(const SweepPoint& point, double value) const;
  int walk_from(double value, const SweepPoint& point) const;
  int bisect(const SweepPoint& point) const;
  void write_line_of(const SweepPoint& point) const;
  std::vector<StatePicture> states() const;

  Sweep sweep_;
  CampaignDirectory dir_;
  std::vector<SweepPoint> points_, chosen_;
  KnownTrials known_;
  DirectoryLock lock_;
};

}  // namespace ropewalk
