// `threshold`: critical values over the points of a sweep.
#include <fmt/format.h>
#include <omp.h>

#include <cmath>
#include <filesystem>

#include "campaign/point_runs.hpp"
#include "campaign/static_threshold.hpp"
#include "campaign/threshold_search.hpp"
#include "commands/cluster_scripts.hpp"
#include "commands/sweep_progress.hpp"
#include "commands/verb.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/tell.hpp"
#include "run/wall_time.hpp"

namespace ropewalk {
namespace {

struct ThresholdArguments {
  std::string file;
  std::string out;                // empty: FILE without .toml
  std::string known;              // trials.csv of an earlier search
  std::vector<std::string> only;  // numbers from 1 or names of points; empty: all
  std::string slurm, snakemake;   // write this file and run nothing
  int jobs = 0;                   // points at a time; 0: one for each core
  bool theory = false;            // run nothing
  bool by_statics = false;        // by Newton's method, without runs
  bool force = false;
  bool quiet = false;
};

namespace fs = std::filesystem;

void take_known(ThresholdSearch& search, const std::string& trials) {
  if (const auto [others, all] = search.take(trials); others > 0)
    tell_as_is(fmt::format(
        "ropewalk: note: {} of the {} trials in {} are of other scenes, parameter sets or state files and "
        "are not used.\n",
        others, all, trials));
}

void print_results(const CampaignDirectory& dir, const std::vector<PhasePoint>& points) {
  double seconds = 0;
  std::size_t runs = 0;
  for (const auto& entry : fs::recursive_directory_iterator(dir.path + "/points"))
    if (entry.path().filename() == "manifest.json")
      seconds += progress_of({entry.path().parent_path().string()}).wall_seconds, ++runs;
  for (const PhasePoint& p : points) {
    const double theory = p.kinetic_theory(), least = p.static_theory();
    fmt::print("{:<40} by bisection {:<18} theory {}{}\n", p.name,
               std::isfinite(p.by_bisection())
                   ? fmt::format("{:.4g} ± {:.2g}", p.by_bisection(), p.bisection_error())
                   : std::string(p.begun() ? "not in the range" : "not run yet"),
               std::isfinite(theory) ? fmt::format("{:.4g}", theory) : std::string("-"),
               std::isfinite(least) ? fmt::format(", none grows below {:.4g}", least) : std::string());
    if (const std::string remarks = p.remarks(); !remarks.empty()) fmt::print("  note: {}\n", remarks);
  }
  fmt::print("{} runs, {} of one core in all. Page: {}/thresholds.html\n", runs, duration_text(seconds), dir.path);
}

int thresholds_by_statics(const ThresholdArguments& a, const Sweep& sweep, const CampaignDirectory& dir) {
  for (const auto& [given, option] : {std::pair{!a.known.empty(), "--known"},
                                      {!a.slurm.empty(), "--slurm"},
                                      {!a.snakemake.empty(), "--snakemake"},
                                      {a.theory, "--theory"}})
    if (given)
      throw InputError({"", 0, option}, "is for runs, and --static makes none", "leave one of the two out");
  const std::string file = dir.path + "-static.csv";  // beside the directory of runs
  if (!a.force && fs::exists(file))
    throw InputError({file, 0, "--out"}, "exists", "choose another --out, or give --force");
  const std::vector<SweepPoint> all = points_of(sweep);
  std::vector<StaticThreshold> found;
  for (const SweepPoint& point : chosen_points(all, a.only)) {
    found.push_back(static_threshold(sweep, point));
    const StaticThreshold& t = found.back();
    fmt::print("{:<40} {:<18} theory {}{}\n", t.point,
               t.found() ? fmt::format("{:.4g} ± {:.2g}", t.value(), t.error()) : std::string("not found"),
               std::isfinite(t.theory) ? fmt::format("{:.4g}", t.theory) : std::string("-"),
               t.motion.empty() ? "" : "; above it grows: " + t.motion);
    if (!t.why.empty()) fmt::print("  note: {}\n", t.why);
  }
  write_file_atomically(file, static_thresholds_csv(found));
  fmt::print("Friction and the time of a run have no part in it. Numbers: {}\n", file);
  return 0;
}

int threshold_command(const ThresholdArguments& a) {
  Sweep sweep = read_sweep(a.file);
  if (!sweep.threshold)
    throw InputError(
        {a.file, 0, "threshold"}, "is missing",
        "add [threshold] with key, from, to, column and above (or shape), or run it with `ropewalk sweep`");
  if (!sweep.branch_axes.empty())
    throw InputError({a.file, 0, "branch"}, "does not go with [threshold]", "take it away");
  if (const std::string why = why_replicates_are_equal(sweep, points_of(sweep, PointsAs::scenes)); !why.empty())
    tell("note: " + why);
  const CampaignDirectory dir = campaign_directory(a.file, a.out);
  if (a.by_statics) return solve_here(a.jobs, [&] { return thresholds_by_statics(a, sweep, dir); });
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  ThresholdSearch search(std::move(sweep), dir, a.only);
  if (const ClusterScripts scripts{a.slurm, a.snakemake}; scripts.any())
    return write_script(scripts, "threshold", a.file, dir, search.points(),
                        a.known.empty() ? "" : " --known " + shell_quoted(fs::absolute(a.known).string()), jobs,
                        a.force);
  search.begin(a.force);
  if (!a.known.empty()) take_known(search, a.known);
  listen_to_stop_signals();
  const double began = steady_seconds();
  std::size_t done = 0;
  std::vector<std::string> failed;
  if (a.theory) {
    search.write();
    print_results(dir, search.results());
    return 0;
  }
  search.go(jobs, [&](const SweepPoint& p, bool well) {
    ++done;
    if (!well) failed.push_back(p.name);
    if (!a.quiet)
      tell_as_is(fmt::format("{} of {} points, {} passed: {}\n", done, search.size(),
                             duration_text(steady_seconds() - began), search.words_of(p)));
  });
  if (stop_signal) return tell_stop();
  if (a.only.empty()) print_results(dir, search.results());
  for (const std::string& name : failed) tell_not_ended(dir, name);
  return failed.empty() ? 0 : 3;
}

}  // namespace

void add_threshold(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ThresholdArguments>();
  CLI::App* c = app.add_subcommand(
      "threshold",
      "The critical value of a key at each point of a sweep, by bisection, beside theory: a phase diagram");
  c->add_option("file", a->file, "Sweep (TOML) with [threshold]: key, from, to, and column and above, or shape")
      ->required();
  c->add_option("--out", a->out, "Directory of the campaign, where the same command goes on [default: FILE]");
  c->add_option("-j,--jobs", a->jobs, "Points at a time, each on one core [default: all cores]")
      ->check(thread_range());
  c->add_option("--known", a->known,
                "trials.csv of an earlier search: its trials of the same scenes are not run again")
      ->check(CLI::ExistingFile);
  c->add_option("--only", a->only, "Numbers from 1 or names of the points to search")->delimiter(',');
  c->add_option("--slurm", a->slurm, "Only write a SLURM array with a job for each point to this file");
  c->add_option("--snakemake", a->snakemake, "Only write a Snakemake file to this file");
  c->add_flag("--theory", a->theory, "Run nothing: tables and page of theory and of the runs that are there");
  c->add_flag(
      "--static", a->by_statics,
      "Run nothing: find, by statics, between which values the equilibrium without friction loses its stability");
  c->add_flag("--force", a->force, "Replace runs of another scene");
  c->add_flag("--quiet", a->quiet, "No progress");
  c->callback([a, &program] { program.code = threshold_command(*a); });
}

}  // namespace ropewalk
