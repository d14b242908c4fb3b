// `sweep` and `gather`: many runs of one scene, and one table of them.
#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>

#include "campaign/campaign.hpp"
#include "commands/commands.hpp"
#include "commands/point_runs.hpp"
#include "io/failure.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_time.hpp"
#include "run/tell.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;
using Stage = PointProgress::Stage;

constexpr std::size_t most_timed = 6;  // points of a dry run whose steps are timed
constexpr double relax_steps = 2000;   // a guess, where a relaxation does not end at once

std::vector<SweepPoint> chosen(const std::vector<SweepPoint>& points, const std::vector<std::string>& only) {
  if (only.empty()) return points;
  std::vector<SweepPoint> out;
  for (const std::string& word : only) {
    const bool number = word.find_first_not_of("0123456789") == std::string::npos && word.size() < 8;
    const std::size_t index = number && !word.empty() ? std::stoul(word) : 0;
    const auto at = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.name == word; });
    if (at != points.end())
      out.push_back(*at);
    else if (index >= 1 && index <= points.size())
      out.push_back(points[index - 1]);
    else
      throw InputError({"", 0, "--only"}, fmt::format("there is no point \"{}\"", word),
                       fmt::format("take a number from 1 to {}, or a name of --dry-run", points.size()));
  }
  return out;
}

class Campaign {
 public:
  Campaign(Sweep sweep, const SweepArguments& a)
      : sweep_(std::move(sweep)),
        dir_(campaign_directory(a.file, a.out)),
        all_(points_of(sweep_)),
        points_(chosen(all_, a.only)),
        arguments_(a),
        jobs_(a.jobs > 0 ? a.jobs : omp_get_num_procs()) {}

  int go() {
    create_campaign(dir_, sweep_, all_, arguments_.force);
    listen_to_stop_signals();
    began_ = now();
    if (!sweep_.branch_axes.empty()) run_starts();
    run_points();
    if (stop_signal) {
      tell_as_is(fmt::format("ropewalk: stopped by signal {}; go on with the same command\n",
                             static_cast<int>(stop_signal)));
      return 128 + stop_signal;
    }
    if (arguments_.only.empty()) write_file_atomically(dir_.table(), gathered_csv(dir_, sweep_, all_, {}));
    return summary();
  }

