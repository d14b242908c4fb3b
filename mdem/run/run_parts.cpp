#include "run/run_parts.hpp"

#include <exception>

#include "model/error.hpp"

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
  const std::string& name = settings.device;
  if (name.empty() || name == no_device) return;
  if (moving.relaxes())
    throw InputError({"", 0, "--device"}, "does not go with a relaxation, which this processor does",
                     "give --device none");
  try {
    moving.simulation.use_device(name);
    schedule.look_rarely();
  } catch (const std::exception& e) {  // no such device, not for this scene, or it fails at once
    throw InputError({"", 0, "--device"}, e.what(), "give --device none for a run on this processor");
  }
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
