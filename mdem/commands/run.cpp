// `run` and `resume`.
#include "commands/cluster_scripts.hpp"
#include "commands/commands.hpp"
#include "run/begin_run.hpp"
#include "run/limit_watch.hpp"
#include "run/terminal_listener.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

template <class Settings, class Arguments>
Settings settings_of(const Arguments& a) {
  Settings s;
  s.steps = a.steps;
  s.until_ps = a.until_ps;
  s.on_limit = on_limit_of(a.on_limit);
  s.device = a.device;
  s.wall_time = {seconds_of_wall_time(a.wall_time), program_start()};
  return s;
}

constexpr int beyond_a_limit = 7;

// The exit code of a run that is done. A script learns from 7 that the results should not be used.
int code_of(const RunResult& r) {
  const int code = tell_end(r);
  return code == 0 && r.beyond > far_beyond ? beyond_a_limit : code;
}

}  // namespace

int run_command(const RunArguments& a) {
  if (!a.slurm.empty()) return write_run_script(a);
  use_threads(a.threads);
  use_instructions(a.instructions);
  const Scene scene = read_scene(a.scene);
  auto settings = settings_of<RunSettings>(a);
  settings.force = a.force;
  TerminalListener terminal(a.quiet);
  return code_of(go_through(begin_run(scene, {a.out}, settings, terminal)));
}

int resume_command(const ResumeArguments& a) {
  use_threads(a.threads);
  auto settings = settings_of<ResumeSettings>(a);
  settings.instructions = a.instructions;
  settings.accept_changes = a.accept_changes;
  TerminalListener terminal(a.quiet);
  return code_of(go_through(resume_run({a.dir}, settings, terminal)));
}

}  // namespace ropewalk
