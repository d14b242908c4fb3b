#include "campaign/sweep_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "campaign/point_runs.hpp"
#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/processes.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_time.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;
using Stage = PointProgress::Stage;

constexpr std::size_t most_timed = 6;  // points whose steps are timed
constexpr double relax_steps = 2000;   // a guess, where a relaxation does not end at once

// The time at this work, by a list that rises in work.
double between(const std::vector<std::pair<double, double>>& timed, double work) {
  const auto above = std::lower_bound(timed.begin(), timed.end(), std::make_pair(work, 0.0));
  if (above == timed.begin()) return above->second * work / above->first;
  const auto below = std::prev(above);
  if (above == timed.end()) return below->second * work / below->first;
  const double part = (work - below->first) / (above->first - below->first);
  return below->second + part * (above->second - below->second);
}

// What branch_off() of a killed process left. Another process is not at it: the point is locked by its messages.
std::vector<std::string> copies_left_of(const RunDirectory& point) {
  const fs::path whole = point.path;
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(whole.parent_path()))
    if (without_part(entry.path().filename().string()) == whole.filename().string() &&
        fs::is_directory(entry.symlink_status()))
      all.push_back(entry.path().string());
  return all;
}

}  // namespace

std::vector<SweepPoint> chosen_points(const std::vector<SweepPoint>& points, const std::vector<std::string>& only) {
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

bool SweepRuns::is_to_run(const SweepPoint& p) const {
  const Stage stage = progress_of(dir_.point(p.name)).stage;
  return stage == Stage::waiting || stage == Stage::begun || (stage == Stage::failed && again_);
}

void SweepRuns::run_starts(const std::function<void(const SweepPoint&)>& failed) const {
  fs::create_directories(dir_.path + "/starts");
  std::vector<ProcessTask> tasks;
  for (const SweepPoint& p : starts_of(sweep_, points_)) {
    const bool needed = std::any_of(points_.begin(), points_.end(), [&](const SweepPoint& q) {
      return q.start == p.name && progress_of(dir_.point(q.name)).stage == Stage::waiting;
    });
    const RunDirectory to = dir_.start(p.name);
    if (!needed || progress_of(to).stage == Stage::ended) continue;
    tasks.push_back({[this, p, to] {
                       return in_a_process(dir_.messages("start-" + p.name), true, [&] {
                         if (progress_of(to).stage == Stage::ended) return 0;
                         return run_or_resume(to, scene_of(sweep_, p), sweep_.branch_at, OnLimit::warn);
                       });
                     },
                     [&failed, p](int status) {
                       if (status != 0) failed(p);
                     }});
  }
  run_processes(tasks, jobs_, &stop_signal);
}

// Copies the shared run and replaces its scene by that of the point. The point keeps the time step of the shared
// run, because the log and the frames count time by steps.
void SweepRuns::branch_off(const SweepPoint& p) const {
  const RunDirectory from = dir_.start(p.start), to = dir_.point(p.name);
  if (progress_of(from).stage != Stage::ended)
    throw InputError({from.path, 0, ""}, "did not reach its end, and this point goes on from there",
                     "see its messages");
  remove_hardly_begun(to);
  for (const std::string& left : copies_left_of(to)) remove_run({left}, "");
  const std::string half = new_draft_folder(to.path);
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
  rename_whole(half, to.path);
}

int SweepRuns::run_point(const SweepPoint& p) const {
  const RunDirectory dir = dir_.point(p.name);
  if (!is_to_run(p)) return 0;  // done by another process meanwhile
  if (progress_of(dir).stage == Stage::failed) remove_run(dir, "--again");
  if (!p.start.empty() && progress_of(dir).stage == Stage::waiting) branch_off(p);
  return run_or_resume(dir, scene_of(sweep_, p), -1, on_limit_);
}

void SweepRuns::run_points(const std::function<void(const SweepPoint&, int)>& ended) const {
  std::vector<ProcessTask> tasks;
  for (const SweepPoint& p : points_)
    if (is_to_run(p))
      tasks.push_back(
          {[this, &p] { return in_a_process(dir_.messages(p.name), false, [&] { return run_point(p); }); },
           [&ended, &p](int status) { ended(p, status); }});
  run_processes(tasks, jobs_, &stop_signal);
}

std::vector<double> seconds_of_points(
    const Sweep& sweep, const std::vector<SweepPoint>& points,
    const std::function<void(const SweepPoint&, const std::exception&)>& untimed) {
  // Some of the points are timed; the time of the others is interpolated by their work.
  std::vector<std::pair<double, double>> timed;  // work, seconds
  const std::size_t n = std::min(points.size(), most_timed);
  for (std::size_t k = 0; k < n; ++k) {
    const SweepPoint& p = points[n > 1 ? k * (points.size() - 1) / (n - 1) : 0];
    try {
      const RunTime t = time_run(p.text, sweep.scene_path);
      timed.emplace_back(p.work, t.steps > 0 ? t.total() : relax_steps * t.each);
    } catch (const std::exception& e) {
      untimed(p, e);
    }
  }
  if (timed.empty()) timed.emplace_back(1, std::numeric_limits<double>::quiet_NaN());
  std::sort(timed.begin(), timed.end());
  std::vector<double> out;
  for (const SweepPoint& p : points) out.push_back(between(timed, p.work));
  return out;
}

}  // namespace ropewalk
