#include "run/dynamics_loop.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {

StopReason DynamicsLoop::go() {
  const std::int64_t last_step = run_.schedule.last_step();
  run_.listener.begin_loop(static_cast<double>(run_.step()), static_cast<double>(last_step));
  run_.checkpoints.begin_interval();
  StopReason end = run_.at_once;
  if (end == StopReason::none && !run_.checkpoints.snapshot()) run_.rollback.take_snapshot();
  while (end == StopReason::none && run_.step() < last_step) {
    const Stretch stretch = next_stretch();
    if (advance(stretch)) end = end_of(stretch);
  }
  if (end == StopReason::none) end = StopReason::complete;
  if (end == StopReason::complete) run_.listener.end_loop();
  return run_.stop(end);
}

DynamicsLoop::Stretch DynamicsLoop::next_stretch() const {
  const RunSchedule& s = run_.schedule;
  Stretch t;
  t.closely = !s.looks_rarely() || run_.moving.looks_closely();
  t.count = s.steps_to_next(run_.step(), t.closely, seconds_of_a_step_);
  t.step = run_.step() + t.count;
  t.last = t.step == s.scene_end();
  t.logged = s.has_row(t.step) || t.last;
  t.marked = s.has_mark(t.step, t.closely);
  t.framed = s.has_frame(t.step) || t.last;
  t.checked = t.logged || s.has_check(t.step, t.closely);
  return t;
}

bool DynamicsLoop::advance(const Stretch& t) {
  const double began = steady_seconds();
  try {
    run_.moving.simulation.steps(t.count, t.logged || t.marked || t.step == run_.schedule.last_step());
  } catch (const NumericalError& e) {
    if (e.shorter_steps() == NumericalError::ShorterSteps::cannot_help ||
        !run_.rollback.roll_back(run_.limits.words_of(e), t.closely))
      throw;
    return false;
  }
  if ((t.marked || t.last) && !run_.rollback.is_sound() &&
      run_.rollback.roll_back("the energy balance did not close", t.closely))
    return false;
  seconds_of_a_step_ = std::max((steady_seconds() - began) / static_cast<double>(t.count), 1e-9);
  return true;
}

StopReason DynamicsLoop::end_of(const Stretch& t) {
  const bool ends = t.last && run_.schedule.ends_with_the_scene();
  StopReason stop = t.checked ? run_.limits.check(t.framed) : StopReason::none;
  if (ends && stop == StopReason::refine) stop = StopReason::none;
  if (t.logged) run_.write_row();
  if (t.framed) run_.write_frame();
  if (stop == StopReason::refine) return stop;  // without a mark: a resumed run has to come to it again
  if (t.marked) {
    run_.moving.lengthen_steps();
    run_.rollback.take_snapshot();
  }
  if (stop == StopReason::none && t.logged && !ends && is_decided()) stop = StopReason::complete;
  if (stop == StopReason::none) stop = run_.asked_to_stop();
  if (stop != StopReason::none) return stop;
  if (run_.listener.wants_progress()) run_.listener.progress(static_cast<double>(t.step), status());
  if (RunSchedule::has_pause(t.step)) run_.checkpoints.save_if_due();
  return StopReason::none;
}

bool DynamicsLoop::is_decided() {
  if (run_.stops.empty()) return false;
  run_.reason = run_.stops.decided(run_.limits.records());
  return !run_.reason.empty();
}

std::string DynamicsLoop::status() const {
  const double time = run_.moving.simulation.time();
  const LogRow& row = run_.last_row;
  std::string text = fmt::format("{:8.2f} ps", time);
  const Simulation& moving = run_.moving.simulation;
  if (const EndDrives drives = end_drives(moving.loads(), moving.topology()); end_moment(drives))
    text += fmt::format("  moment {:5.1f} nN nm", moment_at(drives, time) / units::nN_nm);
  return text + fmt::format("  beta {:5.1f} deg  Q {}  twist {:.0f}  bend {:.0f}  vdW {:.0f} eV", row["beta_deg"],
                            row["Q"], row["twist_eV"], row["bend_eV"], row["vdw_eV"]);
}

}  // namespace ropewalk
