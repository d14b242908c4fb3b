#include "run/run_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/run_results.hpp"
#include "model/error.hpp"
#include "run/use_device.hpp"

namespace ropewalk {

RunParts::RunParts(RunDirectory dir, Scene scene, const RunSettings& asked, RunListener& follower)
    : settings(asked),
      listener(follower),
      moving(std::move(scene)),
      schedule(moving.scene, moving.prepared),
      stops(moving.scene.stops),
      files(std::move(dir), listener),
      limits(settings.on_limit, settings.may_refine, moving, schedule, files, listener),
      checkpoints(moving, files, limits, clock, listener),
      rollback(moving, files, limits, stops, checkpoints, listener) {
  use_device();
}

void RunParts::use_device() {
  if (!names_device(settings.device)) return;
  if (moving.relaxes())
    throw InputError({"", 0, "--device"}, "does not go with run.mode = \"relax\"",
                     "give --device none");
  ropewalk::use_device(moving.simulation, settings.device);
  schedule.look_rarely();
}

void RunParts::write_row() {
  const LogRow before = last_row;
  last_row = moving.row();
  stops.add(last_row);
  files.write_row(last_row, step());
  tell_first_break(before);
}

void RunParts::tell_first_break(const LogRow& before) {
  if (told_break || !(last_row["bonds_broken"] > 0)) return;
  files.write_events(moving);
  if (!files.first_break()) return;
  const TermEvent first = *files.first_break();
  const double turned = rotation_at({before, last_row}, first.time);
  listener.tell(fmt::format("the first tube broke at {:.4g} ps{}: {}; events.csv lists every break", first.time,
                            std::fabs(turned) >= 1 ? fmt::format(", {:.4g}°", turned) : "",
                            place_in_words(moving.prepared.topology, limits.held(), first.a)));
  told_break = true;
}

void RunParts::write_last() {
  if (files.row_step() != step()) write_row();
  if (files.frame_step() != step()) write_frame();
}

// That of a run which is refined is written after the first one of the finer run: killed in between, the run comes
// to the splitting again by itself.
void RunParts::keep_for(StopReason why) {
  if (why == StopReason::refine)
    checkpoints.keep_here(why);
  else
    checkpoints.save_here();
}

StopReason RunParts::stop(StopReason why) {
  keep_for(why);
  if (why == StopReason::asked || why == StopReason::wall_time) return why;
  const bool looked = files.frame_step() == step() || !reason.empty();
  if (why == StopReason::complete && !looked && limits.check(true) == StopReason::limit) why = StopReason::limit;
  write_last();
  return why;
}

StopReason RunParts::asked_to_stop() {
  asked_by = listener.asked_to_stop();
  if (!asked_by.empty()) return StopReason::asked;
  if (!settings.wall_time.is_up(checkpoints.longest_save())) return StopReason::none;
  asked_by = "by --wall-time";
  return StopReason::wall_time;
}

}  // namespace ropewalk
