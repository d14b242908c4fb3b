#include "report/tensile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "model/units.hpp"
#include "report/log_figures.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

constexpr double slack_stress = 0.1, half_stress = 0.5;  // of the largest

struct Mean {
  double value = NAN, error = NAN;
};

template <class Value>
Mean mean_of(const std::vector<TensileTest>& tests, Value value) {
  double sum = 0, squares = 0;
  int n = 0;
  for (const TensileTest& t : tests)
    if (std::isfinite(value(t))) sum += value(t), ++n;
  if (n == 0) return {};
  const double mean = sum / n;
  for (const TensileTest& t : tests)
    if (std::isfinite(value(t))) squares += std::pow(value(t) - mean, 2);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : NAN};
}

struct TensileQuantity {
  OutputColumn column;
  double TensileTest::*value;
};
const TensileQuantity tensile_quantities[] = {
    {{"strength_GPa", "GPa", "largest stress"}, &TensileTest::strength},
    {{"strength_N_per_tex", "N/tex", "the same over the mass per length"}, &TensileTest::specific},
    {{"strain", "", "strain since the pull began, at the largest stress"}, &TensileTest::strain},
    {{"modulus_GPa", "GPa", "slope of a straight line through the stress up to half of the largest"},
     &TensileTest::modulus},
    {{"toughness_MJ_per_m3", "MJ/m^3", "work of the pull, until the stress has fallen to half of the largest"},
     &TensileTest::toughness},
    {{"toughness_J_per_g", "J/g", "the same over the mass"}, &TensileTest::specific_toughness},
    {{"links", "", "links that have formed"}, &TensileTest::links},
    {{"links_broken", "", "links that have broken"}, &TensileTest::links_broken},
    {{"bonds_broken", "", "bonds of tubes that have broken"}, &TensileTest::bonds_broken},
    {{"breaks_at_nm", "nm", "median height of what has broken"}, &TensileTest::breaks_at},
    {{"breaks_within_nm", "nm", "between the quartiles of these heights"}, &TensileTest::breaks_within},
};

int followed(const TensileGroup& group) {
  return static_cast<int>(
      std::count_if(group.tests.begin(), group.tests.end(), [](const TensileTest& t) { return t.to_half; }));
}

Mean before_pull(const TensileGroup& group, const std::string& x) {
  return mean_of(group.tests, [&](const TensileTest& t) { return t.before[x]; });
}

// Slope of the least squares line through the rows [from, to].
double slope_of(const std::vector<LogRow>& log, std::size_t from, std::size_t to) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = from; k <= to; ++k) {
    const double e = log[k]["ends_strain"], s = log[k]["stress_GPa"];
    n += 1, x += e, y += s, xx += e * e, xy += e * s;
  }
  const double spread = n * xx - x * x;
  return spread > 0 ? (n * xy - x * y) / spread : NAN;
}

