// `sweep`: many runs of one scene.
#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>

#include <algorithm>
#include <map>

#include "campaign/point_runs.hpp"
#include "campaign/sweep_runs.hpp"
#include "commands/cluster_scripts.hpp"
#include "commands/sweep_progress.hpp"
#include "commands/verb.hpp"
#include "io/clocks.hpp"
#include "io/error_exit.hpp"
#include "io/files.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/results.hpp"
#include "run/tell.hpp"

namespace ropewalk {
namespace {

struct SweepArguments {
  std::string file;
  std::string out;                // empty: FILE without .toml
  std::vector<std::string> only;  // names of points, or their numbers from 1; empty: all
  std::string slurm, snakemake;   // file to write instead
  std::string on_limit = "warn";  // or "stop"
  int jobs = 0;                   // runs at a time; 0: one for each core
  bool dry_run = false;
  bool again = false;  // failed points as well
  bool force = false;
  bool quiet = false;
};

using Stage = PointProgress::Stage;

constexpr std::size_t most_built = 20;  // scenes of points, where a script is written

int dry_run(const Sweep& sweep, const CampaignDirectory& dir, const std::vector<SweepPoint>& points, int jobs) {
  const std::vector<double> seconds =
      seconds_of_points(sweep, points, [](const SweepPoint& p, const std::exception& e) {
        tell_as_is(fmt::format("ropewalk: {} cannot be timed: {}\n", p.name, error_words(e)));
      });
  double total = 0;
  fmt::print("{:>5}  {:<50} {:>10}\n", "", "point", "time");
  for (std::size_t i = 0; i < points.size(); ++i) {
    total += seconds[i];
    const PointProgress progress = progress_of(dir.point(points[i].name));
    fmt::print("{:>5}  {:<50} {:>10}{}\n", i + 1, points[i].name, duration_text(seconds[i]),
               progress.stage == Stage::waiting
                   ? ""
                   : "  " + status_words(progress.status, limits_of(dir.point(points[i].name))));
  }
  const std::size_t runs = points.size();
  fmt::print("{} points, about {} of one core, {} on {} cores{}\n", runs, duration_text(total),
             duration_text(total / std::min<double>(jobs, static_cast<double>(runs))), jobs,
             sweep.branch_axes.empty() ? "" : "; less what the shared starts save");
  return 0;
}

int summary(const CampaignDirectory& dir, const std::vector<SweepPoint>& points, bool with_table) {
  std::map<std::string, std::size_t> counts;
  std::vector<std::string> failed, beyond, elsewhere, misses;
  std::size_t expected = 0, points_missed = 0;
  double seconds = 0;
  std::size_t passed = 0;
  for (const SweepPoint& p : points) {
    const PointProgress progress = progress_of(dir.point(p.name));
    ++counts[progress.status];
    seconds += progress.wall_seconds;
    if (progress.status == "running")
      elsewhere.push_back(fmt::format("{}, by {}", p.name, holder_of(dir.point(p.name).path)));
    else if (progress.stage != Stage::ended)
      failed.push_back(p.name);
    const std::vector<LimitRecord> limits = limits_of(dir.point(p.name));
    if (first_limit(limits)) ++passed;
    if (beyond_limits(limits) > far_beyond && progress.stage == Stage::ended)
      beyond.push_back(fmt::format("{}, {}: {}", p.name, beyond_words(limits), worst_words(limits)));
    const std::vector<Judgement> all = judged(dir.point(p.name));
    expected += all.size();
    if (missed(all) > 0) ++points_missed;
    for (const Judgement& j : all)
      if (!j.holds) misses.push_back(fmt::format("{}: {}", p.name, j.words));
  }
  std::string words;
  for (const auto& [status, count] : counts)
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, status);
  fmt::print("{} points: {}; {} of one core in all\n", points.size(), words, duration_text(seconds));
  for (const std::string& name : failed) tell_not_ended(dir, name);
  for (const std::string& name : elsewhere) tell("run elsewhere: " + name);
  if (passed > 0)
    fmt::print("{} of them {} beyond a limit of the model: see first_limit and first_limit_ps in the table\n",
               passed, passed == 1 ? "is" : "are");
  for (const std::string& name : beyond) fmt::print("far beyond a limit: {}\n", name);
  for (const std::string& words : misses) fmt::print("{}\n", words);
  if (expected > 0)
    fmt::print("{} of {} expectations hold{}\n", expected - misses.size(), expected,
               points_missed > 0 ? fmt::format("; {} of the points miss one", points_missed) : "");
  if (with_table) fmt::print("Table: {}\n", dir.table());
  if (!failed.empty() || !elsewhere.empty()) return 3;
  return misses.empty() ? 0 : not_as_expected;
}

int sweep_command(const SweepArguments& a) {
  const Sweep sweep = read_sweep(a.file);
  if (sweep.threshold)
    throw InputError({a.file, 0, "threshold"}, "asks for critical values", "run it with `ropewalk threshold`");
  const CampaignDirectory dir = campaign_directory(a.file, a.out);
  // A job of an array looks at its own point alone; who writes an array reads all scenes and builds some.
  const ClusterScripts scripts{a.slurm, a.snakemake};
  const std::vector<SweepPoint> all = points_of(sweep, scripts.any() ? PointsAs::read : PointsAs::names);
  std::vector<SweepPoint> points = chosen_points(all, a.only);
  const std::size_t apart = scripts.any() ? std::max<std::size_t>(1, points.size() / most_built) : 1;
  for (std::size_t k = 0; k < points.size(); k += apart) complete(sweep, points[k]);
  if (a.only.empty())
    if (const std::string why = why_replicates_are_equal(sweep, points); !why.empty()) tell("note: " + why);
  const int jobs = a.jobs > 0 ? a.jobs : omp_get_num_procs();
  if (a.dry_run) return dry_run(sweep, dir, points, jobs);
  if (scripts.any())
    return write_script(scripts, "sweep", a.file, dir, all,
                        (a.on_limit == "warn" ? "" : " --on-limit " + a.on_limit) + (a.again ? " --again" : ""),
                        jobs, a.force);
  const DirectoryLock lock = create_campaign(dir, sweep, points, a.force);
  listen_to_stop_signals();
  const SweepRuns runs(sweep, dir, points, on_limit_of(a.on_limit), jobs, a.again);
  SweepProgress progress(dir, points, runs, a.quiet);
  if (!sweep.branch_axes.empty()) runs.run_starts([&](const SweepPoint& p) { progress.start_failed(p); });
  progress.begin();
  runs.run_points([&](const SweepPoint& p, int status) { progress.ended(p, status); });
  if (stop_signal) return tell_stop();
  if (a.only.empty()) write_file_atomically(dir.table(), gathered_csv(dir, sweep, all, {}));
  progress.clear_line();
  return summary(dir, points, a.only.empty());
}

}  // namespace

