#include "report/load_tests.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "model/units.hpp"
#include "model/yarn.hpp"
#include "report/log_figures.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

struct Mean {
  double value = NAN, error = NAN;
};

template <class Value>
Mean mean_of(const std::vector<LoadTest>& tests, Value value) {
  double sum = 0, squares = 0;
  int n = 0;
  for (const LoadTest& t : tests)
    if (std::isfinite(value(t))) sum += value(t), ++n;
  if (n == 0) return {};
  const double mean = sum / n;
  for (const LoadTest& t : tests)
    if (std::isfinite(value(t))) squares += std::pow(value(t) - mean, 2);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : NAN};
}

bool has_errors(const LoadTestGroup& group) {
  return group.tests.size() == 1 && !group.tests.front().errors.empty();
}

// The k-th value, with the error of a single run where it is known.
Mean mean_of_value(const LoadTestGroup& group, std::size_t k) {
  Mean mean = mean_of(group.tests, [k](const LoadTest& t) { return t.values[k]; });
  if (has_errors(group)) mean.error = group.tests.front().errors[k];
  return mean;
}

int followed(const LoadTestGroup& group) {
  return static_cast<int>(
      std::count_if(group.tests.begin(), group.tests.end(), [](const LoadTest& t) { return t.to_half; }));
}

Mean mean_at(const LoadTestGroup& group, const std::string& x) {
  return mean_of(group.tests, [&](const LoadTest& t) { return t.at[x]; });
}

// Turns per metre of a yarn whose surface has the twist angle of the group, the mean over its replicates.
Mean turns_per_m(const LoadTestKind& kind, const LoadTestGroup& group) {
  return mean_of(group.tests, [&](const LoadTest& t) {
    return 1e9 * yarn_turns(t.at["beta_deg"] * units::degree, kind.yarn_diameter);
  });
}

// Limits that the replicates of a group passed, one replicate after the other. first_limit() finds the earliest.
std::vector<LimitRecord> all_limits(const LoadTestGroup& group) {
  std::vector<LimitRecord> all;
  for (const LoadTest& t : group.tests) all.insert(all.end(), t.limits.begin(), t.limits.end());
  return all;
}

// Why runs of a group have no first value, each reason once.
std::string why_none(const LoadTestGroup& group) {
  std::vector<std::string> reasons;
  for (const LoadTest& t : group.tests)
    if (!t.why_none.empty() && std::find(reasons.begin(), reasons.end(), t.why_none) == reasons.end())
      reasons.push_back(t.why_none);
  return fmt::format("{}", fmt::join(reasons, "; "));
}

std::string title_of(const LoadTestKind& kind, const std::string& x) {
  std::string title = std::string(kind.drawn) + " against " + column_axis(x).quantity;
  title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
  return title;
}

// The line of the first column over x, and, by the law of yarns, cos^2 of the angle from the first point on.
ScatterChart chart_of(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups, const std::string& x) {
  ScatterChart scatter;
  LineChart& chart = scatter.chart;
  chart.title = title_of(kind, x);
  chart.x = column_axis(x);
  chart.y = {kind.drawn, kind.unit, false};
  chart.y.from_zero = true;
  chart.height = 360;
  for (const LoadTestGroup& g : groups) {
    auto line =
        std::find_if(chart.lines.begin(), chart.lines.end(), [&](const ChartLine& l) { return l.name == g.line; });
    if (line == chart.lines.end()) {
      chart.lines.push_back({g.line, {}, {}, static_cast<int>(chart.lines.size()) % categorical_colours});
      line = chart.lines.end() - 1;
      line->bars = true;
    }
    const Mean at = mean_at(g, x), drawn = mean_of_value(g, 0);
    if (!std::isfinite(drawn.value)) continue;
    line->x.push_back(at.value);
    line->y.push_back(drawn.value);
    line->error.push_back(drawn.error);
  }
  const auto one_seed = [](const LoadTestGroup& g) { return g.tests.size() == 1 && !has_errors(g); };
  if (std::any_of(groups.begin(), groups.end(), one_seed))
    chart.note = std::all_of(groups.begin(), groups.end(), one_seed) ? "one seed: no error" : "no bar: one seed";
  const auto beyond =
      std::count_if(groups.begin(), groups.end(), [](const LoadTestGroup& g) { return first_limit(all_limits(g)); });
  const auto note = [&](const std::string& words) { chart.note += (chart.note.empty() ? "" : "; ") + words; };
  if (beyond > 0) note(fmt::format("{} of {} points passed a limit of the model", beyond, groups.size()));
  const auto none = std::count_if(groups.begin(), groups.end(),
                                  [](const LoadTestGroup& g) { return !std::isfinite(mean_of_value(g, 0).value); });
  if (none > 0) note(fmt::format("{} of {} points without {} are left out", none, groups.size(), kind.drawn));
  if (!kind.left_out.empty()) note(kind.left_out);
  const std::vector<ChartLine> measured = chart.lines;
  for (const auto& [level, name] : kind.levels) {
    ChartLine line{name, {}, {}, 5, true};
    for (const ChartLine& other : measured) line.x.insert(line.x.end(), other.x.begin(), other.x.end());
    std::sort(line.x.begin(), line.x.end());
    line.y.assign(line.x.size(), level);
    chart.lines.push_back(line);
  }
  if (x != "beta_deg" || !kind.yarn_law) return scatter;
  for (const ChartLine& line : measured) {
    if (line.x.size() < 2) continue;
    ChartLine law{&line == &measured.front() ? "cos²" : "", {}, {}, line.colour, true};
    const double straight = line.y.front() / std::pow(std::cos(line.x.front() * units::degree), 2);
    const double most = *std::max_element(line.x.begin(), line.x.end());
    for (int k = 0; k <= 40; ++k) {
      law.x.push_back(line.x.front() + k * (most - line.x.front()) / 40);
      law.y.push_back(straight * std::pow(std::cos(law.x.back() * units::degree), 2));
    }
    chart.lines.push_back(law);
  }
  return scatter;
}

}  // namespace

