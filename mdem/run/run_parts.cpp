#include "run/run_parts.hpp"

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
      limits(settings.on_limit, moving, schedule, files, listener),
      checkpoints(moving, files, limits, clock, listener),
      way_back(moving, files, limits, stops, checkpoints, listener) {
  use_device();
}

void RunParts::use_device() {
  if (!names_device(settings.device)) return;
  if (moving.relaxes())
    throw InputError({"", 0, "--device"}, "does not go with a relaxation, which this processor does",
                     "give --device none");
  ropewalk::use_device(moving.simulation, settings.device);
  schedule.look_rarely();
}

void RunParts::write_row() {
  last_row = moving.row();
  stops.add(last_row);
  files.write_row(last_row);
}

StopReason RunParts::asked_to_stop() {
  asked_by = listener.asked_to_stop();
  if (!asked_by.empty()) return StopReason::asked;
  if (!settings.wall_time.is_up(checkpoints.longest_save())) return StopReason::none;
  asked_by = "by --wall-time";
  return StopReason::wall_time;
}

}  // namespace ropewalk
