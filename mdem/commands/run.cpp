// `run` and `resume`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "commands/siblings.hpp"
#include "commands/verb.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "run/begin_run.hpp"
#include "run/limit_watch.hpp"
#include "run/terminal_listener.hpp"
#include "run/wall_time.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// Options of both `run` and `resume`.
struct StepArguments {
  int threads = 0;                // 0: all cores
  std::int64_t steps = -1;        // number of the run's last step; -1: at the scene's end
  double until_ps = -1;           // ps, when the run stops; -1: at the scene's end
  std::string on_limit = "warn";  // "warn", "stop" or "refine"
  std::string wall_time;          // see seconds_of_wall_time(); empty: any
  std::string instructions;       // empty: the machine's best, or those that the run was begun with
  std::string device;             // see RunSettings
  bool quiet = false;
};

struct RunArguments : StepArguments {
  std::string scene;
  std::string out;
  std::string slurm;   // write a job of SLURM to this file instead; empty: run
  bool force = false;  // overwrite an earlier run
};

struct ResumeArguments : StepArguments {
  std::string dir;
  bool accept_changes = false;  // of scene, sets or program
};

template <class Settings>
Settings settings_of(const StepArguments& a) {
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

// A job may start in another folder.
std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

// A time in the form that SLURM reads; SLURM takes a number alone for minutes.
std::string in_hours(double seconds) {
  const auto s = static_cast<long>(std::ceil(seconds));
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

// The options that `run` and `resume` share.
std::string options_of(const StepArguments& a) {
  std::string text;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) text += fmt::format(" {} {}", name, shell_quoted(value));
  };
  add("--steps", a.steps >= 0 ? fmt::format("{}", a.steps) : "");
  add("--until", a.until_ps >= 0 ? fmt::format("{}", a.until_ps) : "");
  add("--on-limit", a.on_limit);
  add("--instructions", a.instructions);
  add("--device", a.device);
  return text;
}

// Writes a job of SLURM that runs the scene in pieces of its wall time: a job that ends with exit code 6 submits
// the next one, which resumes. Returns the exit code. Throws InputError.
int write_run_script(const RunArguments& a) {
  if (a.wall_time.empty())
    throw InputError({"", 0, "--slurm"}, "needs to know how long one job may last", "give --wall-time 24:00:00");
  if (a.on_limit == "refine")
    throw InputError({"", 0, "--slurm"}, "does not go with --on-limit refine, which goes on in another directory",
                     "take --on-limit warn or stop");
  Scene scene = read_scene(a.scene);
  prepare(scene);
  if (fs::exists(a.out))
    throw InputError({a.out, 0, "--out"}, "is there already, and the job would resume it",
                     "name another directory, or remove this one");
  refuse_existing(a.slurm, "--slurm", a.force);
  const std::string program = shell_quoted(this_program()), run = absolute(a.out),
                    checkpoint = shell_quoted(run + "/checkpoint.bin"), script = shell_quoted(absolute(a.slurm)),
                    with = fmt::format(" --wall-time {} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" --quiet{}",
                                       shell_quoted(a.wall_time), options_of(a));
  constexpr double least = 60;  // s: SLURM counts in minutes
  const double wall_time = seconds_of_wall_time(a.wall_time);
  write_file_atomically(
      a.slurm,
      fmt::format(
          "#!/bin/sh\n"
          "#SBATCH --job-name=ropewalk\n"
          "#SBATCH --ntasks=1\n"
          "#SBATCH --cpus-per-task={}\n"
          "#SBATCH --time={}\n"
          "#SBATCH --output=/dev/null\n"
          "# Add --partition and --account as your cluster asks. Submit it once: a job whose time is over submits "
          "the "
          "next one.\n"
          "exec >> {} 2>&1\n"
          "before=$(cksum {} 2> /dev/null)\n"
          "if [ -e {} ]; then\n"
          "  {} resume {}{}\n"
          "else\n"
          "  {} run {} --out {}{} --force\n"
          "fi\n"
          "code=$?\n"
          "[ $code = 6 ] || exit $code\n"
          "[ \"$(cksum {})\" != \"$before\" ] || {{ echo 'no step was taken: give the job more time'; exit 6; }}\n"
          "exec sbatch {}\n",
          std::max(1, a.threads), in_hours(std::max(least, wall_time)), shell_quoted(run + ".messages.txt"),
          checkpoint, checkpoint, program, shell_quoted(run), with, program, shell_quoted(absolute(a.scene)),
          shell_quoted(run), with, checkpoint, script));
  if (wall_time < least)
    fmt::print(stderr, "ropewalk: note: The shortest job of SLURM is one minute; the run uses {:g} s of each.\n",
               wall_time);
  fmt::print("{} written: sbatch {}\n", a.slurm, a.slurm);
  return 0;
}

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

// The options that both take, as options_of() writes them for a job.
void add_step_options(CLI::App* c, StepArguments& a, const char* instructions_of, const std::string& instructions,
                      const std::string& device) {
  CLI::Option* count = c->add_option("--steps", a.steps, "Stop at this time step")->check(whole_number(0));
  c->add_option("--until", a.until_ps, "Stop at this time (ps) instead of the scene's")
      ->check(number_within(Bounds::non_negative()))
      ->excludes(count);
  c->add_option("--on-limit", a.on_limit,
                "What to do where a limit of [limits] is passed: warn; stop (exit code 5); refine: go on in "
                "DIR.fine with every element split in two")
      ->capture_default_str()
      ->check(CLI::IsMember({"warn", "stop", "refine"}));
  c->add_option("--wall-time", a.wall_time,
                "Stop with a checkpoint (exit code 6) before the program has run for so long: seconds, or H:MM:SS");
  add_instructions(c, a.instructions, instructions_of, instructions);
  add_device(c, a.device, device);
}

}  // namespace

void add_run(CLI::App& app, Program& program) {
  const auto a = std::make_shared<RunArguments>();
  CLI::App* c = app.add_subcommand("run", "Run a scene");
  c->add_option("scene", a->scene, "Scene file (TOML)")->required();
  c->add_option("--out", a->out, "Directory of the run; made, never overwritten")->required();
  c->add_option("--threads", a->threads, "Threads [default: all cores]; any number gives the same bits")
      ->check(thread_range());
  add_step_options(c, *a, "the calculation, for the same bits on other processors", instruction_sets().front(),
                   "none");
  c->add_option(
      "--slurm", a->slurm,
      "Only write a SLURM job to this file that runs the scene in pieces of --wall-time, and submits itself "
      "until the run is done");
  c->add_flag("--force", a->force, "Replace an earlier run in --out");
  c->add_flag("--quiet", a->quiet, "No progress line");
  c->callback([a, &program] {
    wait_briefly(program.argv, a->threads);
    program.code = run_command(*a);
  });
}

void add_resume(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ResumeArguments>();
  CLI::App* c = app.add_subcommand("resume", "Go on with a run from its last checkpoint, bit for bit");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  c->add_option("--threads", a->threads, "Threads [default: all cores]")->check(thread_range());
  add_step_options(c, *a, "the calculation", "that of the run", "that of the run");
  c->add_flag("--accept-changes", a->accept_changes,
              "Go on although the scene, the parameter set or the program is not what the run was begun with");
  c->add_flag("--quiet", a->quiet, "No progress line");
  c->callback([a, &program] {
    wait_briefly(program.argv, a->threads);
    program.code = resume_command(*a);
  });
}

}  // namespace ropewalk
