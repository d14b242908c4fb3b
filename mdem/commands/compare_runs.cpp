// `compare` for runs and campaigns: their logs in one figure, their last states side by side.
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "campaign/campaign.hpp"
#include "commands/commands.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "report/runs_page.hpp"
#include "run/pages/run_views.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_pictured = 12;

struct Group {
  std::string name;
  std::vector<RunDirectory> runs;
};

std::string short_of(const std::string& path) {
  const fs::path p(path);
  return (p.has_filename() ? p : p.parent_path()).filename().string();
}

// The runs of a campaign; those that differ in their seed alone are one group.
std::vector<Group> groups_of(const CampaignDirectory& dir) {
  const Sweep sweep = read_campaign(dir);
  std::vector<Group> groups;
  for (const Replicates& r : replicates_of(sweep, points_of(sweep, false))) {
    Group group{r.name, {}};
    for (const SweepPoint& p : r.points)
      if (fs::exists(dir.point(p.name).log())) group.runs.push_back(dir.point(p.name));
    if (!group.runs.empty()) groups.push_back(std::move(group));
  }
  if (groups.empty()) throw InputError({dir.path, 0, ""}, "has no run yet", "run `ropewalk sweep`");
  return groups;
}

std::string remark_of(const std::vector<RunDirectory>& runs) {
  std::map<std::string, int> counts;
  std::string text;
  for (const RunDirectory& run : runs) ++counts[progress_of(run).status];
  for (const auto& [status, count] : counts)
    text += (text.empty() ? "" : ", ") + (runs.size() > 1 ? fmt::format("{} {}", count, status) : status);
  return text;
}

RunCurve curve_of(const Group& group, bool pictured) {
  std::vector<std::vector<LogRow>> logs;
  for (const RunDirectory& run : group.runs) {
    std::vector<LogRow> log = read_log(run.log());
    if (!log.empty()) logs.push_back(std::move(log));
  }
  if (logs.empty()) throw InputError({group.runs.front().log(), 0, ""}, "has no rows", "run the scene further");
  RunCurve curve = mean_of(group.name, logs);
  curve.remark = remark_of(group.runs);
  if (!pictured) return curve;
  const RunDirectory& first = group.runs.front();
  Scene scene = read_run_scene(first);
  const Prepared prepared = prepare(scene);
  curve.tube_radius = prepared.topology.largest_radius();
  curve.view = last_view(first, scene, prepared);
  return curve;
}

ReferenceLevel level_of(const std::string& text) {
  const std::size_t at = text.find(':');
  try {
    std::size_t used = 0;
    const double value = std::stod(text.substr(0, at), &used);
    if (used == std::min(at, text.size())) return {value, at == std::string::npos ? text : text.substr(at + 1)};
  } catch (const std::exception&) {
  }
  throw InputError({"", 0, "--level"}, fmt::format("\"{}\" does not begin with a number", text),
                   "write it like 0.45:\"measured\"");
}

}  // namespace

int compare_runs(const CompareArguments& a) {
  RunsFigure figure;
  figure.x = a.x;
  figure.y = a.y;
  figure.y_decades = a.log;
  for (const std::string& level : a.levels) figure.levels.push_back(level_of(level));
  column_of_log(a.x, {"", 0, "--x"});
  for (const std::string& column : a.y) column_of_log(column, {"", 0, "--y"});
  const bool page = a.svg.empty() && a.csv.empty();
  const std::string html = a.page.empty() ? "compare.html" : a.page;
  if (page) refuse_existing(html, "--page", a.force);
  if (!a.svg.empty()) refuse_existing(a.svg, "--svg", a.force);
  if (!a.csv.empty()) refuse_existing(a.csv, "--csv", a.force);
  std::vector<Group> groups;
  for (const std::string& path : a.names) {
    if (!fs::is_directory(path))
      throw InputError({path, 0, ""}, "is not the directory of a run",
                       "name runs or campaigns alone, or sets alone");
    const CampaignDirectory campaign{path};
    if (fs::exists(campaign.sweep()))
      for (Group& group : groups_of(campaign)) groups.push_back(std::move(group));
    else
      groups.push_back({short_of(path), {RunDirectory{path}}});
  }
  const auto write = [](const std::string& path, const std::string& text) {
    write_file_atomically(path, text);
    fmt::print("{} written\n", path);
  };
  std::vector<RunCurve> curves;
  for (const Group& group : groups) curves.push_back(curve_of(group, page && groups.size() <= most_pictured));
  if (!a.svg.empty()) {
    const std::string svg = runs_svg(curves, figure);
    if (svg.empty())
      throw InputError({"", 0, "--y"}, "has no two values to draw", "choose another column or more of the runs");
    write(a.svg, svg);
  }
  if (!a.csv.empty()) write(a.csv, runs_csv(curves, figure));
  if (!page) return 0;
  const std::string title = a.names.size() == 1 ? short_of(a.names.front()) : fmt::format("{} runs", curves.size());
  write(html, runs_page(title, curves, figure));
  return 0;
}

}  // namespace ropewalk
