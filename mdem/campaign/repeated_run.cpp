#include "campaign/repeated_run.hpp"

#include <fmt/format.h>

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

bool is_of(const RunDirectory& dir, const RunInputs& inputs) {
  bool same = holds(dir.scene(), inputs.scene);
  for (std::size_t k = 0; same && k < inputs.sets.size(); ++k) same = holds(dir.parameters(k), inputs.sets[k]);
  for (std::size_t k = 0; same && k < inputs.files.size(); ++k) same = holds(dir.friction(k), inputs.files[k]);
  return same;
}

}  // namespace

RunInputs inputs_of(const RunDirectory& run, const Scene& scene) {
  RunInputs out{read_file(run.scene()), {}, {}};
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
    if (progress.stage == Stage::ended && progress.status == "finished") return 0;
    if (progress.stage == Stage::begun) return code_of(go_through(resume_run(dir, {}, listener)), true);
  }
  remove_run(dir, "--again");
  fs::create_directories(base.path + "/errors");
  const TemporaryFolder folder;
  return code_of(go_through(begin_run(scene_of(inputs, base, scene, folder.path()), dir, {}, listener)), true);
}

}  // namespace ropewalk
