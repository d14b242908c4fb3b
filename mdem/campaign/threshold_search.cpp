#include "campaign/threshold_search.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>

#include "campaign/point_runs.hpp"
#include "campaign/sweep_runs.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "run/pages/run_plate.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {

namespace fs = std::filesystem;

namespace {

// To three digits, so that runs have short names.
double rounded(double value) { return leading_number(fmt::format("{:.3g}", value)).value_or(value); }

}  // namespace

ThresholdSearch::ThresholdSearch(Sweep sweep, CampaignDirectory dir, const std::vector<std::string>& only)
    : sweep_(std::move(sweep)),
      dir_(std::move(dir)),
      points_(points_of(sweep_)),
      chosen_(chosen_points(points_, only)) {
  for (const SweepPoint& p : chosen_)
    for (const double value : {sweep_.threshold->from, sweep_.threshold->to}) scene_at(p, value);
}

Scene ThresholdSearch::scene_at(const SweepPoint& p, double value) const {
  try {
    return scene_of_text(trial_text(sweep_, p, value), sweep_.scene_path);
  } catch (const InputError& e) {
    throw InputError({sweep_.path, 0, ""}, fmt::format("point {} at {:g}: {}", p.name, value, e.what()), "");
  }
}

void ThresholdSearch::begin(bool force) {
  lock_ = create_campaign(dir_, sweep_, {}, force);
  refuse_other_scenes(force);
  // Runs of its own table that are not in the directory.
  if (fs::exists(dir_.trials())) {
    const auto [others, all] = take(dir_.trials());
    if (others > 0 && !force)
      throw InputError(
          {dir_.trials(), 0, ""},
          fmt::format("{} of its {} trials are of other scenes, parameter sets or state files, and would be lost",
                      others, all),
          "choose another --out, or give --force");
  }
}

// Runs in the directory must be of this sweep.
void ThresholdSearch::refuse_other_scenes(bool force) const {
  for (const SweepPoint& p : points_) {
    for (const Trial& t : threshold_of(dir_, sweep_, p, {}).trials) {
      const RunDirectory run = trial_directory(dir_, sweep_, p, t.value);
      if (is_run_of(run, trial_text(sweep_, p, t.value), p)) continue;
      if (!force)
        throw InputError({run.path, 0, "--out"}, "was run with another scene, parameter set or state file",
                         "choose another --out, or give --force to run it anew");
      remove_run(run, "--force");
    }
  }
}

std::pair<std::size_t, std::size_t> ThresholdSearch::take(const std::string& path) {
  const TrialTable table = read_trials(path);
  // Where the table has the keys of this sweep, a trial can only be of a point with its values.
  struct Candidates {
    std::vector<std::size_t> points;
    std::size_t last = 0;  // place in `points` of the one that the last row was found to belong to
  };
  const bool same_keys = table.keys == key_cells(sweep_, sweep_.keys());
  std::unordered_map<std::string, Candidates> by_values;
  std::vector<TrialHashes> hashes;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    hashes.emplace_back(sweep_, points_[k]);
    by_values[same_keys ? key_cells(sweep_, points_[k].values) : ""].points.push_back(k);
  }
  std::size_t others = 0;
  std::unordered_map<std::string, const Trial*> seen;
  for (std::size_t row = 0; row < table.trials.size(); ++row) {
    const Trial& t = table.trials[row];
    const auto [at, is_new] = seen.emplace(t.scene_hash, &t);
    if (!is_new && (at->second->passed != t.passed || at->second->time != t.time))
      throw InputError(
          {path, 0, "scene_xxh64"},
          fmt::format("two rows of the scene {} at {:g} differ in what came of it", t.scene_hash, t.value),
          "one of them was changed: take it away, or leave --known out");
    if (!is_new) continue;
    // Rows of one point follow one another.
    Candidates& some = by_values[same_keys ? table.values[row] : ""];
    const std::size_t count = some.points.size();
    std::size_t k = 0;
    while (k < count && hashes[some.points[(some.last + k) % count]].of(t.value) != t.scene_hash) ++k;
    if (k == count) {
      ++others;
      continue;
    }
    some.last = (some.last + k) % count;
    known_[points_[some.points[some.last]].name].push_back(t);
  }
  return {others, table.trials.size()};
}

void ThresholdSearch::go(int jobs, const std::function<void(const SweepPoint&, bool)>& ended) {
  std::vector<ProcessTask> tasks;
  // Writing takes seconds where many trials are known: a twentieth of the time at most.
  double next = 0;
  const auto write_now_and_then = [&] {
    const double begin = steady_seconds();
    if (begin < next) return;
    write(false);
    next = begin + 20 * seconds_since(begin);
  };
  for (const SweepPoint& p : chosen_)
    tasks.push_back({[this, &p] { return in_a_process(dir_.messages(p.name), false, [&] { return bisect(p); }); },
                     [&, this](int status) {
                       const bool well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
                       if (well) write_line_of(p);
                       write_now_and_then();
                       ended(p, well);
                     }});
  run_processes(tasks, jobs, &stop_signal);
  write(chosen_.size() == points_.size());  // the trials of points that were stopped count as well
}

