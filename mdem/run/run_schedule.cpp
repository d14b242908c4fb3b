#include "run/run_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr std::int64_t window_of_a_device = 2048;  // steps

std::int64_t every(double interval, double duration, int parts, double time_step) {
  const double chosen = interval > 0 ? interval : duration / parts;
  return std::max<std::int64_t>(1, std::llround(chosen / time_step));
}

}  // namespace

RunSchedule::RunSchedule(const Scene& scene, const Prepared& prepared)
    : log_interval_(scene.run.log_every),
      frames_interval_(scene.run.frames_every),
      duration_(prepared.duration),
      relaxes_(scene.run.mode == RunOptions::Mode::relax) {
  count_from(0, 0, prepared.time_step);
}

void RunSchedule::count_from(std::int64_t step, double time, double time_step) {
  counted_from_ = {step, time, time_step};
  const double span = duration_ > 0 ? duration_ : 1000 * time_step;
  log_every_ = every(log_interval_, span, 400, time_step);
  frames_every_ = every(frames_interval_, span, 40, time_step);
  expected_frames_ = static_cast<std::size_t>(span / time_step / static_cast<double>(frames_every_));
  if (!relaxes_) last_step_ = scene_end_ = step_at(duration_);
}

void RunSchedule::look_rarely() { window_ = window_of_a_device; }

// Steps are counted from zero, but where the time step was another one before.
std::int64_t RunSchedule::step_at(double ps) const {
  return counted_from_.step + std::llround((ps - counted_from_.time) / counted_from_.time_step);
}

void RunSchedule::end_at(std::int64_t steps, double ps) {
  if (ps >= 0 && relaxes_) throw InputError({"", 0, "--until"}, "a relaxation has no time", "take --steps");
  if (ps >= 0) last_step_ = step_at(ps);
  if (steps >= 0) last_step_ = steps;
}

std::int64_t RunSchedule::steps_to_next(std::int64_t step, bool closely, double seconds_of_a_step) const {
  std::int64_t count = last_step_ - step;
  if (scene_end_ > step) count = std::min(count, scene_end_ - step);
  for (const std::int64_t interval : {log_every_, frames_every_, pause_every, window(closely)})
    count = std::min(count, interval - step % interval);
  return std::min(count, std::max<std::int64_t>(2, static_cast<std::int64_t>(patience / seconds_of_a_step)));
}

}  // namespace ropewalk
