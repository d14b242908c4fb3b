// `compare` for runs and campaigns: their logs in one figure, their last states side by side.
#include <fmt/format.h>

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
  std::vector<RunGroup> groups;
  for (const std::string& path : a.names)
    for (RunGroup& group : groups_in(path)) groups.push_back(std::move(group));
  const auto write = [](const std::string& path, const std::string& text) {
    write_file_atomically(path, text);
    fmt::print("{} written\n", path);
  };
  std::vector<RunCurve> curves;
  for (const RunGroup& group : groups) curves.push_back(curve_of(group, page && groups.size() <= most_pictured));
  if (!a.svg.empty()) {
    const std::string svg = runs_svg(curves, figure);
    if (svg.empty())
      throw InputError({"", 0, "--y"}, "has no two values to draw", "choose another column or more of the runs");
    write(a.svg, svg);
  }
  if (!a.csv.empty()) write(a.csv, runs_csv(curves, figure));
  if (!page) return 0;
  const std::string title =
      a.names.size() == 1 ? last_part_of(a.names.front()) : fmt::format("{} runs", curves.size());
  write(html, runs_page(title, curves, figure));
  return 0;
}

}  // namespace ropewalk