// All of its trials may be known, so that it has no directory.
void ThresholdSearch::write_line_of(const SweepPoint& p) const {
  const RunDirectory point = dir_.point(p.name);
  fs::create_directories(point.path);
  write_file_atomically(point.file("threshold.csv"),
                        thresholds_csv(sweep_, phase_points(dir_, sweep_, {p}, known_)));
}

// 0 where the run ended.
int ThresholdSearch::try_at(const SweepPoint& p, double value) const {
  const RunDirectory run = trial_directory(dir_, sweep_, p, value);
  const std::string hash = trial_hash(sweep_, p, value);
  for (const Trial& t : threshold_of(dir_, sweep_, p, known_).trials)
    if (t.scene_hash == hash) return 0;
  fs::create_directories(dir_.point(p.name).path);
  Scene scene = scene_at(p, value);
  scene.name += fmt::format(", {}, {:g}", p.name, value);
  return run_or_resume(run, scene, -1, OnLimit::warn);
}

// Walks from the value that theory foresees, in steps that grow, until the outcome changes or the range ends.
int ThresholdSearch::walk_from(double value, const SweepPoint& p) const {
  const ThresholdQuestion& q = *sweep_.threshold;
  for (double step = 1.12;; step *= step) {
    if (const int code = try_at(p, value)) return code;
    const Threshold t = threshold_of(dir_, sweep_, p, known_);
    if (!t.outside || t.trials.empty()) return 0;
    const bool down = t.trials.front().passed;
    const double least = t.trials.front().value, most = t.trials.back().value;
    if (down ? least <= q.from : most >= q.to) return 0;
    value = down ? std::max(q.from, rounded(least / step)) : std::min(q.to, rounded(most * step));
  }
}

int ThresholdSearch::bisect(const SweepPoint& p) const {
  const ThresholdQuestion& q = *sweep_.threshold;
  const double foreseen = rounded(point_in_theory(sweep_, p).kinetic_theory());
  if (foreseen > q.from && foreseen < q.to)
    if (const int code = walk_from(foreseen, p)) return code;
  // The upper end first: it is soon decided.
  for (const double end : {q.to, q.from})
    if (threshold_of(dir_, sweep_, p, known_).outside)
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

std::string ThresholdSearch::words_of(const SweepPoint& p) const {
  const Threshold t = threshold_of(dir_, sweep_, p, known_);
  if (t.trials.empty()) return fmt::format("{}: no run ended, see {}", p.name, dir_.messages(p.name));
  if (t.outside)
    return fmt::format(
        "{}: {}", p.name,
        t.trials.back().passed ? "passed at all of the values tried" : "at none of the values tried");
  PhasePoint point;
  point.seeds = {t};
  const std::string remarks = point.remarks();
  return fmt::format("{}: {:.4g} to {:.4g}{}", p.name, t.below, t.above, remarks.empty() ? "" : "; " + remarks);
}

// For each point with a threshold the runs below and above it, where they are in the directory.
std::vector<StatePicture> ThresholdSearch::states() const {
  std::vector<StatePicture> all;
  std::vector<PlateInput> plates;
  for (const SweepPoint& p : points_) {
    const Threshold t = threshold_of(dir_, sweep_, p, {});
    if (t.outside) continue;
    for (const double value : {t.below, t.above}) {
      const auto trial =
          std::find_if(t.trials.begin(), t.trials.end(), [&](const Trial& x) { return x.value == value; });
      const RunDirectory run = trial_directory(dir_, sweep_, p, value);
      if (trial == t.trials.end() || !fs::exists(run.frames())) continue;
      const double last = read_log(run.log()).back()["time_ps"];
      PlateOptions options;
      options.at = {last};
      options.width = 520;  // letters can be read on a phone
      options.highest = 140;
      plates.push_back(plate_of(run, options));
      all.push_back(
          {fmt::format("{}, {:g}: {}, after {:.4g} ps", p.name, value,
                       trial->shape.empty() ? (trial->passed ? "passed" : "did not pass") : trial->shape, last),
           ""});
    }
  }
  // One scale of colours for all.
  double least = 0, most = 0;
  for (const PlateInput& plate : plates)
    least = std::min(least, plate.camera.least), most = std::max(most, plate.camera.most);
  for (std::size_t k = 0; k < plates.size(); ++k) {
    if (plates[k].camera.coloured()) plates[k].camera.least = least, plates[k].camera.most = most;
    all[k].svg = plate_svg(plates[k]);
  }
  return all;
}

// The tables and the page of what is known so far.
void ThresholdSearch::write(bool with_pictures) const {
  const std::vector<PhasePoint> points = phase_points(dir_, sweep_, points_, known_);
  write_file_atomically(dir_.path + "/thresholds.csv", thresholds_csv(sweep_, points));
  write_file_atomically(dir_.trials(), trials_csv(sweep_, points));
  write_file_atomically(dir_.path + "/thresholds.html",
                        phase_page(sweep_, points, with_pictures ? states() : std::vector<StatePicture>()));
}

}  // namespace ropewalk
