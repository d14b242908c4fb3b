#include "campaign/repeated_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "campaign/campaign.hpp"
#include "campaign/point_runs.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"
#include "plan/scene_edit.hpp"
#include "run/begin_run.hpp"
#include "run/terminal_listener.hpp"
#include "scene/input_numbers.hpp"
#include "scene/kinds/state.hpp"
#include "scene/scene_toml.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// The run that is repeated has told what there is to say of its scene.
class RepeatedRunListener : public TerminalListener {
 public:
  RepeatedRunListener() : TerminalListener(true) {}
  void tell(const std::string&) override {}
  void tell_note(const std::string&) override {}
};

bool holds(const std::string& file, const std::string& text) { return fs::exists(file) && read_file(file) == text; }

// The time at which --until or --steps let a run end; -1: it went to the end of the scene, or a rule of the scene
// ended it before.
double end_if_asked(const RunDirectory& run, const Prepared& prepared) {
  const std::vector<LogRow> log = read_log(run.log());
  if (log.empty()) return -1;
  const double end = log.back()["time_ps"], late = end - prepared.duration, step = 0.75 * prepared.time_step;
  const bool by_rule = !read_manifest(run.manifest()).reason.empty();
  return late > step || (late < -step && !by_rule) ? end : -1;
}

// Whether a run that has ended did so where it would end today.
bool ends_there(const RunDirectory& dir, const Scene& scene, const RunInputs& inputs) {
  if (scene.run.mode == RunOptions::Mode::relax) return true;
  Scene repeated = read_run_scene(dir);
  const double end = end_if_asked(dir, prepare(repeated));
  const double step = 0.75 * units::fs * read_manifest(dir.manifest()).time_step_fs;
  return inputs.until_ps < 0 || end < 0 ? (inputs.until_ps < 0) == (end < 0) : std::fabs(end - inputs.until_ps) < step;
}

bool is_of(const RunDirectory& dir, const RunInputs& inputs) {
  bool same = holds(dir.scene(), inputs.scene);
  for (std::size_t k = 0; same && k < inputs.sets.size(); ++k) same = holds(dir.parameters(k), inputs.sets[k]);
  for (std::size_t k = 0; same && k < inputs.files.size(); ++k) same = holds(dir.friction(k), inputs.files[k]);
  return same;
}

}  // namespace

RunInputs inputs_of(const RunDirectory& run, const Scene& scene, const Prepared& prepared) {
  RunInputs out{read_file(run.scene()), {}, {}};
  if (scene.run.mode != RunOptions::Mode::relax) out.until_ps = end_if_asked(run, prepared);
  for (std::size_t k = 0; k < scene.sets.size(); ++k) out.sets.push_back(read_file(run.parameters(k)));
  for (const std::string& file : input_files(scene)) out.files.push_back(read_file(file));
  return out;
}

std::string repeatable_scene(const std::string& text, const Scene& scene, const Prepared& prepared) {
  if (scene.run.mode == RunOptions::Mode::relax) return text;
  const auto with = [&](const std::string& to, const char* key, double value) {
    return with_value(to, key, fmt::format("{:.17g}", value), scene.path);
  };
  return with(with(text, "run.time_step_fs", prepared.time_step / units::fs), "run.frames_every_ps",
              prepared.duration);
}

Scene scene_of(const RunInputs& inputs, const RunDirectory& base, const Scene& scene, const std::string& folder) {
  const RunDirectory at{folder};
  write_file_atomically(at.scene(), inputs.scene);
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < inputs.sets.size(); ++k) {
    sets.push_back(at.parameters(k));
    write_file_atomically(sets.back(), inputs.sets[k]);
  }
  for (std::size_t k = 0; k < inputs.files.size(); ++k) write_file_atomically(at.friction(k), inputs.files[k]);
  Scene out = read_scene(at.scene(), sets);
  if (scene.from_file()) out.source = std::make_shared<StateSource>(base.state(), base.state_memory());
  return out;
}

int repeat_run(const RunDirectory& base, const Scene& scene, const std::string& name, const RunInputs& inputs,
               bool again) {
  using Stage = PointProgress::Stage;
  const RunDirectory dir{base.path + "/errors/" + name};
  use_threads(1);
  RepeatedRunListener listener;
  if (!again && is_of(dir, inputs)) {
    const PointProgress progress = progress_of(dir);
    if (progress.stage == Stage::ended && progress.status == "finished" && ends_there(dir, scene, inputs)) return 0;
    if (progress.stage == Stage::begun) {
      ResumeSettings settings;
      settings.until_ps = inputs.until_ps;
      return code_of(go_through(resume_run(dir, settings, listener)), true);
    }
  }
  remove_run(dir, "--again");
  fs::create_directories(base.path + "/errors");
  const TemporaryFolder folder;
  RunSettings settings;
  settings.until_ps = inputs.until_ps;
  return code_of(go_through(begin_run(scene_of(inputs, base, scene, folder.path()), dir, settings, listener)), true);
}

}  // namespace ropewalk
