#include "commands/cluster_scripts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "commands/siblings.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "run/wall_time.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {

int write_script(const ClusterScripts& scripts, const std::string& verb, const std::string& file,
                 const CampaignDirectory& dir, const std::vector<SweepPoint>& points, const std::string& options,
                 int jobs, bool force) {
  const std::string program = this_program();
  const bool slurm = !scripts.slurm.empty();
  const std::string& path = slurm ? scripts.slurm : scripts.snakemake;
  refuse_existing(path, slurm ? "--slurm" : "--snakemake", force);
  write_file_atomically(path, slurm ? slurm_script(program, verb, file, dir, points.size(), options)
                                    : snakemake_file(program, verb, file, dir, points, options));
  fmt::print("{} written: {}\n", path,
             slurm ? "sbatch " + path : fmt::format("snakemake -s {} --cores {}", path, jobs));
  return 0;
}

namespace {

namespace fs = std::filesystem;

// A job may start in another folder.
std::string absolute(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

// A time in the form that SLURM reads; SLURM takes a number alone for minutes.
std::string in_hours(double seconds) {
  const auto s = static_cast<long>(std::ceil(seconds));
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

// The options that `run` and `resume` share.
std::string options_of(const RunArguments& a) {
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

}  // namespace

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

}  // namespace ropewalk