void add_sweep(CLI::App& app, Program& program) {
  const auto a = std::make_shared<SweepArguments>();
  CLI::App* c =
      app.add_subcommand("sweep", "Run a scene for many values of its keys, each point in a directory of its own");
  c->add_option("file", a->file, "Sweep (TOML): scene = \"rope.toml\", then [vary] with rope.tubes = [7, 19]")
      ->required();
  c->add_option("--out", a->out, "Directory of the campaign, where the same command goes on [default: FILE]");
  c->add_option("-j,--jobs", a->jobs, "Runs at a time, each on one core [default: all cores]")
      ->check(thread_range());
  c->add_flag("--dry-run", a->dry_run, "Only list the points and what they cost");
  c->add_option("--only", a->only, "Points by name, or by number from 1")->delimiter(',');
  c->add_flag("--again", a->again, "Run failed points once more");
  c->add_option("--on-limit", a->on_limit, "What points do where a limit of [limits] is passed: warn or stop")
      ->capture_default_str()
      ->check(CLI::IsMember({"warn", "stop"}));
  c->add_option("--slurm", a->slurm, "Only write a SLURM array with a job for each point to this file");
  c->add_option("--snakemake", a->snakemake, "Only write a Snakemake file to this file");
  c->add_flag("--force", a->force, "Replace points that were run with another scene");
  c->add_flag("--quiet", a->quiet, "No progress line");
  c->callback([a, &program] { program.code = sweep_command(*a); });
}

}  // namespace ropewalk
