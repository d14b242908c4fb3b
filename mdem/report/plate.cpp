#include "report/plate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/plain_text.hpp"
#include "report/log_figures.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

constexpr double margin = 10, tag_height = 22, gap = 14, section_pixels = 150, chart_height = 250;

// A, B, C, ...
std::string letter(std::size_t k) {
  return k < 26 ? std::string(1, static_cast<char>('A' + k)) : fmt::format("{}", k + 1);
}

// An <svg> element at a place in another one.
std::string placed(const std::string& svg, double x, double y) {
  return fmt::format("<svg x=\"{:.1f}\" y=\"{:.1f}\"", x, y) + svg.substr(4);
}

double height_of(const std::string& svg) {
  const std::string key = " height=\"";
  const std::size_t at = svg.find(key);
  return at == std::string::npos ? 0 : leading_number(std::string_view(svg).substr(at + key.size())).value_or(0);
}

std::string text_at(double x, double y, const std::string& text, bool bold = false) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, bold ? " font-weight=\"bold\"" : "",
                     escape_markup(text));
}

std::string chart_of(const PlateInput& in, const std::vector<std::string>& columns, double width) {
  const Clock clock = clock_of(in.log);
  ScatterChart scatter;
  LineChart& chart = scatter.chart;
  std::vector<CurveColumn> drawn;
  for (const std::string& column : columns) drawn.push_back(curve_column(column, in.log));
  const CurveColumn& first = drawn.front();
  chart.title = columns.front();
  const std::string& over = in.x.empty() ? clock.column : in.x;
  chart.x = in.x.empty() ? clock.axis : column_axis(in.x);
  chart.y = {columns.size() > 1 && first.unit == "eV" ? "energy" : first.quantity, first.unit, first.whole};
  chart.width = width;
  chart.height = chart_height;
  const LogValue x_of = curve_column(over, in.log).value;
  const std::vector<double> x = values_of(in.log, x_of);
  const std::size_t within = mark_beyond(in.log, in.limits, x, chart);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    chart.lines.push_back(
        {drawn[k].quantity, x, values_of(in.log, drawn[k].value), static_cast<int>(k) % categorical_colours});
    if (within < x.size()) chart.lines.back().beyond = within;
    if (!in.errors.empty()) chart.lines.back().error = values_of(in.errors, drawn[k].value);
    scatter.labels.emplace_back();
  }
  if (!in.errors.empty()) chart.note = "band: one standard error";
  // The states, on the first curve.
  ChartLine marks{"states", {}, {}, 5};
  marks.points = true;
  std::vector<std::string> letters;
  for (std::size_t k = 0; k < in.views.size(); ++k) {
    const auto at = std::min_element(in.log.begin(), in.log.end(), [&](const LogRow& a, const LogRow& b) {
      return std::fabs(a["time_ps"] - in.views[k].time_ps) < std::fabs(b["time_ps"] - in.views[k].time_ps);
    });
    if (at == in.log.end()) continue;
    marks.x.push_back(x_of(*at));
    marks.y.push_back(first.value(*at));
    letters.push_back(letter(k));
  }
  chart.lines.push_back(marks);
  scatter.labels.push_back(letters);
  return scatter_svg(scatter);
}

// Scales the pictures so that a whole number of them fills the width, shrunk a little or enlarged, in full rows if
// that is possible; returns the number.
std::size_t fill(PlateInput& in, double section) {
  constexpr double least = 0.7, most = 1.8;
  const double picture = in.camera.width * in.camera.scale;
  const auto factor_of = [&](std::size_t n) {
    const auto columns = static_cast<double>(n);
    return ((in.width - 2 * margin - (columns - 1) * gap) / columns - section) / picture;
  };
  std::size_t columns = 1;
  for (std::size_t n = 2; n <= std::min<std::size_t>(4, in.views.size()); ++n) {
    const bool full = in.views.size() % n == 0, was_full = in.views.size() % columns == 0;
    if (factor_of(n) >= least && (full || !was_full || columns == 1)) columns = n;
  }
  in.camera.scale *= std::min(factor_of(columns), most);
  return columns;
}

}  // namespace

std::string plate_svg(const PlateInput& input) {
  PlateInput in = input;
  std::string body;
  double y = margin, half_width = 0;
  for (const ReportSection& s : in.sections)
    half_width = std::max(half_width, section_half_width(s.section, in.tube_radius));
  // States: as many side by side as find room, each with its section to its right.
  const double section = in.sections.empty() ? 0 : section_pixels + gap;
  const std::size_t columns = fill(in, section);
  const double picture = in.camera.width * in.camera.scale, cell = picture + section + gap;
  for (std::size_t begin = 0; begin < in.views.size(); begin += columns) {
    double row = 0;
    for (std::size_t k = begin; k < std::min(begin + columns, in.views.size()); ++k) {
      const double x = margin + static_cast<double>(k - begin) * cell;
      const RopeView& view = in.views[k];
      body += text_at(x, y + 14, letter(k), true) +
              text_at(x + 18, y + 14,
                      fmt::format("{} ps{}", number_text(view.time_ps),
                                  std::isfinite(view.beta_deg) ? fmt::format(", β = {:.1f}°", view.beta_deg) : ""));
      const std::string rope =
          rope_picture(view, in.camera, in.tube_radius, fmt::format("p{}", k), k + 1 == in.views.size());
      body += placed(rope, x, y + tag_height);
      row = std::max(row, height_of(rope));
      if (in.sections.empty()) continue;
      const std::string cut =
          section_picture(in.sections[k].section, in.shells, in.tube_radius, half_width, section_pixels);
      body += placed(cut, x + picture + gap, y + tag_height);
      row = std::max(row, height_of(cut));
    }
    y += tag_height + row + gap;
  }
  if (in.camera.coloured()) {
    const std::string bar = colour_bar(in.camera);
    body += placed(bar, margin, y);
    y += height_of(bar) + gap;
  }
  const std::size_t side_by_side = std::min<std::size_t>(2, in.curves.size());
  for (std::size_t k = 0; k < in.curves.size(); ++k) {
    const auto n = static_cast<double>(side_by_side);
    const double width = (in.width - 2 * margin - (n - 1) * gap) / n;
    const std::string chart = chart_of(in, in.curves[k], width);
    if (!chart.empty()) body += placed(chart, margin + static_cast<double>(k % side_by_side) * (width + gap), y);
    if (k % side_by_side + 1 == side_by_side || k + 1 == in.curves.size()) y += chart_height + gap;
  }
  return svg_file(body, in.width, y);
}

}  // namespace ropewalk
