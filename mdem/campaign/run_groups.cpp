#include "campaign/run_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "io/numeric_errors.hpp"
#include "model/error.hpp"
#include "report/tensile.hpp"
#include "report/torsion.hpp"
#include "run/events_file.hpp"
#include "run/pages/run_views.hpp"
#include "run/results.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

// The runs of a campaign; those that differ in their seed alone are one group.
std::vector<RunGroup> groups_of(const CampaignDirectory& dir) {
  const Sweep sweep = read_campaign(dir);
  std::vector<std::string> keys = sweep.keys();  // keys in the order of the values of replicates
  keys.erase(std::remove(keys.begin(), keys.end(), "start.seed"), keys.end());
  const auto first = std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return sweep.varies(key); });
  std::vector<RunGroup> groups;
  for (const Replicates& r : replicates_of(sweep, points_of(sweep, PointsAs::scenes))) {
    RunGroup group{r.name, {}, {}, {}};
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (!sweep.varies(keys[k]) || keys[k] == *first) continue;
      const char* comma = group.line.empty() ? "" : ", ";
      group.line_keys += comma + leaf_of(keys[k]);
      group.line += comma + r.values[k];
    }
    for (const SweepPoint& p : r.points)
      if (fs::exists(dir.point(p.name).log())) group.runs.push_back(dir.point(p.name));
    if (!group.runs.empty()) groups.push_back(std::move(group));
  }
  if (groups.empty()) throw InputError({dir.path, 0, ""}, "has no run yet", "run `ropewalk sweep`");
  return groups;
}

// The limits of the run that passed one first.
std::vector<LimitRecord> earliest_limits(const std::vector<RunDirectory>& runs) {
  std::vector<LimitRecord> earliest;
  for (const RunDirectory& run : runs) {
    std::vector<LimitRecord> limits = limits_of(run);
    const LimitRecord *one = first_limit(limits), *other = first_limit(earliest);
    if (one && (!other || one->passed_at_ps < other->passed_at_ps)) earliest = std::move(limits);
  }
  return earliest;
}

std::string remark_of(const std::vector<RunDirectory>& runs) {
  if (runs.size() == 1) return status_words(progress_of(runs.front()).status, limits_of(runs.front()));
  std::map<std::string, int> counts;
  std::string text;
  for (const RunDirectory& run : runs) ++counts[progress_of(run).status];
  for (const auto& [status, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, status);
  const auto beyond = std::count_if(runs.begin(), runs.end(),
                                    [](const RunDirectory& run) { return !beyond_words(limits_of(run)).empty(); });
  if (beyond > 0) text += fmt::format("; {} of them {}", beyond, beyond_words(earliest_limits(runs)));
  return text;
}

}  // namespace

std::string last_part_of(const std::string& path) {
  const fs::path p(path);
  return (p.has_filename() ? p : p.parent_path()).filename().string();
}

std::vector<RunGroup> groups_in(const std::string& path) {
  if (!fs::is_directory(path))
    throw InputError({path, 0, ""}, "is not the directory of a run", "name runs or campaigns alone, or sets alone");
  const CampaignDirectory campaign{path};
  if (fs::exists(campaign.sweep())) return groups_of(campaign);
  return {{last_part_of(path), {}, {}, {RunDirectory{path}}}};
}

RunCurve curve_of(const RunGroup& group, bool pictured, double mean_ps) {
  std::vector<std::vector<LogRow>> logs;
  for (const RunDirectory& run : group.runs) {
    refuse_strange_files(run);
    std::vector<LogRow> log = read_log(run.log());
    if (!log.empty()) logs.push_back(std::move(log));
  }
  if (logs.empty()) throw InputError({group.runs.front().log(), 0, ""}, "has no rows", "run the scene further");
  RunCurve curve = mean_of(group.name, logs);
  if (mean_ps > 0) {
    refuse_mean_over(mean_ps, logs, group.runs.front().log());
    curve.means = means_of(logs, mean_ps);
  }
  if (group.runs.size() == 1) curve.error = rows_of_errors(group.runs.front().path, curve.log);
  if (curve.log.empty())
    throw InputError({group.runs.front().log(), 0, ""}, "has no row at the same time as the others of its kind",
                     "compare runs of one log interval");
  curve.remark = remark_of(group.runs) + (curve.remark.empty() ? "" : "; " + curve.remark);
  curve.limits = earliest_limits(group.runs);
  if (!pictured) return curve;
  const RunDirectory& first = group.runs.front();
  Scene scene = read_run_scene(first);
  const Prepared prepared = prepare(scene);
  curve.tube_radius = prepared.topology.largest_radius();
  curve.view = last_view(first, scene, prepared);
  return curve;
}

namespace {

template <class Test>
LoadTestGroup tests_of(const RunGroup& group, const LoadTestKind& kind, const char* remedy, const Test& test) {
  LoadTestGroup out{group.name, group.line, {}};
  for (const RunDirectory& run : group.runs) {
    refuse_strange_files(run);
    try {
      out.tests.push_back(test(run));
      out.tests.back().limits = limits_of(run);
    } catch (const std::invalid_argument& e) {
      throw InputError({run.log(), 0, ""}, e.what(), remedy);
    }
  }
  if (group.runs.size() > 1) return out;
  // A run that is repeated for the errors may have no such test.
  const RepeatedValues values(group.runs.front(), [&](const RunDirectory& run) {
    try {
      return test(run).values;
    } catch (const std::invalid_argument&) {
      return std::vector<double>(kind.columns.size(), RunResults::none);
    }
  });
  for (const WholeError& e : errors_of(group.runs.front(), kind.columns, values))
    out.tests.front().errors.push_back(e.total());
  return out;
}

}  // namespace

LoadTestGroup tensile_of(const RunGroup& group) {
  return tests_of(group, tensile_kind(), "compare runs that pull a rope, see ends_strain and stress_GPa",
                  [](const RunDirectory& run) {
                    return load_test(tensile_test(read_log(run.log()), heights_of_breaks(run.events())));
                  });
}

LoadTestGroup torsion_of(const RunGroup& group) {
  return tests_of(group, torsion_kind(), "compare runs that twist a rope, see rotation_deg and torque_nN_nm",
                  [](const RunDirectory& run) { return torsion_test(read_log(run.log()), results_of(run)); });
}

}  // namespace ropewalk
