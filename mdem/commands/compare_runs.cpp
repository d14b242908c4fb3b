// `compare` for runs and campaigns: their logs in one figure, their last states side by side.
#include <fmt/format.h>

#include <algorithm>

#include "campaign/run_groups.hpp"
#include "commands/commands.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "report/runs_page.hpp"

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

}  // namespace

int compare_runs(const CompareArguments& a) {
  RunsFigure figure;
  figure.x = !a.x.empty() ? a.x : a.tensile ? "beta_deg" : "time_ps";
  figure.y = a.y;
  figure.y_decades = a.log;
  for (const std::string& level : a.levels) figure.levels.push_back(level_of(level));
  column_of_log(figure.x, {"", 0, "--x"});
  for (const std::string& column : a.y) column_of_log(column, {"", 0, "--y"});
  if (a.tensile && !(a.y.empty() && a.levels.empty() && !a.log))
    throw InputError({"", 0, "--tensile"}, "draws strength alone", "leave out --y, --level and --log");
  const bool page = a.svg.empty() && a.csv.empty();
  const std::string html = a.page.empty() ? "compare.html" : a.page;
  if (page) refuse_existing(html, "--page", a.force);
  if (!a.svg.empty()) refuse_existing(a.svg, "--svg", a.force);
  if (!a.csv.empty()) refuse_existing(a.csv, "--csv", a.force);
  std::vector<RunGroup> groups;
  std::string lines;
  for (const std::string& path : a.names) {
    for (RunGroup& group : groups_in(path)) groups.push_back(std::move(group));
    if (lines.empty()) lines = line_keys_in(path);
  }
  const auto write = [](const std::string& path, const std::string& text) {
    write_file_atomically(path, text);
    fmt::print("{} written\n", path);
  };
  std::vector<TensileGroup> tests;
  if (a.tensile)
    for (const RunGroup& group : groups) tests.push_back(tensile_of(group));
  std::vector<RunCurve> curves;
  if (page || !a.tensile)
    for (const RunGroup& group : groups) curves.push_back(curve_of(group, page && groups.size() <= most_pictured));
  if (!a.svg.empty()) {
    const std::string svg = a.tensile ? tensile_svg(tests, figure.x) : runs_svg(curves, figure);
    if (svg.empty())
      throw InputError({"", 0, a.tensile ? "--x" : "--y"}, "has no two values to draw",
                       "choose another column or more of the runs");
    write(a.svg, svg);
  }
  if (!a.csv.empty()) write(a.csv, a.tensile ? tensile_csv(tests, figure.x) : runs_csv(curves, figure));
  if (!page) return 0;
  const std::string title =
      a.names.size() == 1 ? last_part_of(a.names.front()) : fmt::format("{} runs", curves.size());
  Figures figures;
  std::string first;
  if (a.tensile) {
    first = tensile_part(tests, figure.x, lines, figures);
    figure.x = "ends_strain";
    figure.y = {"stress_GPa"};
    for (const char* column : {"links_broken", "bonds_broken"})
      if (std::any_of(curves.begin(), curves.end(), [&](const RunCurve& c) { return c.log.back()[column] > 0; }))
        figure.y.push_back(column);
  }
  write(html, runs_page(title, curves, figure, figures, first));
  return 0;
}

}  // namespace ropewalk
