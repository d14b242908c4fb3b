#include "run/relaxation_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/error.hpp"
#include "sim/statics/end_words.hpp"
#include "sim/statics/stability.hpp"

namespace ropewalk {

StopReason RelaxationLoop::go() {
  Simulation& simulation = run_.moving.simulation;
  const RunOptions& options = run_.moving.scene.run;
  const std::int64_t last_step = run_.schedule.last_step();
  const std::int64_t began = simulation.relaxation_began(), done = run_.step() - began;
  most_ = last_step >= 0 ? std::max<long>(0, last_step - began) : options.max_steps;
  if (last_step < 0 && run_.took_all_steps && done >= most_) most_ += done;
  run_.listener.begin_loop(0, 0);
  run_.checkpoints.begin_interval();
  if (options.solver != RunOptions::Solver::fire)
    newton_.emplace(simulation, NewtonOptions{options.solver == RunOptions::Solver::automatic});
  Relaxed end = relax(most_ + 1, [this](long step) { return goes_on_after(step); });
  run_.listener.end_loop();
  // The relaxation stops midway, and `resume` goes on from there.
  if (stop_ == StopReason::asked || stop_ == StopReason::wall_time) return run_.stop(stop_);
  if (stop_ != StopReason::none) run_.keep_for(stop_);
  if (stop_ == StopReason::complete) end = relax(most_, [](long) { return true; });
  simulation.end_relaxation();
  run_.write_last();
  StopReason why = stop_ == StopReason::none ? StopReason::complete : stop_;
  if (why == StopReason::complete) {
    const StopReason found = run_.limits.check(true);
    if (found == StopReason::limit || (found == StopReason::refine && last_step < 0)) why = found;
  }
  if (stop_ == StopReason::none || (stop_ == StopReason::complete && why == StopReason::refine)) run_.keep_for(why);
  if (why != StopReason::complete) return why;
  run_.at_rest = end.at_rest;
  run_.reason = newton_ ? words_of(statics_, most_) : words_of(end, most_);
  return why;
}

Relaxed RelaxationLoop::relax(long most, const std::function<bool(long)>& progress) {
  const RelaxGoal& goal = run_.moving.scene.run.goal;
  if (!newton_) return run_.moving.simulation.relax(goal, most, progress);
  statics_ = newton_->relax(goal, most, progress);
  return statics_.relaxed;
}

bool RelaxationLoop::goes_on_after(long step) {
  if (step >= most_) {
    stop_ = StopReason::complete;
    return false;
  }
  const bool newton = newton_ && newton_->at_newton();  // a step of it takes as long as many of FIRE
  if (newton || step % 100 == 0) {
    if (run_.files.row_step() != run_.step()) run_.write_row();
    stop_ = run_.limits.check(false);
    run_.rollback.take_snapshot();
  }
  if (run_.listener.wants_progress()) run_.listener.progress(static_cast<double>(step), status());
  if (stop_ == StopReason::none) stop_ = run_.asked_to_stop();
  if (stop_ == StopReason::none && (newton || RunSchedule::has_pause(step))) run_.checkpoints.save_if_due();
  return stop_ == StopReason::none;
}

std::string RelaxationLoop::words_of(const Relaxed& end, long max_steps) const {
  const RelaxGoal& goal = run_.moving.scene.run.goal;
  const std::string left = fmt::format("{:.2g} eV above the minimum, that of the bonds within {:.2g} of its value",
                                       end.above, end.error);
  const std::string way = end.saddles > 0 ? fmt::format("; it left {} saddle{} of the energy on the way",
                                                        end.saddles, end.saddles > 1 ? "s" : "")
                                          : std::string();
  const std::string stays =
      end.falls > 0
          ? fmt::format(
                "; it rests on a saddle, and stays there: along one motion the energy falls by {:.2g} eV or more",
                end.falls)
          : std::string();
  if (end.at_rest && std::isinf(end.above))
    return fmt::format("relaxed: largest force {:.3g} eV/nm; along some soft motion the energy may still fall{}",
                       end.force, way);
  if (end.at_rest)
    return fmt::format("relaxed: largest force below {:.3g} eV/nm; energy {}, by estimate{}{}", goal.force, left,
                       way, stays);
  const std::string words = fmt::format("not relaxed after {} steps: largest force {:.3g} eV/nm, {:.3g} asked for",
                                        max_steps, end.force, goal.force);
  if (std::isinf(end.above)) return words + "; the energy may still fall along some motion: no minimum is near";
  return std::isfinite(end.above) ? words + fmt::format("; energy {}, {:.2g} asked for", left, goal.energy) : words;
}

std::string RelaxationLoop::words_of(const Statics& end, long max_steps) {
  const RunOptions& options = run_.moving.scene.run;
  const Relaxed& r = end.relaxed;
  std::string words;
  if (r.at_rest)
    words = "at rest";
  else if (end.end == Statics::End::refused)
    words = "not at rest";
  else
    words = end.newton_steps > 0 ? fmt::format("not at rest after {} steps of Newton's method", end.newton_steps)
                                 : fmt::format("not at rest after {} steps", max_steps);
  words +=
      fmt::format(": largest force {:.2g} eV/nm, largest moment {:.2g} eV", end.largest_force, end.largest_torque);
  if (std::isfinite(r.above)) words += fmt::format(", {:.2g} eV above the minimum by estimate", r.above);
  if (!r.at_rest) {
    words += fmt::format("; {:.3g} eV/nm asked for", options.goal.force);
    const EndWords more =
        end_words(run_.moving.simulation, end, options.solver == RunOptions::Solver::automatic, false);
    run_.remedy = more.remedy;
    return more.remedy.empty() ? words : words + "; " + more.why;
  }
  if (r.saddles > 0)
    words += fmt::format("; it left {} saddle{} of the energy on the way", r.saddles, r.saddles > 1 ? "s" : "");
  words += "; " + judge_stability(run_.moving.simulation, end).words();
  if (end.spinning > 10 * end.largest_torque)
    words +=
        fmt::format("; couples about their own axes spin single tubes by up to {:.2g} eV, and nothing holds them",
                    end.spinning);
  return words;
}

std::string RelaxationLoop::status() const {
  const Energies& e = run_.moving.simulation.forces().energy;
  return fmt::format("twist {:.0f}  bend {:.0f}  vdW {:.0f} eV", e.twist, e.bend, e.vdw);
}

}  // namespace ropewalk
