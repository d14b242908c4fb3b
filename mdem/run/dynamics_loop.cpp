#include "run/dynamics_loop.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/error.hpp"

namespace ropewalk {

StopReason DynamicsLoop::go() {
  const std::int64_t last_step = run_.schedule.last_step();
  run_.listener.begin_loop(static_cast<double>(run_.step()), static_cast<double>(last_step));
  run_.checkpoints.begin_interval();
  if (run_.at_once != StopReason::none) return run_.at_once;
  if (!run_.checkpoints.mark()) run_.way_back.set_mark();
  StopReason end = StopReason::none;
  while (end == StopReason::none && run_.step() < last_step) {
    const Turn turn = next_turn();
    if (advance(turn))
      end = end_of(turn);
    else
      stop_ = StopReason::none;
  }
  if (end == StopReason::none) end = StopReason::complete;
  if (end == StopReason::complete) run_.listener.end_loop();
  return end;
}

DynamicsLoop::Turn DynamicsLoop::next_turn() const {
  const RunSchedule& s = run_.schedule;
  Turn t;
  t.count = stop_ == StopReason::none ? s.steps_to_next(run_.step(), seconds_of_a_step_) : 1;
  t.step = run_.step() + t.count;
  t.last = t.step == s.last_step();
  t.logged = s.has_row(t.step) || t.last || stop_ != StopReason::none;
  t.marked = s.has_mark(t.step);
  t.framed = s.has_frame(t.step) || t.last;
  t.checked = t.logged || s.has_check(t.step);
  return t;
}

bool DynamicsLoop::advance(const Turn& t) {
  const double began = steady_seconds();
  try {
    run_.moving.simulation.steps(t.count, t.logged || t.marked);
  } catch (const NumericalError& e) {
    if (e.shorter_steps() == NumericalError::ShorterSteps::cannot_help || !run_.way_back.go_back(e.what())) throw;
    return false;
  }
  if ((t.marked || t.last) && !run_.way_back.is_sound() &&
      run_.way_back.go_back("the account of energy did not close"))
    return false;
  seconds_of_a_step_ = std::max((steady_seconds() - began) / static_cast<double>(t.count), 1e-9);
  return true;
}

StopReason DynamicsLoop::end_of(const Turn& t) {
  if (stop_ == StopReason::none && t.checked) stop_ = run_.limits.check(t.framed);
  if (t.last && stop_ == StopReason::refine) stop_ = StopReason::none;
  const bool ends = t.logged && stop_ != StopReason::none;
  if (t.logged) run_.write_row();
  if (t.logged && !t.last && stop_ == StopReason::none && is_decided()) {
    run_.write_frame();
    return StopReason::complete;
  }
  if (t.framed || ends) run_.write_frame();
  if (ends) return stop_;
  if (const StopReason asked = run_.asked_to_stop(); asked != StopReason::none) return asked;
  if (run_.listener.wants_progress()) run_.listener.progress(static_cast<double>(t.step), status());
  if (t.marked) {
    run_.moving.control.lengthen(run_.moving.simulation);
    run_.way_back.set_mark();
  }
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
  if (const MomentRamp* ramp = run_.moving.scene.moment_ramp())
    text += fmt::format("  moment {:5.1f} nN nm", ramp->upper_moment_at(time) / units::nN_nm);
  return text + fmt::format("  beta {:5.1f} deg  Q {}  twist {:.0f}  bend {:.0f}  vdW {:.0f} eV", row["beta_deg"],
                            row["Q"], row["twist_eV"], row["bend_eV"], row["vdw_eV"]);
}

}  // namespace ropewalk