std::string load_tests_csv(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                           const std::string& x) {
  const bool turns = kind.yarn_diameter > 0;
  std::string text = "run,replicates,to_half," + x + (turns ? ",turns_per_m" : "");
  for (const OutputColumn& c : kind.columns) text += fmt::format(",{0},{0}_standard_error", c.name);
  text += "," + column_names(limit_columns()) + ",why_none\n";
  for (const LoadTestGroup& g : groups) {
    text += fmt::format("\"{}\",{},{},{:.6g}", g.name, g.tests.size(), followed(g), mean_at(g, x).value);
    if (turns) text += fmt::format(",{:.6g}", turns_per_m(kind, g).value);
    for (std::size_t k = 0; k < kind.columns.size(); ++k) {
      const Mean m = mean_of_value(g, k);
      text += fmt::format(",{:.6g},{:.3g}", m.value, m.error);
    }
    const std::string why = why_none(g);
    text += "," + limit_cells(all_limits(g)) + "," + (why.empty() ? "" : "\"" + why + "\"") + "\n";
  }
  return text;
}

std::string load_tests_svg(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                           const std::string& x) {
  return chart_file(chart_of(kind, groups, x));
}

std::string load_tests_part(const LoadTestKind& kind, const std::vector<LoadTestGroup>& groups,
                            const std::string& x, const std::string& lines, Figures& figures) {
  std::string html =
      heading(kind.heading) + paragraph(kind.words) +
      "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th>run</th><th>to half</th>" + head_cell(x);
  if (kind.yarn_diameter > 0)
    html += fmt::format("<th>turns per metre of a yarn of {:.4g} µm</th>", 1e-3 * kind.yarn_diameter);
  std::vector<OutputColumn> columns = limit_columns();
  columns.insert(columns.end(), kind.columns.begin(), kind.columns.end());
  for (const OutputColumn& c : columns) html += head_cell(c.name, c.meaning);
  html += "</tr></thead><tbody>\n";
  for (const LoadTestGroup& g : groups) {
    const auto cell = [&](const Mean& m) {
      html += "<td>" + (std::isfinite(m.error) ? measured_text(m.value, m.error) : number_text(m.value)) + "</td>";
    };
    html += fmt::format("<tr><th>{}</th><td>{} of {}</td>", escape_markup(g.name), followed(g), g.tests.size());
    cell(mean_at(g, x));
    if (kind.yarn_diameter > 0) cell(turns_per_m(kind, g));
    const std::vector<LimitRecord> limits = all_limits(g);
    const LimitRecord* first = first_limit(limits);
    html += first
                ? fmt::format("<td>{}</td><td>{}</td>", escape_markup(first->key), number_text(first->passed_at_ps))
                : "<td>–</td><td>–</td>";
    for (std::size_t k = 0; k < kind.columns.size(); ++k)
      cell(mean_of_value(g, k));
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  for (const LoadTestGroup& g : groups)
    if (const std::string why = why_none(g); !why.empty())
      html += paragraph(fmt::format("Of {} there is no {}: {}.", escape_markup(g.name), kind.drawn, why));
  if (!kind.left_out.empty()) html += paragraph("Left out: " + kind.left_out + ".");
  const std::string svg = scatter_svg(chart_of(kind, groups, x));
  if (svg.empty()) return html;
  std::string caption =
      title_of(kind, x) + ". Bars: one standard error to either side, over runs that differ in their seed.";
  if (std::any_of(groups.begin(), groups.end(), has_errors))
    caption += " That of a single run is the one that <code>ropewalk errors</code> found.";
  if (!lines.empty()) caption += " Lines: " + escape_markup(lines) + ".";
  if (x == "beta_deg" && kind.yarn_law)
    caption += " Dashed: the law of yarns of long fibres, cos² of the angle of the outermost tubes.";
  return html + "<figure><h3>" + escape_markup(title_of(kind, x)) + "</h3>\n" + svg + figures.caption(caption) +
         "</figure>\n";
}

}  // namespace ropewalk
