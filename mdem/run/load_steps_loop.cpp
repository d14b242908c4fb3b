#include "run/load_steps_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "run/equilibrium_of.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/statics/end_words.hpp"
#include "sim/statics/load_steps.hpp"
#include "sim/statics/stability.hpp"

namespace ropewalk {

LoadStepsLoop::LoadStepsLoop(RunParts& run)
    : run_(run), times_(load_step_times(run.moving.simulation.loads(), run.moving.scene.statics.steps)) {
  const std::string path = run.files.directory().equilibria();
  if (std::filesystem::exists(path)) found_ = read_equilibria(path);
  // A run that was killed behind its last checkpoint comes to the later ones again.
  found_.erase(std::remove_if(found_.begin(), found_.end(), [&](const auto& e) { return e.step > run.step(); }),
               found_.end());
}

std::size_t LoadStepsLoop::next() const { return found_.size(); }

StopReason LoadStepsLoop::go() {
  run_.listener.begin_loop(static_cast<double>(next()), static_cast<double>(times_.size()));
  run_.checkpoints.begin_interval();
  Statics end;
  end.end = Statics::End::at_rest;
  while (stop_ == StopReason::none && next() < times_.size()) {
    // Without a copy the run would stop between two states of rest.
    const Simulation before = run_.moving.simulation;
    end = rest_at(times_[next()]);
    if (stop_ != StopReason::none) {
      run_.moving.simulation = before;
      break;
    }
    if (!end.relaxed.at_rest) break;
    write(end);
    stop_ = run_.limits.check(true);
    if (stop_ == StopReason::none) stop_ = run_.asked_to_stop();
    if (stop_ == StopReason::none) run_.checkpoints.save_if_due();
  }
  if (stop_ == StopReason::asked || stop_ == StopReason::wall_time) return run_.stop(stop_);
  run_.listener.end_loop();
  run_.at_rest = next() == times_.size();
  run_.reason = words_of_curve() + (stop_ == StopReason::none ? words_of_end(end) : std::string());
  if (stop_ == StopReason::complete) run_.reason += "; it ended by --steps";
  run_.keep_for(stop_);
  run_.moving.simulation.end_relaxation();
  run_.write_last();
  return stop_ == StopReason::limit ? stop_ : StopReason::complete;
}

Statics LoadStepsLoop::rest_at(double time) {
  const RunOptions& options = run_.moving.scene.run;
  Simulation& simulation = run_.moving.simulation;
  NewtonOptions how;
  how.fire = options.solver == RunOptions::Solver::automatic;
  how.near = !begins();
  how.most_overloaded = enough_overloaded;
  if (next() + 1 < times_.size()) how.loads_to_come = times_[next() + 1];
  NewtonStatics newton(simulation, how);
  const auto go_on = [this](long) { return goes_on(); };
  Statics out = newton.follow(time, options.goal, go_on);
  if (out.end != Statics::End::at_rest) return out;
  return newton.relax(options.goal, options.max_steps, go_on);
}

bool LoadStepsLoop::goes_on() {
  if (run_.listener.wants_progress())
    run_.listener.progress(static_cast<double>(next()), load_words(run_.moving.simulation.time()));
  const std::int64_t last = run_.schedule.last_step();
  stop_ = last >= 0 && run_.step() >= last ? StopReason::complete : run_.asked_to_stop();
  return stop_ == StopReason::none;
}

void LoadStepsLoop::write(const Statics& end) {
  Equilibrium e = equilibrium_of(end, judge_stability(run_.moving.simulation, end));
  e.step = run_.step();
  e.time = run_.moving.simulation.time();
  found_.push_back(e);
  if (run_.files.row_step() != run_.step()) run_.write_row();
  if (run_.files.frame_step() != run_.step()) run_.write_frame();
  run_.files.write_equilibria(found_);
  run_.rollback.take_snapshot();
  if (e.saddles > 0 && std::isfinite(run_.last_row["geometric_twist_deg"]))
    run_.listener.tell(fmt::format("at {} it left a saddle of the energy, and rests at a geometric twist of {:.4g}°",
                                   load_words(e.time), run_.last_row["geometric_twist_deg"]));
}

std::string LoadStepsLoop::load_words(double time) const {
  const Simulation& s = run_.moving.simulation;
  const EndDrives drives = end_drives(s.loads(), s.topology());
  if (end_moment(drives)) return fmt::format("{:.4g} nN nm", moment_at(drives, time) / units::nN_nm);
  return fmt::format("{:.4g} ps", time);
}

std::string LoadStepsLoop::words_of_end(const Statics& end) {
  if (next() == times_.size()) return "";
  const bool by_fire = run_.moving.scene.run.solver == RunOptions::Solver::automatic;
  const EndWords words = end_words(run_.moving.simulation, end, by_fire, !begins());
  if (!words.remedy.empty()) run_.remedy = words.remedy + "; equilibria.csv has the states of rest up to here";
  return fmt::format("; none was found at the next one, {}: {}", load_words(times_[next()]), words.why);
}

std::string LoadStepsLoop::words_of_curve() const {
  std::string words = fmt::format("{} of {} states of rest", next(), times_.size());
  const auto first = std::find_if(found_.begin(), found_.end(), [](const Equilibrium& e) {
    return e.stability == Equilibrium::Stability::unstable;
  });
  const auto count = [&](Equilibrium::Stability s) {
    return std::count_if(found_.begin(), found_.end(), [&](const Equilibrium& e) { return e.stability == s; });
  };
  if (first != found_.end())
    words += fmt::format(", {} of them unstable, the first at {}", count(Equilibrium::Stability::unstable),
                         load_words(first->time));
  else if (!found_.empty() && count(Equilibrium::Stability::unknown) == 0)
    words += ", all stable";
  for (const Equilibrium& e : found_)
    if (e.saddles > 0)
      words += fmt::format("; at {} it left a saddle of the energy: it winds or bends there by itself", load_words(e.time));
  if (const auto unknown = count(Equilibrium::Stability::unknown); unknown > 0)
    words += fmt::format("; the stability of {} is not known", unknown);
  return words;
}

}  // namespace ropewalk
