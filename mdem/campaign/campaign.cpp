#include "campaign/campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "io/log.hpp"
#include "io/log_mean.hpp"
#include "io/plain_text.hpp"
#include "io/toml_text.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "report/runs_page.hpp"
#include "run/events_file.hpp"
#include "run/limit_watch.hpp"
#include "run/results.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

std::string without_quotes(const std::string& value) {
  const bool quoted =
      value.size() > 1 && value.front() == value.back() && (value.front() == '"' || value.front() == '\'');
  return quoted ? value.substr(1, value.size() - 2) : value;
}

std::vector<std::size_t> columns_of(const GatherOptions& options) {
  std::vector<std::size_t> out;
  for (const std::string& name : options.columns) out.push_back(column_of_log(name, {"", 0, "--columns"}));
  for (std::size_t k = 0; options.columns.empty() && k < observables().size(); ++k) out.push_back(k);
  return out;
}

// Counts and times are not averaged.
bool has_mean(std::size_t column) {
  return !observables()[column].whole && observables()[column].name != std::string("time_ps");
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string("nan"); }

std::string cells_of(const LogRow& row, const std::vector<std::size_t>& columns) {
  std::string text;
  for (const std::size_t k : columns) text += "," + number(row.values()[k]);
  return text;
}

// Means over the last rows, each with its error and its correlation time.
std::string mean_cells(const std::vector<LogRow>& log, double mean_ps, const std::vector<std::size_t>& columns,
                       const std::string& point, std::vector<std::string>* short_of) {
  constexpr int most_names = 5;
  std::string text, names;
  int without = 0;
  double needed = 0;  // ps
  const std::size_t rows = rows_of_last(mean_ps, log);
  for (const std::size_t k : columns) {
    if (!has_mean(k)) {
      text += "," + number(log.back().values()[k]);
      continue;
    }
    const LogMean mean = mean_of_last(rows, log, [k](const LogRow& row) { return row.values()[k]; });
    text += "," + number(mean.value) + "," + number(mean.error) + "," + number(mean.correlation_ps);
    if (!std::isfinite(mean.value) || std::isfinite(mean.error)) continue;
    if (++without <= most_names) names += fmt::format("{}{}", names.empty() ? "" : ", ", observables()[k].name);
    needed = std::max(needed, mean.needed_ps);
  }
  if (without > most_names) names += fmt::format(" and {} more columns", without - most_names);
  if (short_of && without > 0)
    short_of->push_back(fmt::format("{}: {:.3g} ps are too short for an error of {}{}", point, mean_ps, names,
                                    needed > 0 ? fmt::format("; about {:.2g} ps would do", needed) : ""));
  return text;
}

// Whether the scene has an [[expect]] table for all points of a sweep. A table for a single scene is none.
bool expects_something(const Sweep& sweep) {
  const toml::table scene = parsed_toml(sweep.scene_text, sweep.scene_path);
  const toml::array* expected = scene["expect"].as_array();
  return expected && std::any_of(expected->begin(), expected->end(),
                                 [](const toml::node& one) { return !one.as_table()->contains("scene_hash"); });
}

// Killed before its sweep.toml was written.
bool was_just_begun(const CampaignDirectory& dir) {
  if (!fs::is_directory(dir.path)) return false;
  for (const auto& entry : fs::directory_iterator(dir.path)) {
    const std::string name = entry.path().filename().string();
    if (name != "points" && name != "messages" && !is_lock_file(name) && without_part(name).empty()) return false;
  }
  return true;
}

}  // namespace

RunDirectory CampaignDirectory::run_in(const std::string& folder, const std::string& name) const {
  const std::string parent = path + "/" + folder;
  for (const std::string& place : {parent, parent + "/" + name}) refuse_strange(place, true);
  return {parent + "/" + name};
}

PointProgress progress_of(const RunDirectory& dir) {
  using Stage = PointProgress::Stage;
  PointProgress p;
  p.status = "waiting";
  refuse_strange_files(dir);
  if (!fs::exists(dir.manifest())) {
    if (has_checkpoint(dir)) p.stage = Stage::begun, p.status = "interrupted";
    return p;
  }
  const Manifest m = read_manifest(dir.manifest());
  p.status = m.status;
  p.reason = m.reason;
  p.wall_seconds = m.wall_seconds;
  if (m.status == "failed")
    p.stage = Stage::failed;
  else if (m.status == "running" || m.status == "interrupted")
    p.stage = has_checkpoint(dir) ? Stage::begun : Stage::waiting;
  else
    p.stage = Stage::ended;
  if (p.stage == Stage::begun) p.status = holder_of(dir.path).empty() ? "interrupted" : "running";
  return p;
}

std::vector<Judgement> judged(const RunDirectory& dir) {
  if (progress_of(dir).status != "finished" || read_file(dir.scene()).find("expect") == std::string::npos)
    return {};
  return judge(read_run_scene(dir).expected, dir);
}