double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return NAN;
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// The line of strength over x, and, over an angle, cos^2 of it from the first point on.
ScatterChart chart_of(const std::vector<TensileGroup>& groups, const std::string& x) {
  ScatterChart scatter;
  LineChart& chart = scatter.chart;
  chart.title = "Strength against " + column_axis(x).quantity;
  chart.x = column_axis(x);
  chart.y = {"strength", "GPa", false};
  chart.height = 360;
  for (const TensileGroup& g : groups) {
    auto line =
        std::find_if(chart.lines.begin(), chart.lines.end(), [&](const ChartLine& l) { return l.name == g.line; });
    if (line == chart.lines.end()) {
      chart.lines.push_back({g.line, {}, {}, static_cast<int>(chart.lines.size()) % categorical_colours});
      line = chart.lines.end() - 1;
      line->bars = true;
    }
    const Mean at = before_pull(g, x), strength = mean_of(g.tests, std::mem_fn(&TensileTest::strength));
    line->x.push_back(at.value);
    line->y.push_back(strength.value);
    line->error.push_back(strength.error);
  }
  if (x != "beta_deg") return scatter;
  const std::vector<ChartLine> measured = chart.lines;
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

TensileTest tensile_test(const std::vector<LogRow>& log, std::vector<double> heights_of_breaks) {
  const LogRow* strongest = strongest_row(log);
  if (!strongest) throw std::invalid_argument("nothing pulls in it");
  const auto most = static_cast<std::size_t>(strongest - log.data());
  TensileTest t;
  t.strength = (*strongest)["stress_GPa"];
  t.specific = (*strongest)["specific_stress_N_per_tex"];
  double least_strain = (*strongest)["ends_strain"];
  for (std::size_t k = 0; k < most; ++k) least_strain = std::min(least_strain, log[k]["ends_strain"]);
  const double still = least_strain + 1e-3 * ((*strongest)["ends_strain"] - least_strain);
  std::size_t begin = most;
  while (begin > 0 && log[begin]["stress_GPa"] > slack_stress * t.strength && log[begin]["ends_strain"] > still)
    --begin;
  const double moved = 1e-4 * ((*strongest)["ends_strain"] - least_strain);
  while (begin > 0 && log[begin]["ends_strain"] - log[begin - 1]["ends_strain"] > moved) --begin;
  t.before = log[begin];
  t.strain = (*strongest)["ends_strain"] - t.before["ends_strain"];
  const double middle = 0.5 * (t.before["stress_GPa"] + t.strength);
  std::size_t half = begin;
  while (half < most && log[half]["stress_GPa"] < middle) ++half;
  t.modulus = slope_of(log, begin, half);
  for (std::size_t k = begin + 1; k < log.size() && !t.to_half; ++k) {
    const double strain = log[k]["ends_strain"] - log[k - 1]["ends_strain"];
    t.toughness += 1e3 * strain * 0.5 * (log[k]["stress_GPa"] + log[k - 1]["stress_GPa"]);
    t.specific_toughness +=
        1e3 * strain * 0.5 * (log[k]["specific_stress_N_per_tex"] + log[k - 1]["specific_stress_N_per_tex"]);
    t.to_half = k > most && log[k]["stress_GPa"] < half_stress * t.strength;
  }
  t.links = log.back()["links_formed"];
  t.links_broken = log.back()["links_broken"];
  t.bonds_broken = log.back()["bonds_broken"];
  std::sort(heights_of_breaks.begin(), heights_of_breaks.end());
  t.breaks_at = quantile(heights_of_breaks, 0.5);
  t.breaks_within = quantile(heights_of_breaks, 0.75) - quantile(heights_of_breaks, 0.25);
  return t;
}

std::vector<OutputColumn> tensile_columns() {
  std::vector<OutputColumn> out;
  for (const TensileQuantity& q : tensile_quantities) out.push_back(q.column);
  return out;
}

std::string tensile_csv(const std::vector<TensileGroup>& groups, const std::string& x) {
  std::string text = "run,replicates,to_half," + x;
  for (const TensileQuantity& q : tensile_quantities) text += fmt::format(",{0},{0}_standard_error", q.column.name);
  text += "\n";
  for (const TensileGroup& g : groups) {
    text += fmt::format("\"{}\",{},{},{:.6g}", g.name, g.tests.size(), followed(g), before_pull(g, x).value);
    for (const TensileQuantity& q : tensile_quantities) {
      const Mean m = mean_of(g.tests, std::mem_fn(q.value));
      text += fmt::format(",{:.6g},{:.3g}", m.value, m.error);
    }
    text += "\n";
  }
  return text;
}

std::string tensile_svg(const std::vector<TensileGroup>& groups, const std::string& x) {
  return chart_file(chart_of(groups, x));
}

std::string tensile_part(const std::vector<TensileGroup>& groups, const std::string& x, const std::string& lines,
                         Figures& figures) {
  std::string html =
      heading("Strength") +
      paragraph(
          "Stress is the tension over the cells of the tubes in a cross-section. The work of the pull is counted "
          "until "
          "the stress has fallen to half of its largest value; \"to half\" says in how many runs it has.") +
      "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th>run</th><th>to half</th><th>" +
      escape_markup(column_axis(x).quantity) + "</th>";
  for (const TensileQuantity& q : tensile_quantities)
    html += fmt::format("<th title=\"{}\">{}</th>", q.column.meaning, q.column.name);
  html += "</tr></thead><tbody>\n";
  for (const TensileGroup& g : groups) {
    const auto cell = [&](const Mean& m) {
      html += "<td>" + (std::isfinite(m.error) ? measured_text(m.value, m.error) : number_text(m.value)) + "</td>";
    };
    html += fmt::format("<tr><th>{}</th><td>{} of {}</td>", escape_markup(g.name), followed(g), g.tests.size());
    cell(before_pull(g, x));
    for (const TensileQuantity& q : tensile_quantities) cell(mean_of(g.tests, std::mem_fn(q.value)));
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  const std::string svg = scatter_svg(chart_of(groups, x));
  if (svg.empty()) return html;
  std::string caption =
      "Largest stress. Bars: one standard error to either side, over runs that differ in their seed.";
  if (!lines.empty()) caption += " Lines: " + escape_markup(lines) + ".";
  if (x == "beta_deg")
    caption += " Dashed: the law of yarns of long fibres, cos² of the angle of the outermost tubes.";
  return html + "<figure><h3>Strength against " + escape_markup(column_axis(x).quantity) + "</h3>\n" + svg +
         figures.caption(caption) + "</figure>\n";
}

}  // namespace ropewalk
