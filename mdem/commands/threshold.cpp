// `threshold`: critical values over the points of a sweep.
#include "campaign/threshold.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "commands/commands.hpp"
#include "commands/point_runs.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "run/tell.hpp"
#include "run/wall_time.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

class Search {
 public:
  Search(Sweep sweep, const ThresholdArguments& a)
      : sweep_(std::move(sweep)),
        dir_(campaign_directory(a.file, a.out)),
        points_(points_of(sweep_)),
        arguments_(a),
        jobs_(a.jobs > 0 ? a.jobs : omp_get_num_procs()) {
    // Both ends of the range, so that a wrong key or value is found before anything runs.
    for (const SweepPoint& p : points_)
      for (const double value : {sweep_.threshold->from, sweep_.threshold->to}) scene_at(p, value);
  }

  int go() {
    create_campaign(dir_, sweep_, {}, arguments_.force);
    refuse_other_scenes();
    read_known_trials();
    listen_to_stop_signals();
    const double began = steady_seconds();
    std::vector<ProcessTask> tasks;
    std::size_t done = 0;
    std::vector<std::string> failed;
    for (const SweepPoint& p : points_)
      tasks.push_back({[this, &p] { return in_a_process(dir_.messages(p.name), false, [&] { return bisect(p); }); },
                       [&](int status) {
                         ++done;
                         if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) failed.push_back(p.name);
                         write();
                         if (!arguments_.quiet)
                           tell_as_is(fmt::format("{} of {} points, {} passed: {}\n", done, points_.size(),
                                                  duration_text(steady_seconds() - began), result_words(p)));
                       }});
    run_processes(tasks, jobs_, &stop_signal);
    write();  // the trials of points that were stopped count as well
    if (stop_signal) {
      tell_as_is(fmt::format("ropewalk: stopped by signal {}; go on with the same command\n",
                             static_cast<int>(stop_signal)));
      return 128 + stop_signal;
    }
    tell(failed);
    return failed.empty() ? 0 : 3;
  }

 private:
  Scene scene_at(const SweepPoint& p, double value) const {
    try {
      return scene_of_text(trial_text(sweep_, p, value), sweep_.scene_path);
    } catch (const InputError& e) {
      throw InputError({sweep_.path, 0, ""}, fmt::format("point {} at {:g}: {}", p.name, value, e.what()), "");
    }
  }

  // Runs in the directory must be of this sweep.
  void refuse_other_scenes() {
    for (const SweepPoint& p : points_) {
      for (const Trial& t : threshold_of(dir_, sweep_, p, {}).trials) {
        const RunDirectory run = trial_directory(dir_, sweep_, p, t.value);
        if (is_run_of(run, trial_text(sweep_, p, t.value), p.sets)) continue;
        if (!arguments_.force)
          throw InputError({run.path, 0, "--out"}, "was run with another scene or parameter set",
                           "choose another --out, or give --force to run it anew");
        fs::remove_all(run.path);
      }
    }
  }

  // Trials whose runs are not in the directory: of its own table, and of another search.
  void read_known_trials() {
    if (fs::exists(dir_.trials())) {
      const auto [others, all] = take(dir_.trials());
      if (others > 0 && !arguments_.force)
        throw InputError({dir_.trials(), 0, ""},
                         fmt::format("{} of its {} trials are of other scenes or parameter sets, and would be lost",
                                     others, all),
                         "choose another --out, or give --force");
    }
    if (arguments_.known.empty()) return;
    if (const auto [others, all] = take(arguments_.known); others > 0)
      tell_as_is(
          fmt::format("ropewalk: note: {} of the {} trials in {} are of other scenes or parameter sets and "
                      "are not used.\n",
                      others, all, arguments_.known));
  }

  // How many trials of the file are of no point of this search, and how many there are.
  std::pair<std::size_t, std::size_t> take(const std::string& path) {
    const std::vector<Trial> trials = read_trials(path);
    std::size_t others = 0;
    for (const Trial& t : trials) {
      const auto at = std::find_if(points_.begin(), points_.end(), [&](const SweepPoint& p) {
        return trial_hash(sweep_, p, t.value) == t.scene_hash;
      });
      if (at == points_.end())
        ++others;
      else
        known_[at->name].push_back(t);
    }
    return {others, trials.size()};
  }

  // 0 where the run ended.
  int try_at(const SweepPoint& p, double value) const {
    const RunDirectory run = trial_directory(dir_, sweep_, p, value);
    const std::string hash = trial_hash(sweep_, p, value);
    for (const Trial& t : threshold_of(dir_, sweep_, p, known_).trials)
      if (t.scene_hash == hash) return 0;
    fs::create_directories(dir_.point(p.name).path);
    Scene scene = scene_at(p, value);
    scene.name += fmt::format(", {}, {:g}", p.name, value);
    return run_or_resume(run, scene, -1, OnLimit::warn);
  }

  int bisect(const SweepPoint& p) const {
    const ThresholdQuestion& q = *sweep_.threshold;
    // The upper end first: it is soon decided.
    for (const double end : {q.to, q.from})
      if (const int code = try_at(p, end)) return code;
    // An outcome may have a window: above it, a rope opens into a cage before it becomes a helix.
    for (const double part : {0.5, 0.25, 0.75}) {
      const auto passed = [](const Trial& t) { return t.passed; };
      const std::vector<Trial> trials = threshold_of(dir_, sweep_, p, known_).trials;
      if (std::any_of(trials.begin(), trials.end(), passed)) break;
      if (const int code = try_at(p, q.from + part * (q.to - q.from))) return code;
    }
    for (;;) {
      const Threshold t = threshold_of(dir_, sweep_, p, known_);
      if (t.outside || t.above - t.below <= q.accuracy * std::fabs(t.middle())) return 0;
      if (const int code = try_at(p, t.middle())) return code;
    }
  }

  std::string result_words(const SweepPoint& p) const {
    const Threshold t = threshold_of(dir_, sweep_, p, known_);
    if (t.trials.empty()) return fmt::format("{}: no run ended, see {}", p.name, dir_.messages(p.name));
    if (t.outside)
      return fmt::format(
          "{}: {}", p.name,
          t.trials.back().passed ? "passed at the lower end already" : "at none of the values tried");
    return fmt::format("{}: {:.4g} to {:.4g}", p.name, t.below, t.above);
  }

  // The tables and the page of what is known so far.
  void write() const {
    const std::vector<PhasePoint> points = phase_points(dir_, sweep_, points_, known_);
    write_file_atomically(dir_.path + "/thresholds.csv", thresholds_csv(sweep_, points));
    write_file_atomically(dir_.trials(), trials_csv(sweep_, points));
    write_file_atomically(dir_.path + "/thresholds.html", phase_page(sweep_, points));
  }

  void tell(const std::vector<std::string>& failed) const {
    const std::vector<PhasePoint> points = phase_points(dir_, sweep_, points_, known_);
    double seconds = 0;
    std::size_t runs = 0;
    for (const auto& entry : fs::recursive_directory_iterator(dir_.path + "/points"))
      if (entry.path().filename() == "manifest.json")
        seconds += progress_of({entry.path().parent_path().string()}).wall_seconds, ++runs;
    for (const PhasePoint& p : points) {
      const auto growth = p.by_growth();
      fmt::print("{:<40} by bisection {:<18} by growth {}\n", p.name,
                 std::isfinite(p.by_bisection())
                     ? fmt::format("{:.4g} ± {:.2g}", p.by_bisection(), p.bisection_error())
                     : std::string("not in the range"),
                 growth ? fmt::format("{:.4g} ± {:.2g}", growth->critical, growth->error) : std::string("-"));
    }
    fmt::print("{} runs, {} of one core in all. Page: {}/thresholds.html\n", runs, duration_text(seconds),
               dir_.path);
    for (const std::string& name : failed) fmt::print("not ended: {}, see {}\n", name, dir_.messages(name));
  }

  Sweep sweep_;
  CampaignDirectory dir_;
  std::vector<SweepPoint> points_;
  KnownTrials known_;
  const ThresholdArguments& arguments_;
  int jobs_;
};

}  // namespace

int threshold_command(const ThresholdArguments& a) {
  Sweep sweep = read_sweep(a.file);
  if (!sweep.threshold)
    throw InputError({a.file, 0, "threshold"}, "is missing",
                     "add [threshold] with key, from, to, column and above, or run it with `ropewalk sweep`");
  if (!sweep.branch_axes.empty())
    throw InputError({a.file, 0, "branch"}, "does not go with [threshold]", "take it away");
  return Search(std::move(sweep), a).go();
}

}  // namespace ropewalk
