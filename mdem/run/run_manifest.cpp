#include "run/run_manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/own_parts.hpp"
#include "scene/parts_in_use.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/device/device_stepper.hpp"
#include "sim/threads/threads.hpp"
#include "version.hpp"

namespace ropewalk {

Manifest manifest_of(const RunParts& run, const std::string& status, const std::string& reason) {
  const Scene& scene = run.moving.scene;
  Manifest m;
  m.version = version;
  m.git_id = git_id;
  m.compiler = compiler;
  m.build_type = build_type;
  m.instructions = instructions_in_use();
  if (const DeviceStepper* device = run.moving.simulation.device()) m.device = device->name();
  m.program = own_program();
  m.own_parts = own_parts_of_run(scene);
  m.own_forces = own_forces_in_words(run.settings.own_forces);
  m.threads = threads_in_use();
  m.seed = scene.start.seed;
  m.scene_hash = scene.hash;
  m.parameter_hash = scene.parameters().hash;
  m.grade = fmt::format("{}", fmt::join(grades_of(scene), "; "));
  m.started = run.clock.begun;
  m.wall_seconds = run.clock.seconds();
  m.steps = run.step();
  m.time_step_fs = run.moving.prepared.time_step / units::fs;
  m.status = status;
  m.reason = reason;
  m.scene = scene.name;
  return m;
}

}  // namespace ropewalk
