// `compare`: the logs of runs and campaigns in one figure, their last states side by side; or parameter sets.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "campaign/campaign.hpp"
#include "campaign/run_groups.hpp"
#include "commands/compare_sets.hpp"
#include "commands/verb.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "report/runs_page.hpp"
#include "report/tensile.hpp"
#include "report/torsion.hpp"

namespace ropewalk {
namespace {

struct CompareArguments {
  std::vector<std::string> names;  // of parameter sets, or of directories: runs and campaigns
  std::string page;                // HTML; empty: none for sets, compare.html for runs
  bool json = false;
  bool force = false;
  // For runs.
  std::string x;                    // empty: time_ps; with --tensile beta_deg, with --torsion rotation_deg
  std::vector<std::string> y;       // empty: the usual columns
  std::vector<std::string> levels;  // "0.45:measured"
  bool log = false;
  double mean_ps = 0;           // the table has means over the last so much time; 0: the last rows
  bool tensile = false;         // strength, toughness and so on of runs that pull a rope
  bool torsion = false;         // the largest torque and what came with it, of runs that twist a rope
  double yarn_diameter_um = 0;  // with --tensile, turns per metre of such a yarn; 0: none
  std::string svg, csv;         // write these files instead of a page
};

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
  if (svg.empty()) throw InputError({"", 0, of}, "has no two values to draw", "name another column, or more runs");
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

int compare_command(const CompareArguments& a) {
  const auto is_directory = [](const std::string& name) { return std::filesystem::is_directory(name); };
  return std::any_of(a.names.begin(), a.names.end(), is_directory) ? compare_runs(a)
                                                                   : compare_sets(a.names, a.page, a.json, a.force);
}

}  // namespace

void add_compare(CLI::App& app, Program& program) {
  const auto a = std::make_shared<CompareArguments>();
  CLI::App* c = app.add_subcommand("compare", "Side by side: runs and campaigns, or parameter sets");
  c->add_option("names", a->names,
                "Directories of runs and campaigns; or parameter sets: files, or names of shipped ones")
      ->required();
  c->add_option("--page", a->page, "Page with all curves (HTML) [default: compare.html for runs, none for sets]");
  c->add_option("--x", a->x,
                "Runs: column of log.csv on the horizontal axis [default: time_ps; with --tensile beta_deg, with "
                "--torsion rotation_deg]");
  c->add_option("--y", a->y,
                "Runs: columns, a chart each, such as torque_nN_nm, the mean of both ends [default: the usual ones "
                "that vary]")
      ->delimiter(',');
  c->add_option("--level", a->levels, "Runs: a value to compare with, as 0.45:NAME");
  c->add_option(
       "--mean", a->mean_ps,
       "Runs: the table, and --csv, have means over the last so many ps, each with its error and correlation time")
      ->check(number_within(Bounds::positive()));
  c->add_flag(
      "--tensile", a->tensile,
      "Runs that pull a rope: strength, modulus, toughness and breaks, against the value of --x before the pull");
  c->add_flag("--torsion", a->torsion,
              "Runs that twist a rope: largest torque, its angle, first break and stored energy, against the value "
              "of --x at that torque")
      ->excludes("--tensile");
  c->add_option("--yarn-diameter-um", a->yarn_diameter_um,
                "With --tensile: add turns per metre, of a yarn of this diameter with the twist angle of each run")
      ->check(number_within(Bounds::positive()))
      ->needs("--tensile");
  c->add_flag("--log", a->log, "Runs: logarithmic vertical axis");
  c->add_option("--svg", a->svg, "Runs: write the chart of the first column to this file instead");
  c->add_option("--csv", a->csv, "Runs: write the curves, and their standard errors, to this file instead");
  c->add_flag("--json", a->json, "Sets: JSON");
  c->add_flag("--force", a->force, "Replace existing files");
  c->callback([a, &program] { program.code = compare_command(*a); });
}

}  // namespace ropewalk
