// `compare` for runs and campaigns: their logs in one figure, their last states side by side.
#include <fmt/format.h>

#include <algorithm>

#include "campaign/campaign.hpp"
#include "campaign/run_groups.hpp"
#include "commands/commands.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "report/runs_page.hpp"
#include "report/tensile.hpp"
#include "report/torsion.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t most_pictured = 12;

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

void write(const std::string& path, const std::string& text) {
  write_file_atomically(path, text);
  fmt::print("{} written\n", path);
}

std::vector<RunCurve> curves_of(const std::vector<RunGroup>& groups, bool pictured, double mean_ps) {
  std::vector<RunCurve> curves;
  for (const RunGroup& group : groups)
    curves.push_back(curve_of(group, pictured && groups.size() <= most_pictured, mean_ps));
  return curves;
}

// The chart of a --svg; `of`: the option that chose what is drawn.
std::string drawn(const std::string& svg, const char* of) {
  if (svg.empty())
    throw InputError({"", 0, of}, "has no two values to draw", "name another column, or more runs");
  return svg;
}

struct Wanted {
  std::string page, title;  // page: HTML; empty: the files of --svg and --csv instead
};

// The groups without runs that have failed or still go on: the largest stress of such a run is not its strength.
std::vector<RunGroup> ended_ones(std::vector<RunGroup> groups, const std::string& where) {
  std::size_t all = 0, left = 0;
  for (RunGroup& group : groups) {
    all += group.runs.size();
    const auto goes_on = [](const RunDirectory& run) {
      return progress_of(run).stage != PointProgress::Stage::ended;
    };
    group.runs.erase(std::remove_if(group.runs.begin(), group.runs.end(), goes_on), group.runs.end());
    left += group.runs.size();
  }
  groups.erase(std::remove_if(groups.begin(), groups.end(), [](const RunGroup& g) { return g.runs.empty(); }),
               groups.end());
  if (groups.empty())
    throw InputError({where, 0, ""}, "has no run that has ended",
                     "go on with `ropewalk sweep` or `ropewalk resume`");
  if (left < all)
    fmt::print(stderr, "note: {} of {} runs have not come to their end and are left out.\n", all - left, all);
  return groups;
}

void compare_tests(const CompareArguments& a, const Wanted& wanted, const std::vector<RunGroup>& with_others) {
  if (!a.y.empty() || a.log || a.mean_ps > 0)
    throw InputError({"", 0, a.torsion ? "--torsion" : "--tensile"},
                     a.torsion ? "draws the largest torque alone" : "draws strength alone",
                     "leave out --y, --log and --mean");
  LoadTestKind kind = a.torsion ? torsion_kind() : tensile_kind();
  for (const std::string& text : a.levels) {
    const ReferenceLevel level = level_of(text);
    kind.levels.emplace_back(level.value, level.name);
  }
  kind.yarn_diameter = 1e3 * a.yarn_diameter_um;
  const std::string x = !a.x.empty() ? a.x : a.torsion ? "rotation_deg" : "beta_deg";
  column_of_log(x, {"", 0, "--x"});
  const std::vector<RunGroup> groups = ended_ones(with_others, a.names.front());
  std::vector<LoadTestGroup> tests;
  for (const RunGroup& group : groups) tests.push_back(a.torsion ? torsion_of(group) : tensile_of(group));
  RunsFigure figure;
  figure.x = a.torsion ? "rotation_deg" : "ends_strain";
  figure.y = {a.torsion ? "torque_nN_nm" : "stress_GPa"};
  if (!a.svg.empty() && tests.size() > 1) write(a.svg, drawn(load_tests_svg(kind, tests, x), "--x"));
  if (!a.svg.empty() && tests.size() == 1) {
    RunsFigure curve = figure;
    if (!a.x.empty()) curve.x = a.x;
    for (const std::string& level : a.levels) curve.levels.push_back(level_of(level));
    write(a.svg, drawn(runs_svg(curves_of(groups, false, 0), curve), "--x"));
    fmt::print("one point, so {} shows its {} against {}\n", a.svg, curve.y.front(), curve.x);
  }
  if (!a.csv.empty()) write(a.csv, load_tests_csv(kind, tests, x));
  if (wanted.page.empty()) return;
  const std::vector<RunCurve> curves = curves_of(groups, true, 0);
  for (const char* column : {"links_broken", "bonds_broken"})
    if (std::any_of(curves.begin(), curves.end(), [&](const RunCurve& c) { return c.log.back()[column] > 0; }))
      figure.y.push_back(column);
  Figures figures;
  const std::string part = load_tests_part(kind, tests, x, groups.front().line_keys, figures);
  write(wanted.page, runs_page(wanted.title, curves, figure, figures, part));
}

void compare_curves(const CompareArguments& a, const Wanted& wanted, const std::vector<RunGroup>& groups) {
  RunsFigure figure;
  if (!a.x.empty()) figure.x = a.x;
  figure.y = a.y;
  figure.y_decades = a.log;
  for (const std::string& level : a.levels) figure.levels.push_back(level_of(level));
  const std::vector<RunCurve> curves = curves_of(groups, !wanted.page.empty(), a.mean_ps);
  if (!a.svg.empty()) write(a.svg, drawn(runs_svg(curves, figure), "--y"));
  if (!a.csv.empty()) write(a.csv, runs_csv(curves, figure));
  if (!wanted.page.empty()) write(wanted.page, runs_page(wanted.title, curves, figure));
}

}  // namespace

int compare_runs(const CompareArguments& a) {
  if (!a.x.empty()) curve_column(a.x, {}, {"", 0, "--x"});
  for (const std::string& column : a.y) curve_column(column, {}, {"", 0, "--y"});
  Wanted wanted;
  if (a.svg.empty() && a.csv.empty()) wanted.page = a.page.empty() ? "compare.html" : a.page;
  for (const auto& [file, option] :
       {std::pair(wanted.page, "--page"), std::pair(a.svg, "--svg"), std::pair(a.csv, "--csv")})
    if (!file.empty()) refuse_existing(file, option, a.force);
  std::vector<RunGroup> groups;
  for (const std::string& path : a.names)
    for (RunGroup& group : groups_in(path)) groups.push_back(std::move(group));
  wanted.title = a.names.size() == 1 ? last_part_of(a.names.front()) : fmt::format("{} runs", groups.size());
  (a.tensile || a.torsion ? compare_tests : compare_curves)(a, wanted, groups);
  return 0;
}

}  // namespace ropewalk
