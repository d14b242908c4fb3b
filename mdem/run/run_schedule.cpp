#include "run/run_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr long window_of_a_device = 2048;  // steps

long every(double interval, double duration, long parts, double time_step) {
  const double chosen = interval > 0 ? interval : duration / static_cast<double>(parts);
  return std::max(1L, std::lround(chosen / time_step));
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
  return counted_from_.step + std::lround((ps - counted_from_.time) / counted_from_.time_step);
}

void RunSchedule::end_at(long steps, double ps) {
  if (ps >= 0 && relaxes_) throw InputError({"", 0, "--until"}, "a relaxation has no time", "take --steps");
  if (ps >= 0) last_step_ = step_at(ps);
  if (steps >= 0) last_step_ = steps;
}

long RunSchedule::steps_to_next(std::int64_t step, bool closely, double seconds_of_a_step) const {
  long count = last_step_ - step;
  if (scene_end_ > step) count = std::min<long>(count, scene_end_ - step);
  for (const long interval : {log_every_, frames_every_, pause_every, static_cast<long>(window(closely))})
    count = std::min<long>(count, interval - step % interval);
  return std::min(count, std::max(2L, static_cast<long>(patience / seconds_of_a_step)));
}

}  // namespace ropewalk
