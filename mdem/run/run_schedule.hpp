// When a run writes and checks, and where it ends, in time steps.
#pragma once

#include <algorithm>
#include <cstdint>

#include "sim/dynamics/step_control.hpp"
#include "scene/prepare.hpp"

namespace ropewalk {

class RunSchedule {
 public:
  RunSchedule(const Scene& scene, const Prepared& prepared);

  // The end at a step or a time (ps); negative: not asked for. Throws InputError for the time of a relaxation.
  void end_at(std::int64_t steps, double ps);
  // From this step and time (ps) on steps are of this length (ps). The end is the scene's.
  void count_from(std::int64_t step, double time, double time_step);

  std::int64_t last_step() const { return last_step_; }  // -1: of a relaxation, which ends by itself
  // The last step of the scene. A run that --steps or --until ends at another step stops on the way.
  std::int64_t scene_end() const { return scene_end_; }
  bool ends_with_the_scene() const { return last_step_ == scene_end_; }
  std::size_t expected_frames() const { return expected_frames_; }  // frames of the whole scene
  bool has_row(std::int64_t step) const { return step % log_every_ == 0; }
  bool has_frame(std::int64_t step) const { return step % frames_every_ == 0; }
  // `closely`: see StepControl.
  bool has_check(std::int64_t step, bool closely) const {
    return step % std::min<std::int64_t>(log_every_, window(closely)) == 0;
  }
  // Whether a good state is kept at this step, to which the run can roll back.
  bool has_mark(std::int64_t step, bool closely) const { return step % window(closely) == 0; }
  // Where a device moves the elements, a look at their state costs, by estimate, as much as
  // hundreds of steps.
  void look_rarely();
  bool looks_rarely() const { return window_ > StepControl::window; }
  static bool has_pause(std::int64_t step) { return step % pause_every == 0; }  // for a checkpoint, if one is due
  // Steps until something is written or checked, or a request to stop has waited for `patience`.
  std::int64_t steps_to_next(std::int64_t step, bool closely, double seconds_of_a_step) const;

  static constexpr double patience = 0.5;  // how long a request to stop a run waits, s

 private:
  static constexpr std::int64_t pause_every = 16;

  std::int64_t step_at(double ps) const;
  std::int64_t window(bool closely) const { return closely ? StepControl::window : window_; }  // between two marks

  double log_interval_, frames_interval_, duration_;  // ps
  bool relaxes_;
  struct {
    std::int64_t step = 0;
    double time = 0, time_step = 0;
  } counted_from_;
  std::int64_t log_every_ = 1, frames_every_ = 1, window_ = StepControl::window;
  std::int64_t last_step_ = -1, scene_end_ = -1;
  std::size_t expected_frames_ = 0;
};

}  // namespace ropewalk