CampaignDirectory campaign_directory(const std::string& sweep_file, const std::string& out) {
  return {out.empty() ? (fs::path(sweep_file).parent_path() / fs::path(sweep_file).stem()).string() : out};
}

bool is_run_of(const RunDirectory& dir, const std::string& text, const SweepPoint& point, bool any_step) {
  const auto comparable = [&](const std::string& scene) {
    return any_step ? with_value(scene, "run.time_step_fs", "0", dir.scene()) : scene;
  };
  if (comparable(read_file(dir.scene())) != comparable(text)) return false;
  const auto copied = [](const std::string& copy, const std::string& file) {
    return fs::exists(copy) && read_file(copy) == read_file(file);
  };
  for (std::size_t k = 0; k < point.sets.size(); ++k)
    if (!copied(dir.parameters(k), point.sets[k])) return false;
  for (std::size_t k = 0; k < point.files.size(); ++k)
    if (!copied(dir.friction(k), point.files[k])) return false;
  return point.state.empty() || copied(dir.state(), point.state);
}

namespace {

InputError other_run(const RunDirectory& run, bool other_time) {
  return InputError({run.path, 0, "--out"},
                    other_time ? "left its shared start at another time, branch.at_ps"
                               : "was run with another scene, parameter set or state file",
                    "choose another --out, or give --force to run this point anew");
}

}  // namespace

DirectoryLock create_campaign(const CampaignDirectory& dir, const Sweep& sweep,
                              const std::vector<SweepPoint>& points, bool force) {
  if (fs::exists(dir.path) && !fs::exists(dir.sweep()) && !was_just_begun(dir))
    throw InputError({dir.path, 0, "--out"}, "is not the directory of a campaign (no sweep.toml in it)",
                     "choose another name");
  for (const char* sub : {"points", "messages", "starts"}) refuse_strange(dir.path + "/" + sub, true);
  std::error_code error;
  for (const char* sub : {"points", "messages"}) fs::create_directories(dir.path + "/" + sub, error);
  if (error)
    throw InputError({dir.path, 0, "--out"}, fmt::format("cannot be made: {}", error.message()),
                     "choose a place that you may write to");
  DirectoryLock lock(dir.path, force ? DirectoryLock::Kind::alone : DirectoryLock::Kind::together);
  // The scenes of the points do not tell when they left their shared start.
  const bool other_start = !sweep.branch_axes.empty() && fs::exists(dir.sweep()) && fs::exists(dir.scene()) &&
                           read_campaign(dir).branch_at != sweep.branch_at;
  for (const SweepPoint& p : points) {
    const RunDirectory run = dir.point(p.name);
    if (!fs::exists(run.scene()) || progress_of(run).stage == PointProgress::Stage::waiting) continue;
    // A point that goes on from a shared start has the time step of that start.
    const bool same = is_run_of(run, p.text, p, !p.start.empty());
    if (same && !other_start) continue;
    if (!force) throw other_run(run, same);
    remove_run(run, "--force");
  }
  for (const SweepPoint& p : starts_of(sweep, points)) {
    const RunDirectory run = dir.start(p.name);
    if (!fs::exists(run.scene()) || progress_of(run).stage == PointProgress::Stage::waiting) continue;
    if (!other_start && is_run_of(run, p.text, p)) continue;
    if (!force) throw other_run(run, other_start);
    remove_run(run, "--force");
  }
  write_file_atomically(dir.sweep(), sweep.text);
  write_file_atomically(dir.scene(), sweep.scene_text);
  return lock;
}

Sweep read_campaign(const CampaignDirectory& dir) {
  for (const std::string& file : {dir.sweep(), dir.scene()}) refuse_strange(file);
  if (!fs::exists(dir.sweep()))
    throw InputError({dir.path, 0, ""}, "is not the directory of a campaign (no sweep.toml in it)",
                     "name the directory that `ropewalk sweep` made");
  return sweep_of_text(read_file(dir.sweep()), dir.sweep(), dir.scene());
}

