// A run before its loop: checks, first files, and what a checkpoint brings back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/error.hpp"
#include "plan/forecast.hpp"
#include "run/events_file.hpp"
#include "run/run.hpp"
#include "scene/state_files.hpp"

namespace ropewalk {

void Run::check_before_start() const {
  refuse_cooling(parts_.moving.scene, parts_.moving.prepared);
  const MovingScene& m = parts_.moving;
  if (m.scene.statics.steps > 0 && parts_.settings.on_limit == OnLimit::refine)
    throw InputError({"", 0, "--on-limit"}, "refine does not go with load steps, which stay with their elements",
                     "give --on-limit warn or stop, or take shorter elements");
  if (!m.scene.stops.empty())
    refuse_stops_without_value(m.scene, log_row(m.observer, m.scene, m.prepared.topology, m.state(), m.account()));
  parts_.limits.check_before_start();
}

void Run::check_end_lies_ahead() const {
  const State& at = parts_.state();
  const RunSettings& asked = parts_.settings;
  const std::int64_t last_step = parts_.schedule.last_step();
  if ((asked.steps < 0 && asked.until_ps < 0) || last_step > at.step) return;
  // The run was killed at its end: only the manifest has to say so.
  const std::string manifest = parts_.files.directory().manifest();
  if (last_step == at.step && (!std::filesystem::exists(manifest) || read_manifest(manifest).status == "running"))
    return;
  throw InputError(
      {"", 0, asked.steps < 0 ? "--until" : "--steps"},
      fmt::format("ends at step {}, and the run stands at step {}, {:.4g} ps", last_step, at.step, at.time),
      "choose a later end, or run the scene anew");
}

void Run::tell_notes() const {
  const Scene& scene = parts_.moving.scene;
  const Prepared& prepared = parts_.moving.prepared;
  for (const std::string& grade : grades_of(scene)) parts_.listener.tell_detail("parameters " + grade);
  for (const auto& notes : {forgotten(scene.memory, prepared.interaction), warnings_of(scene, prepared),
                            warmth_of(scene, prepared), limits_ahead(scene, prepared)})
    for (const std::string& note : notes) parts_.listener.tell_note(note);
  if (std::any_of(scene.expected.begin(), scene.expected.end(), [](const auto& e) { return e.of_other_scene; }))
    parts_.listener.tell_note("the scene was changed, and what it expects by [[expect]] is not judged");
}

// The device that moves the elements, for the manifest and for `resume`; empty: there is none.
std::string Run::device_name() const { return parts_.moving.simulation.device() ? parts_.settings.device : ""; }

void Run::begin_files() {
  RunParts& p = parts_;
  const Scene& scene = p.moving.scene;
  p.checkpoints.origin = origin_of(p.files.directory(), scene);
  p.checkpoints.origin.device = device_name();
  p.checkpoints.origin.own_forces = own_forces_in_words(p.settings.own_forces);
  write_manifest("running");  // before the checkpoint: it has the name of the scene
  p.files.open(scene.run.frames_format, {}, p.schedule.expected_frames());
  p.files.write_header();
  p.write_row();
  p.write_frame();
  if (!p.moving.relaxes() && p.state().step < p.schedule.scene_end() &&
      std::isfinite(p.moving.simulation.total_energy()))
    p.at_once = p.limits.check(true);
  p.checkpoints.save(p.at_once);
}

void Run::restore(RunCheckpoint c) {
  RunParts& p = parts_;
  const RunDirectory& dir = p.files.directory();
  try {
    p.moving.simulation.restore(c.simulation);
  } catch (const std::runtime_error& e) {
    throw InputError({dir.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  keep_time_step();
  p.moving.first_energy = c.first_energy;
  p.moving.control = c.control;
  p.clock.earlier = c.wall_seconds;
  p.checkpoints.origin = origin_of(dir, p.moving.scene);
  p.checkpoints.origin.device = device_name();
  p.checkpoints.origin.own_forces = own_forces_in_words(p.settings.own_forces);
  p.files.open(p.moving.scene.run.frames_format, c.files, p.schedule.expected_frames());
  p.limits.inherit(c.limits, p.state().step);
  const std::vector<TubeBreak> breaks = tube_breaks(dir.events());
  p.told_break = std::any_of(breaks.begin(), breaks.end(), [](const TubeBreak& b) { return b.time_ps > 0; });
  if (!p.stops.empty())
    for (const LogRow& earlier : read_log(dir.log())) p.stops.add(earlier);
  // A run that a rule has ended stands at its last row, and is not taken further.
  if (p.stops.last_step() == p.state().step && p.state().step > 0)
    if (p.reason = p.stops.decided(p.limits.records()); !p.reason.empty()) p.at_once = StopReason::complete;
  const bool as_before = c.on_limit == p.limits.on_limit();
  if (as_before && c.ends_for != StopReason::none) p.at_once = c.ends_for;
  if (p.at_once == StopReason::none && !as_before && p.limits.would_refine() &&
      std::isfinite(p.moving.simulation.total_energy()))
    p.at_once = p.limits.check(true);
  p.took_all_steps = std::filesystem::exists(dir.manifest()) && read_manifest(dir.manifest()).status != "running";
  p.checkpoints.stands_at_checkpoint();
  if (c.snapshot)
    p.checkpoints.set_snapshot(c.snapshot);
  else
    p.rollback.take_snapshot();
  // Files of the earlier end; the next end writes them again.
  std::error_code ignored;
  for (const std::string& path : {dir.final_state(), dir.final_memory()}) std::filesystem::remove(path, ignored);
}

// The checkpoint may be of a scene with another time step, which then stays.
void Run::keep_time_step() {
  MovingScene& m = parts_.moving;
  const double kept = m.simulation.time_step();
  if (kept == m.prepared.time_step) return;
  const double limit = m.prepared.limit.limit;
  if (kept >= limit)
    throw InputError({parts_.files.directory().checkpoint(), 0, ""},
                     fmt::format("has a time step of {:.4g} fs, and the changed scene bears less than {:.4g} fs",
                                 kept / units::fs, limit / units::fs),
                     "start the run anew with `ropewalk run`");
  parts_.listener.tell(fmt::format("note: the time step stays {:.4g} fs", kept / units::fs));
  m.prepared.time_step = kept;
  parts_.schedule.count_from(m.state().step, m.state().time, kept);
}

}  // namespace ropewalk