  int dry_run() const {
    // Some of the points are timed; the time of the others is interpolated by their work.
    std::vector<std::pair<double, double>> timed;  // work, seconds
    const std::size_t n = std::min(points_.size(), most_timed);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = n > 1 ? k * (points_.size() - 1) / (n - 1) : 0;
      try {
        const RunTime t = time_run(points_[i].text, sweep_.scene_path);
        timed.emplace_back(points_[i].work, t.steps > 0 ? t.total() : relax_steps * t.each);
      } catch (const std::exception& e) {
        tell_as_is(fmt::format("ropewalk: {} cannot be timed: {}\n", points_[i].name, failure_words(e)));
      }
    }
    if (timed.empty()) timed.emplace_back(1, std::numeric_limits<double>::quiet_NaN());
    std::sort(timed.begin(), timed.end());
    double total = 0;
    fmt::print("{:>5}  {:<50} {:>10}\n", "", "point", "time");
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double seconds = between(timed, points_[i].work);
      total += seconds;
      fmt::print("{:>5}  {:<50} {:>10}{}\n", i + 1, points_[i].name, duration_text(seconds),
                 stage_words(points_[i]));
    }
    const std::size_t runs = points_.size();
    fmt::print("{} points, about {} of one core, {} on {} cores{}\n", runs, duration_text(total),
               duration_text(total / std::min<double>(jobs_, static_cast<double>(runs))), jobs_,
               sweep_.branch_axes.empty() ? "" : "; less what the shared starts save");
    return 0;
  }

  int write_slurm() const {
    refuse_existing(arguments_.slurm, "--slurm", arguments_.force);
    write_file_atomically(arguments_.slurm, slurm_script(arguments_.file, dir_, all_.size()));
    fmt::print("{} written: sbatch {}\n", arguments_.slurm, arguments_.slurm);
    return 0;
  }
  int write_snakemake() const {
    refuse_existing(arguments_.snakemake, "--snakemake", arguments_.force);
    write_file_atomically(arguments_.snakemake, snakemake_file(arguments_.file, dir_, all_));
    fmt::print("{} written: snakemake -s {} --cores {}\n", arguments_.snakemake, arguments_.snakemake, jobs_);
    return 0;
  }

 private:
  // Of a list that rises in work.
  static double between(const std::vector<std::pair<double, double>>& timed, double work) {
    const auto above = std::lower_bound(timed.begin(), timed.end(), std::make_pair(work, 0.0));
    if (above == timed.begin()) return above->second * work / above->first;
    const auto below = std::prev(above);
    if (above == timed.end()) return below->second * work / below->first;
    const double part = (work - below->first) / (above->first - below->first);
    return below->second + part * (above->second - below->second);
  }

  std::string stage_words(const SweepPoint& p) const {
    const PointProgress progress = progress_of(dir_.point(p.name));
    return progress.stage == Stage::waiting ? "" : "  " + progress.status;
  }

  bool is_to_run(const SweepPoint& p) const {
    const Stage stage = progress_of(dir_.point(p.name)).stage;
    return stage == Stage::waiting || stage == Stage::begun || (stage == Stage::failed && arguments_.again);
  }

  void run_starts() {
    fs::create_directories(dir_.path + "/starts");
    std::vector<ProcessTask> tasks;
    for (const SweepPoint& p : starts_of(sweep_)) {
      const bool needed = std::any_of(points_.begin(), points_.end(), [&](const SweepPoint& q) {
        return q.start == p.name && progress_of(dir_.point(q.name)).stage == Stage::waiting;
      });
      const RunDirectory to = dir_.start(p.name);
      if (fs::exists(to.scene()) && !is_run_of(to, p.text, p.sets)) fs::remove_all(to.path);
      if (!needed || progress_of(to).stage == Stage::ended) continue;
      tasks.push_back({[this, p, to] {
                         return in_a_process(dir_.messages("start-" + p.name), true, [&] {
                           if (progress_of(to).stage == Stage::ended) return 0;
                           return run_or_resume(to, scene_of(sweep_, p), sweep_.branch_at, "warn");
                         });
                       },
                       [this, p](int status) {
                         if (status != 0) say(fmt::format("the shared start {} did not reach its end", p.name));
                       }});
    }
    run_processes(tasks, jobs_, &stop_signal);
  }

  // Copies the shared run and replaces its scene by that of the point. The point keeps the time step of the shared
  // run, because the log and the frames count time by steps.
  void branch_off(const SweepPoint& p) const {
    const RunDirectory from = dir_.start(p.start), to = dir_.point(p.name);
    if (progress_of(from).stage != Stage::ended)
      throw InputError({from.path, 0, ""}, "did not reach its end, and this point goes on from there",
                       "see its messages");
    fs::remove_all(to.path);
    const std::string half = to.path + ".part";
    fs::remove_all(half);
    fs::copy(from.path, half, fs::copy_options::recursive);
    const RunDirectory made{half};
    const double step = read_manifest(from.manifest()).time_step_fs;
    write_file_atomically(made.scene(),
                          with_value(p.text, "run.time_step_fs", fmt::format("{:.17g}", step), sweep_.scene_path));
    // The shared run is one of every point's scene, up to here.
    RunCheckpoint c = read_checkpoint(made);
    c.origin = origin_of(made, read_run_scene(made));
    write_checkpoint(made, c);
    fs::remove(made.checkpoint_before());
    Manifest m = read_manifest(made.manifest());
    m.status = "interrupted";
    m.scene = scene_of(sweep_, p).name;
    write_file_atomically(made.manifest(), manifest_json(m));
    fs::rename(half, to.path);
  }

  int run_point(const SweepPoint& p) const {
    const RunDirectory dir = dir_.point(p.name);
    if (!is_to_run(p)) return 0;  // done by another process meanwhile
    if (progress_of(dir).stage == Stage::failed) fs::remove_all(dir.path);
    if (!p.start.empty() && progress_of(dir).stage == Stage::waiting) branch_off(p);
    return run_or_resume(dir, scene_of(sweep_, p), -1, arguments_.on_limit);
  }

  void run_points() {
    std::vector<ProcessTask> tasks;
    for (const SweepPoint& p : points_) {
      if (!is_to_run(p)) {
        ++done_;
        continue;
      }
      work_left_ += p.work;
      tasks.push_back(
          {[this, p] { return in_a_process(dir_.messages(p.name), false, [&] { return run_point(p); }); },
           [this, p](int status) { ended(p, status); }});
    }
    if (done_ > 0) say(fmt::format("{} of {} points are done already", done_, points_.size()));
    work_to_do_ = work_left_;
    run_processes(tasks, jobs_, &stop_signal);
  }

  void ended(const SweepPoint& p, int status) {
    ++done_;
    work_left_ -= p.work;
    const PointProgress progress = progress_of(dir_.point(p.name));
    if (WIFEXITED(status) && WEXITSTATUS(status) == point_busy)
      say(fmt::format("{} is run by another process", p.name));
    else if (progress.stage == Stage::failed)
      say(fmt::format("{}: {}", p.name, printable(progress.reason)));
    else if (progress.stage != Stage::ended && !stop_signal)
      say(fmt::format("{} did not end; see {}", p.name, dir_.messages(p.name)));
    const double passed = now() - began_, left = passed * work_left_ / std::max(work_to_do_ - work_left_, 1.0);
    if (isatty(STDERR_FILENO) && !arguments_.quiet)
      tell_as_is(fmt::format("\r\033[K{} of {} points, {} passed, {} left", done_, points_.size(),
                             duration_text(passed), duration_text(left)));
    else if (now() > next_line_ || done_ == points_.size())
      say(fmt::format("{} of {} points, {} passed, {} left", done_, points_.size(), duration_text(passed),
                      duration_text(left)));
    else
      return;
    next_line_ = now() + 10;
  }

  void say(const std::string& line) const {
    if (!arguments_.quiet) tell_as_is(fmt::format("{}{}\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", line));
  }

  int summary() const {
    std::map<std::string, std::size_t> counts;
    std::vector<std::string> failed;
    double seconds = 0;
    for (const SweepPoint& p : points_) {
      const PointProgress progress = progress_of(dir_.point(p.name));
      ++counts[progress.status];
      seconds += progress.wall_seconds;
      if (progress.stage != Stage::ended) failed.push_back(p.name);
    }
    std::string words;
    for (const auto& [status, count] : counts)
      words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, status);
    if (isatty(STDERR_FILENO) && !arguments_.quiet) tell_as_is("\r\033[K");
    fmt::print("{} points: {}; {} of one core in all\n", points_.size(), words, duration_text(seconds));
    for (const std::string& name : failed) fmt::print("not ended: {}, see {}\n", name, dir_.messages(name));
    if (arguments_.only.empty()) fmt::print("Table: {}\n", dir_.table());
    return failed.empty() ? 0 : 3;
  }

  Sweep sweep_;
  CampaignDirectory dir_;
  std::vector<SweepPoint> all_, points_;
  const SweepArguments& arguments_;
  int jobs_;
  std::size_t done_ = 0;
  double work_left_ = 0, work_to_do_ = 0, began_ = 0, next_line_ = 0;
};

}  // namespace

int sweep_command(const SweepArguments& a) {
  Sweep sweep = read_sweep(a.file);
  if (sweep.threshold)
    throw InputError({a.file, 0, "threshold"}, "asks for critical values", "run it with `ropewalk threshold`");
  Campaign campaign(std::move(sweep), a);
  if (a.dry_run) return campaign.dry_run();
  if (!a.slurm.empty()) return campaign.write_slurm();
  if (!a.snakemake.empty()) return campaign.write_snakemake();
  return campaign.go();
}

int gather_command(const GatherArguments& a) {
  if (!a.out.empty()) refuse_existing(a.out, "-o", a.force);
  const CampaignDirectory dir{a.dir};
  const Sweep sweep = read_campaign(dir);
  GatherOptions options;
  options.mean_ps = a.mean_ps;
  options.series = a.series;
  options.columns = a.columns;
  const std::string table = gathered_csv(dir, sweep, points_of(sweep, false), options);
  if (a.out.empty()) {
    fmt::print("{}", table);
    return 0;
  }
  write_file_atomically(a.out, table);
  fmt::print("{} written\n", a.out);
  return 0;
}

}  // namespace ropewalk