std::string gathered_csv(const CampaignDirectory& dir, const Sweep& sweep, const std::vector<SweepPoint>& points,
                         const GatherOptions& options) {
  const std::vector<std::size_t> columns = columns_of(options);
  std::string text = "point";
  for (const std::string& key : sweep.keys()) text += "," + csv_cell(key);
  text += ",status," + column_names(limit_columns());
  const bool means = options.mean_ps > 0 && !options.series;
  std::size_t cells = 0;
  for (const std::size_t k : columns) {
    text += fmt::format(",{}", observables()[k].name);
    if (means && has_mean(k))
      text += fmt::format(",{0}_error,{0}_correlation_ps", observables()[k].name), cells += 2;
    ++cells;
  }
  const bool with_results = options.columns.empty() && !options.series;
  if (with_results) text += "," + column_names(result_columns());
  const bool expects = with_results && expects_something(sweep);
  if (expects) text += ",expected,missed";
  text += options.series ? "\n" : ",limits_passed\n";
  for (const SweepPoint& p : points) {
    const RunDirectory run = dir.point(p.name);
    std::string begin = csv_cell(p.name);
    for (const std::string& value : p.values) begin += "," + csv_cell(without_quotes(value));
    const std::vector<LimitRecord> limits = limits_of(run);
    begin += "," + progress_of(run).status + "," + limit_cells(limits);
    const std::vector<LogRow> log = fs::exists(run.log()) ? read_log(run.log()) : std::vector<LogRow>();
    if (options.series) {
      for (const LogRow& row : log) text += begin + cells_of(row, columns) + "\n";
      continue;
    }
    if (options.mean_ps > 0 && stands_still(log))
      throw InputError({run.log(), 0, "--mean"},
                       "is the log of a relaxation: its rows are steps, which have no mean over time",
                       "leave --mean out, and the table has their ends");
    text += begin;
    if (log.empty())
      text += std::string(cells, ',');
    else
      text += means ? mean_cells(log, options.mean_ps, columns, p.name, options.short_of)
                    : cells_of(log.back(), columns);
    if (with_results)
      text += "," + (log.empty() ? std::string(result_columns().size() - 1, ',')
                                 : result_cells(run_results(log, limits, tube_breaks(run.events()))));
    if (expects) {
      const std::vector<Judgement> all = judged(run);
      text += all.empty() ? std::string(",,") : fmt::format(",{},{}", all.size(), missed(all));
    }
    text += "," + csv_cell(passed_words(limits)) + "\n";
  }
  return text;
}

namespace {

// A script for a cluster names absolute paths, since a task of a job array may start in another folder.
std::string absolute_quoted(const std::string& path) {
  return shell_quoted(fs::absolute(path).lexically_normal().string());
}

// A string of Python; all that JSON escapes, Python does alike.
std::string python_string(const std::string& text) { return nlohmann::json(text).dump(); }

}  // namespace

// Each task of SLURM's array runs every so manieth point: by default SLURM knows no task above 1000 (MaxArraySize).
std::string slurm_script(const std::string& program, const std::string& verb, const std::string& sweep_file,
                         const CampaignDirectory& dir, std::size_t points, const std::string& options) {
  constexpr std::size_t most_tasks = 1000;
  const std::size_t each = (points + most_tasks - 1) / most_tasks, tasks = (points + each - 1) / each;
  const std::string messages = absolute_quoted(dir.path + "/messages");
  return fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=ropewalk\n"
      "#SBATCH --array=1-{}\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=1\n"
      "#SBATCH --output=/dev/null\n"
      "# Add --time, --partition and --account as your cluster asks. Submitted again, it goes on where points "
      "stopped.\n"
      "mkdir -p {} || exit\n"
      "exec >> {}/slurm-\"$SLURM_ARRAY_TASK_ID\".txt 2>&1\n"
      "exec {} {} {} --out {} --only {} --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\" --quiet{}\n",
      tasks, messages, messages, shell_quoted(program), verb, absolute_quoted(sweep_file),
      absolute_quoted(dir.path),
      each == 1 ? std::string("\"$SLURM_ARRAY_TASK_ID\"")
                : fmt::format("\"$(seq -s , \"$SLURM_ARRAY_TASK_ID\" {} {})\"", tasks, points),
      options);
}

std::string snakemake_file(const std::string& program, const std::string& verb, const std::string& sweep_file,
                           const CampaignDirectory& dir, const std::vector<SweepPoint>& points,
                           const std::string& options) {
  for (const std::string& path : {program, dir.path, sweep_file})
    if (path.find_first_of("{}") != std::string::npos)
      throw InputError({path, 0, "--snakemake"}, "holds one of {}, which Snakemake reads as its own",
                       "choose a path without");
  std::string names;
  for (const SweepPoint& p : points) names += fmt::format("    {},\n", python_string(p.name));
  // What a point leaves when it has ended, what is made of all of them, and how.
  const bool runs = verb == "sweep";
  const std::string ends = python_string(dir.path + "/points/{point}/" + (runs ? "report.html" : "threshold.csv")),
                    table = runs ? dir.table() : dir.path + "/thresholds.html",
                    gather = runs ? fmt::format("{} gather {} -o {} --force", shell_quoted(program),
                                                shell_quoted(dir.path), shell_quoted(table))
                                  : fmt::format("{} threshold {} --out {} --quiet{}", shell_quoted(program),
                                                shell_quoted(sweep_file), shell_quoted(dir.path), options);
  return fmt::format(
      "POINTS = [\n{}]\n\n"
      "rule table:\n"
      "    input: expand({}, point=POINTS)\n"
      "    output: {}\n"
      "    shell: {}\n\n"
      "rule point:\n"
      "    input: {}\n"
      "    output: {}\n"
      "    shell: {}\n",
      names, ends, python_string(table), python_string(gather), python_string(sweep_file), ends,
      python_string(fmt::format("{} {} {} --out {} --only {{wildcards.point}} --quiet{}", shell_quoted(program),
                                verb, shell_quoted(sweep_file), shell_quoted(dir.path), options)));
}

}  // namespace ropewalk
