#include "run/begin_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "io/files.hpp"
#include "model/error.hpp"
#include "run/origin_changes.hpp"
#include "run/stages.hpp"
#include "run/use_device.hpp"
#include "sim/contact/line/engine.hpp"

namespace ropewalk {
namespace {

// A run that may be refined must find the place for it free.
void check_finer_directory(const RunDirectory& dir, const RunSettings& asked, bool resumed) {
  const RunDirectory finer = finer_directory(dir);
  if (resumed && !has_checkpoint(finer)) return;  // killed while it was made: see write_finer_scene()
  if (asked.on_limit == OnLimit::refine && !asked.force && std::filesystem::exists(finer.path))
    throw InputError({finer.path, 0, "--on-limit"}, "exists, and a refined run would go on there",
                     "take it away or choose another name for the run");
}

// A run whose elements were split goes on elsewhere.
void refuse_refined(const RunDirectory& dir) {
  const RunDirectory next = finer_directory(dir);
  if (!has_checkpoint(next)) return;
  const std::vector<RefinementRecord> splits = read_checkpoint(next).limits.refinements;
  if (splits.empty() || splits.back().from != stage_of(dir)) return;
  throw InputError({dir.path, 0, ""}, fmt::format("had its elements split at {:.4g} ps", splits.back().time_ps),
                   "go on with: ropewalk resume " + next.path);
}

// Uses the instructions that the run was begun with, so that it gives the same bits, unless others are asked for.
void use_instructions_of(const RunOrigin& origin, const std::string& asked_for, RunListener& listener) {
  const std::string& name = asked_for.empty() ? origin.instructions : asked_for;
  if (!use_instructions(name) && asked_for.empty())
    throw InputError({"", 0, "--instructions"},
                     fmt::format("the run was begun with {}, which this processor has not got", name),
                     fmt::format("go on elsewhere, or give one of {} for other last digits",
                                 fmt::join(instruction_sets(), ", ")));
  if (origin.instructions != instructions_in_use())
    listener.tell(fmt::format("note: instruction set {} -> {}: last digits differ", origin.instructions,
                              instructions_in_use()));
}

// The device that the run was begun on, unless another one is asked for. All devices give the same bits.
std::string device_of(const RunOrigin& origin, const std::string& asked_for, RunListener& listener) {
  if (asked_for.empty()) return origin.device;
  const bool now = asked_for != no_device, before = !origin.device.empty();
  if (now != before)
    listener.tell(now ? "note: it goes on with a device: last digits differ"
                      : "note: it goes on without a device: last digits differ");
  return asked_for;
}

Scene with_own(Scene scene, const RunSettings& asked) {
  if (asked.own_forces.empty()) return scene;
  for (const OwnForceOfRun& own : asked.own_forces) scene.drives.push_back(own.drive);
  scene.missing_forces.clear();
  return scene;
}

// Leaves no part of a run that has no checkpoint, as far as the disk lets it.
void give_up(const RunDirectory& dir, std::unique_ptr<Run> run, bool keep_directory) {
  try {
    empty_run_directory(dir);
  } catch (const InputError&) {
  }
  run.reset();  // and with it the lock
  std::error_code ignored;
  if (!keep_directory) std::filesystem::remove(dir.path, ignored);
}

}  // namespace

std::unique_ptr<Run> begin_run(const Scene& scene, const RunDirectory& dir, const RunSettings& asked,
                               RunListener& listener) {
  auto run = std::make_unique<Run>(dir, with_own(scene, asked), asked, listener);
  run->check_before_start();
  run->end_at(asked.steps, asked.until_ps);
  listener.before_files();
  check_finer_directory(dir, asked, false);
  const bool was_there = std::filesystem::exists(dir.path);
  run->hold(create_run_directory(dir, asked.force));
  try {
    write_file_atomically(dir.scene(), scene.text);
    copy_parameters(scene, dir);
    if (scene.from_file()) {
      const StateMemory memory = scene.source->memory();
      if (!memory.path.empty() && !memory.missing)
        write_file_atomically(dir.state_memory(), read_file(memory.path));
      write_file_atomically(dir.state(), read_file(scene.source->file()));
    }
    run->tell_notes();
    run->begin_files();
  } catch (const InputError& e) {
    give_up(dir, std::move(run), was_there);
    throw std::runtime_error(fmt::format("{}; then give the same command again: nothing was kept", e.what()));
  }
  return run;
}

std::unique_ptr<Run> resume_run(const RunDirectory& dir, const ResumeSettings& asked, RunListener& listener) {
  refuse_strange_files(dir);
  refuse_other_program(dir);
  refuse_without_checkpoint(dir);
  refuse_refined(dir);
  check_finer_directory(dir, asked, true);
  DirectoryLock lock(dir.path);
  remove_run_parts(dir);
  check_log_header(dir.log());
  ResumePoint point = find_resume_point(dir);
  const std::string own_forces = own_forces_in_words(asked.own_forces);
  refuse_other_forces(point.checkpoint.origin.own_forces, own_forces, dir.path);
  use_instructions_of(point.checkpoint.origin, asked.instructions, listener);
  const Scene scene = read_run_scene(dir);
  RunOrigin origin = origin_of(dir, scene);
  origin.instructions = point.checkpoint.origin.instructions;  // spoken of already
  origin.own_forces = own_forces;
  std::vector<std::string> notes =
      judged_changes(changes_of(point.checkpoint.origin, origin, dir), asked.accept_changes, dir);
  notes.insert(notes.end(), point.remarks.begin(), point.remarks.end());
  for (const std::string& note : notes) listener.tell("note: " + note);
  // The next one that is written must not take the place of the only good one.
  if (point.path != dir.checkpoint()) std::filesystem::remove(dir.checkpoint());
  ResumeSettings settings = asked;
  settings.device = device_of(point.checkpoint.origin, asked.device, listener);
  auto run = std::make_unique<Run>(dir, with_own(scene, asked), settings, listener);
  run->hold(std::move(lock));
  run->restore(std::move(point.checkpoint));
  run->end_at(asked.steps, asked.until_ps);
  run->check_end_lies_ahead();
  listener.before_files();
  run->write_manifest("running");
  run->write_limits();
  return run;
}

}  // namespace ropewalk
