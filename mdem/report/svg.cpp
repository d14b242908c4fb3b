#include "report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "io/child_process.hpp"
#include "io/draft.hpp"
#include "model/error.hpp"
#include "report/drawing.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

constexpr double font = 12;            // pixels
constexpr double label_distance = 15;  // between baselines
constexpr std::size_t max_points = 400;
constexpr int line_colours = categorical_colours + sequential_colours;

int colour_of(const ChartLine& line) { return ((line.colour % line_colours) + line_colours) % line_colours; }

std::string superscript(int exponent) {
  static const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[c - '0'];
  return text;
}

std::string with_true_minus(const std::string& text) {
  return !text.empty() && text[0] == '-' ? "−" + text.substr(1) : text;
}

// Narrow spaces, at which no line breaks, between groups of three before the decimal point, from five digits on.
std::string grouped(std::string text) {
  const std::size_t begin = !text.empty() && text[0] == '-' ? 1 : 0;
  const std::size_t point = std::min(text.find('.'), text.size());
  if (point - begin < 5) return text;
  for (std::size_t at = point; at > begin + 3;) {
    at -= 3;
    text.insert(at, "\u202f");
  }
  return text;
}

int magnitude(double value) { return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))); }

// Upper estimate of the width of a text in the page's sans-serif font.
double text_width(std::string_view text) {
  double ems = 0;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if ((u & 0xc0) == 0x80) continue;  // the rest of a UTF-8 sequence
    if (std::string_view(" .,:;'|!ijlftr()I").find(c) != std::string_view::npos)
      ems += 0.36;
    else if (std::string_view("mwMW%@").find(c) != std::string_view::npos)
      ems += 0.92;
    else
      ems += u >= 'A' && u <= 'Z' ? 0.72 : 0.59;
  }
  return ems * font;
}

// --- Axes -----------------------------------------------------------------------------------------------

struct AxisRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double span() const { return high - low; }
};

struct Scale {
  AxisRange range;
  double step = 1;
  int power = 0;         // ticks are in units of 10^power
  bool decades = false;  // a scale of logarithms
  std::vector<double> ticks;
  std::vector<std::string> labels;
};

double nice_step(double rough, bool whole) {
  const double base = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * base >= rough * 0.999) return whole ? std::max(1.0, m * base) : m * base;
  return whole ? std::max(1.0, 10 * base) : 10 * base;
}

int power_of(const AxisRange& range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  if (largest == 0 || (largest >= 0.01 && largest < 1e5)) return 0;
  return 3 * static_cast<int>(std::floor(magnitude(largest) / 3.0));
}

Scale scale_of(const AxisRange& range, int parts, bool whole) {
  Scale s;
  s.range = range;
  s.step = nice_step(range.span() / parts, whole);
  s.power = power_of(range);
  const double unit = std::pow(10.0, s.power);
  const int decimals = std::max(0, -magnitude(s.step / unit * 1.0001));
  for (double k = std::ceil(range.low / s.step - 1e-6); k * s.step <= range.high + 1e-6 * s.step; k += 1) {
    s.ticks.push_back(k * s.step);
    s.labels.push_back(fixed_text(k * s.step / unit, decimals));
  }
  return s;
}

// The ticks of a logarithmic axis: decades, and 2 and 5 between them where there are few.
Scale decades_of(const AxisRange& range) {
  Scale s;
  s.range = range;
  s.decades = true;
  const std::vector<double> parts = range.span() < 0.8   ? std::vector<double>{1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}
                                    : range.span() < 1.4 ? std::vector<double>{1, 2, 3, 5, 7}
                                    : range.span() < 2.5 ? std::vector<double>{1, 2, 5}
                                                         : std::vector<double>{1};
  const int every = std::max(1, static_cast<int>(range.span() / 6));
  for (int k = static_cast<int>(std::floor(range.low)); k <= range.high; k += every)
    for (const double part : parts) {
      const double at = k + std::log10(part);
      if (at < range.low || at > range.high) continue;
      s.ticks.push_back(at);
      s.labels.push_back(number_text(part * std::pow(10.0, k), 2));
    }
  return s;
}

// A little air around the data; from zero where they nearly begin there.
AxisRange y_range(AxisRange r, bool whole) {
  const double size = std::max(std::abs(r.low), std::abs(r.high));
  if (r.span() <= 1e-9 * size || size == 0) {
    const double air = whole || size == 0 ? 1.0 : 0.05 * size;
    return {r.low - air, r.high + air};
  }
  const double air = 0.06 * r.span();
  const bool from_zero = r.low >= 0 && r.low < 0.35 * r.high;
  const bool to_zero = r.high <= 0 && r.high > 0.35 * r.low;
  return {from_zero ? 0 : r.low - air, to_zero ? 0 : r.high + air};
}

AxisRange with_zero(AxisRange r) {
  r.take(0);
  return r;
}

AxisRange with_air(const AxisRange& r) {
  const double air = std::max(0.06 * r.span(), 0.1);
  return {r.low - air, r.high + air};
}

std::string axis_text(const ChartAxis& axis, int power) {
  const std::string factor = power == 0 ? "" : "10" + superscript(power);
  if (axis.unit.empty() && factor.empty()) return axis.quantity;
  const std::string space = axis.unit.empty() || factor.empty() ? "" : " ";
  return fmt::format("{} ({}{}{})", axis.quantity, factor, space, axis.unit);
}

// --- Lines ----------------------------------------------------------------------------------------------

struct PagePoint {
  double x, y;
};
using Stretch = std::vector<PagePoint>;  // without a gap

std::vector<Stretch> stretches(const ChartLine& line) {
  std::vector<Stretch> all(1);
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
    if (std::isfinite(line.x[i]) && std::isfinite(line.y[i]))
      all.back().push_back({line.x[i], line.y[i]});
    else if (!all.back().empty())
      all.emplace_back();
  }
  if (all.back().empty()) all.pop_back();
  return all;
}

// Keeps the first and the last point, and the lowest and the highest of every bucket between them.
Stretch thinned(const Stretch& points, std::size_t most) {
  if (points.size() <= most || most < 4) return points;
  const std::size_t buckets = (most - 2) / 2;
  const std::size_t inner = points.size() - 2;
  Stretch out{points.front()};
  for (std::size_t b = 0; b < buckets; ++b) {
    const auto begin = points.begin() + 1 + static_cast<std::ptrdiff_t>(b * inner / buckets);
    const auto end = points.begin() + 1 + static_cast<std::ptrdiff_t>((b + 1) * inner / buckets);
    const auto [low, high] =
        std::minmax_element(begin, end, [](const PagePoint& p, const PagePoint& q) { return p.y < q.y; });
    out.push_back(*std::min(low, high));
    if (low != high) out.push_back(*std::max(low, high));
  }
  out.push_back(points.back());
  return out;
}

// The chart with logarithms of the data on logarithmic axes.
ScatterChart in_logarithms(ScatterChart scatter) {
  const auto take = [](std::vector<double>& values) {
    for (double& v : values) v = v > 0 ? std::log10(v) : std::numeric_limits<double>::quiet_NaN();
  };
  for (ChartLine& line : scatter.chart.lines) {
    if (scatter.chart.x.decades) take(line.x);
    if (scatter.chart.y.decades) take(line.y);
  }
  return scatter;
}

AxisRange x_range(const LineChart& chart) {
  AxisRange r;
  for (const ChartLine& line : chart.lines)
    for (const Stretch& s : stretches(line))
      for (const PagePoint& p : s) r.take(p.x);
  return r;
}

// Bands and bars that would make the lines flat are cut.
AxisRange y_of_lines_and_errors(const LineChart& chart) {
  constexpr double most = 0.6;  // share of the range of the lines, to either side
  AxisRange lines, whole;
  for (const ChartLine& line : chart.lines)
    for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
      if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) continue;
      lines.take(line.y[i]);
      whole.take(line.y[i]);
      if (i >= line.error.size() || !std::isfinite(line.error[i]) || chart.y.decades) continue;
      whole.take(line.y[i] - line.error[i]);
      whole.take(line.y[i] + line.error[i]);
    }
  if (!(lines.span() > 0)) return whole;
  const double more = most * lines.span();
  return {std::max(whole.low, lines.low - more), std::min(whole.high, lines.high + more)};
}

struct Plot {
  double left = 0, top = 0, right = 0, bottom = 0;
  Scale x, y;

  double px(double v) const { return left + (v - x.range.low) / x.range.span() * (right - left); }
  double py(double v) const { return bottom - (v - y.range.low) / y.range.span() * (bottom - top); }
};

std::string path_of(const Plot& plot, const ChartLine& line) {
  std::string d;
  const auto to = std::back_inserter(d);
  const std::vector<Stretch> all = stretches(line);
  std::size_t total = 0;
  for (const Stretch& s : all) total += s.size();
  for (const Stretch& whole : all) {
    const Stretch s =
        thinned(whole, std::max<std::size_t>(4, max_points * whole.size() / std::max<std::size_t>(1, total)));
    fmt::format_to(to, "M{:.1f} {:.1f}", plot.px(s[0].x), plot.py(s[0].y));
    if (s.size() == 1) d += "h0";  // a dot, by the round cap
    if (line.points && s.size() > 1) d += "h0";
    for (std::size_t i = 1; i < s.size(); ++i) {
      if (line.points)
        fmt::format_to(to, "M{:.1f} {:.1f}h0", plot.px(s[i].x), plot.py(s[i].y));
      else if (line.steps)
        fmt::format_to(to, "H{:.1f}V{:.1f}", plot.px(s[i].x), plot.py(s[i].y));
      else
        fmt::format_to(to, "L{:.1f} {:.1f}", plot.px(s[i].x), plot.py(s[i].y));
    }
  }
  return d;
}

std::string stroke_class(const ChartLine& line) {
  return fmt::format("line c{}{}", colour_of(line), line.points ? " points" : line.dashed ? " dashed" : "");
}

// Draws the line in two parts: up to the point where a limit is passed, and from there on.
std::string draw_in_two(const ChartLine& line, const Plot& plot) {
  ChartLine within = line, behind = line;
  const auto cut = [](std::vector<double>& v, std::size_t from, std::size_t to) {
    v = {v.begin() + static_cast<std::ptrdiff_t>(std::min(from, v.size())),
         v.begin() + static_cast<std::ptrdiff_t>(std::min(to, v.size()))};
  };
  for (auto* v : {&within.x, &within.y}) cut(*v, 0, line.beyond);
  for (auto* v : {&behind.x, &behind.y}) cut(*v, line.beyond > 0 ? line.beyond - 1 : 0, v->size());
  return fmt::format("<path class=\"{} beyond\" d=\"{}\"/>\n<path class=\"{}\" d=\"{}\"/>\n", stroke_class(line),
                     path_of(plot, behind), stroke_class(line), path_of(plot, within));
}

// Bars of the line's errors with a tick at each end, and a dot at each of its points.
std::string error_bars(const ChartLine& line, const Plot& plot) {
  constexpr double half_tick = 3;
  const auto y = [&](double v) { return std::clamp(plot.py(v), plot.top, plot.bottom); };
  std::string bars, dots;
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
    if (!std::isfinite(line.x[i] + line.y[i])) continue;
    const double at = plot.px(line.x[i]), error = i < line.error.size() ? line.error[i] : 0;
    dots += fmt::format("M{:.1f} {:.1f}h0", at, plot.py(line.y[i]));
    if (!(error > 0)) continue;
    const double top = y(line.y[i] + error), bottom = y(line.y[i] - error);
    bars += fmt::format("M{0:.1f} {1:.1f}V{2:.1f}", at, top, bottom);
    for (const double end : {top, bottom})
      bars += fmt::format("M{:.1f} {:.1f}h{:g}", at - half_tick, end, 2 * half_tick);
  }
  std::string text;
  if (!bars.empty()) text += fmt::format("<path class=\"line c{}\" d=\"{}\"/>\n", colour_of(line), bars);
  if (!dots.empty()) text += fmt::format("<path class=\"line points c{}\" d=\"{}\"/>\n", colour_of(line), dots);
  return text;
}

// Bands of the lines' errors. A missing error interrupts a band.
std::string draw_errors(const LineChart& chart, const Plot& plot) {
  std::string text;
  const auto y = [&](double v) { return std::clamp(plot.py(v), plot.top, plot.bottom); };
  for (const ChartLine& line : chart.lines) {
    if (line.bars) {
      text += error_bars(line, plot);
      continue;
    }
    const std::size_t count = std::min({line.x.size(), line.y.size(), line.error.size()});
    const std::size_t every = std::max<std::size_t>(1, count / (max_points / 2));
    std::string upper, lower;
    const auto close = [&] {
      if (!upper.empty())
        text += fmt::format("<path class=\"error e{}\" d=\"M{}L{}Z\"/>\n", colour_of(line), upper.substr(1),
                            lower.substr(1));
      upper.clear();
      lower.clear();
    };
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(line.x[i] + line.y[i] + line.error[i])) {
        close();
        continue;
      }
      if (i % every != 0 && i + 1 != count) continue;
      upper += fmt::format("L{:.1f} {:.1f}", plot.px(line.x[i]), y(line.y[i] + line.error[i]));
      lower = fmt::format("L{:.1f} {:.1f}", plot.px(line.x[i]), y(line.y[i] - line.error[i])) + lower;
    }
    close();
  }
  return text;
}

// Shades the areas of filled lines, with their names at the centres of area.
std::string draw_areas(const LineChart& chart, const Plot& plot) {
  std::string text;
  for (const ChartLine& line : chart.lines) {
    if (!line.filled) continue;
    for (const Stretch& s : stretches(line)) {
      std::string d;
      double twice = 0, x = 0, y = 0;  // moments of the triangles between each side and the first corner
      const PagePoint first{plot.px(s[0].x), plot.py(s[0].y)};
      PagePoint last = first;
      for (const PagePoint& p : s) {
        const PagePoint at{plot.px(p.x), plot.py(p.y)};
        d += fmt::format("{}{:.1f} {:.1f}", d.empty() ? "M" : "L", at.x, at.y);
        const double part = (last.x - first.x) * (at.y - first.y) - (at.x - first.x) * (last.y - first.y);
        twice += part;
        x += part * (first.x + last.x + at.x) / 3;
        y += part * (first.y + last.y + at.y) / 3;
        last = at;
      }
      text += fmt::format("<path class=\"region e{}\" d=\"{}Z\"/>\n", colour_of(line), d);
      if (twice != 0)
        text += fmt::format("<text class=\"soft mid\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x / twice,
                            y / twice + 4, escape_markup(line.name));
    }
  }
  return text;
}

// Shades the area below each whole line. The name of the area below stands under the highest point of the first
// line, the name of the area above over its lowest.
std::string draw_regions(const LineChart& chart, const Plot& plot) {
  if (chart.below.empty()) return "";
  std::string text, names;
  for (const ChartLine& line : chart.lines) {
    if (line.points || line.dashed || line.filled) continue;
    for (const Stretch& s : stretches(line)) {
      const double first = plot.px(s.front().x), last = plot.px(s.back().x);
      text += fmt::format("<path class=\"region e{}\" d=\"M{:.1f} {:.1f}", colour_of(line), first, plot.bottom);
      for (const PagePoint& p : thinned(s, max_points))
        text += fmt::format("L{:.1f} {:.1f}", plot.px(p.x), plot.py(p.y));
      text += fmt::format("V{:.1f}Z\"/>\n", plot.bottom);
      if (!names.empty()) continue;
      const auto lower = [](const PagePoint& a, const PagePoint& b) { return a.y < b.y; };
      const auto name = [&](double x, double y, const std::string& words) {
        const double half = 0.5 * text_width(words) + 6;
        return fmt::format("<text class=\"soft mid\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                           std::clamp(plot.px(x), first + half, std::max(first + half, last - half)), y,
                           escape_markup(words));
      };
      names = name(std::max_element(s.begin(), s.end(), lower)->x, plot.bottom - 8, chart.below) +
              name(std::min_element(s.begin(), s.end(), lower)->x, plot.top + 14, chart.above);
    }
  }
  return text + names;
}

// --- Labels at the right end ------------------------------------------------------------------------------

struct EndLabel {
  const ChartLine* line;
  double end;    // where the line ends
  double end_x;  // end in units of the data
  double at;     // where its name stands
};

std::vector<EndLabel> end_labels(const LineChart& chart, const Plot& plot) {
  std::vector<EndLabel> labels;
  for (const ChartLine& line : chart.lines) {
    const std::vector<Stretch> all = stretches(line);
    if (all.empty() || line.filled) continue;
    const double y = plot.py(all.back().back().y);
    labels.push_back({&line, y, all.back().back().x, y});
  }
  std::stable_sort(labels.begin(), labels.end(),
                   [](const EndLabel& a, const EndLabel& b) { return a.end < b.end; });
  // Labels that overlap are moved down. Labels below the chart are then moved up. Neighbours end a line of text
  // apart.
  for (std::size_t i = 1; i < labels.size(); ++i)
    labels[i].at = std::max(labels[i].at, labels[i - 1].at + label_distance);
  double limit = plot.bottom;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->at = std::min(label->at, limit);
    limit = label->at - label_distance;
  }
  return labels;
}

struct Box {
  double left, right, top, bottom;

  bool covers(const Box& b) const { return left < b.right && b.left < right && top < b.bottom && b.top < bottom; }
};

// A name at its point, and the box that it fills.
struct PlacedName {
  double x, y;
  const char* anchor;  // class
  Box box;
};

// The places beside, above and below a point at (x, y), best first.
std::vector<PlacedName> places_about(double x, double y, double width) {
  std::vector<PlacedName> places;
  const auto add = [&](double dx, double baseline, const char* anchor) {
    const double left = dx > 0 ? x + dx : dx < 0 ? x + dx - width : x - 0.5 * width;
    places.push_back({x + dx, y + baseline, anchor, {left, left + width, y + baseline - 9, y + baseline + 2}});
  };
  for (const double baseline : {-4.0, 4.0, 12.0, -8.0, 16.0})
    for (const auto& [dx, anchor] : {std::pair(7.0, ""), std::pair(-7.0, " end")}) add(dx, baseline, anchor);
  add(0, -8, " mid");
  add(0, 17, " mid");
  return places;
}

// As draw_point_labels, with names that keep apart.
std::string draw_names_apart(const ScatterChart& scatter, const Plot& plot) {
  std::vector<Box> taken;
  const auto each = [&](auto use) {
    for (std::size_t l = 0; l < std::min(scatter.labels.size(), scatter.chart.lines.size()); ++l) {
      const ChartLine& line = scatter.chart.lines[l];
      for (std::size_t i = 0; i < std::min({scatter.labels[l].size(), line.x.size(), line.y.size()}); ++i)
        if (std::isfinite(line.x[i]) && std::isfinite(line.y[i]))
          use(scatter.labels[l][i], plot.px(line.x[i]), plot.py(line.y[i]));
    }
  };
  each([&](const std::string&, double x, double y) { taken.push_back({x - 4, x + 4, y - 4, y + 4}); });
  std::string text;
  each([&](const std::string& name, double x, double y) {
    if (name.empty()) return;
    for (const PlacedName& p : places_about(x, y, text_width(name))) {
      const bool inside = p.box.left >= plot.left && p.box.right <= plot.right && p.box.top >= plot.top &&
                          p.box.bottom <= plot.bottom;
      if (!inside || std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return b.covers(p.box); }))
        continue;
      taken.push_back(p.box);
      text += fmt::format("<text class=\"halo{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", p.anchor, p.x, p.y,
                          escape_markup(name));
      return;
    }
  });
  return text;
}

// The names of single points.
std::string draw_point_labels(const ScatterChart& scatter, const Plot& plot) {
  if (scatter.names_keep_apart) return draw_names_apart(scatter, plot);
  std::string text;
  for (std::size_t l = 0; l < std::min(scatter.labels.size(), scatter.chart.lines.size()); ++l) {
    const ChartLine& line = scatter.chart.lines[l];
    const std::vector<std::string>& labels = scatter.labels[l];
    for (std::size_t i = 0; i < std::min({labels.size(), line.x.size(), line.y.size()}); ++i) {
      if (labels[i].empty() || !std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) continue;
      const double x = plot.px(line.x[i]), y = plot.py(line.y[i]);
      const bool left = x + 8 + text_width(labels[i]) > plot.right;
      text += fmt::format("<text class=\"soft{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left ? " end" : "",
                          left ? x - 6 : x + 6, y - 4, escape_markup(labels[i]));
    }
  }
  return text;
}

// About (x, y).
std::string mark_path(Mark mark, double x, double y) {
  switch (mark) {
    case Mark::dot:
      return fmt::format("M{:.1f} {:.1f}a3.4 3.4 0 1 0 6.8 0a3.4 3.4 0 1 0 -6.8 0Z", x - 3.4, y);
    case Mark::square:
      return fmt::format("M{:.1f} {:.1f}h6v6h-6Z", x - 3, y - 3);
    case Mark::diamond:
      return fmt::format("M{:.1f} {:.1f}l4.2 4.2l-4.2 4.2l-4.2 -4.2Z", x, y - 4.2);
    case Mark::triangle:
      return fmt::format("M{:.1f} {:.1f}l4 7h-8Z", x, y - 4.2);
    case Mark::cross:
      return fmt::format("M{:.1f} {:.1f}h2.4v-2.4h2.4v2.4h2.4v2.4h-2.4v2.4h-2.4v-2.4h-2.4Z", x - 3.6, y - 1.2);
    case Mark::star:
      return fmt::format(
          "M{:.1f} {:.1f}l1.9 4.4l4.8 .4l-3.7 3.2l1.1 4.7l-4.1 -2.5l-4.1 2.5l1.1 -4.7l-3.7 -3.2l4.8 -.4Z", x,
          y - 7);
  }
  return "";
}

std::string mark_element(const std::string& path, int colour, bool hollow, bool faint, const std::string& title) {
  const std::string tip = title.empty() ? "" : "<title>" + escape_markup(title) + "</title>";
  return fmt::format("<path class=\"mark {}{}\" d=\"{}\">{}</path>\n",
                     hollow ? fmt::format("hollow c{}", colour) : fmt::format("e{}", colour), faint ? " faint" : "",
                     path, tip);
}

std::string draw_marks(const ChartLine& line, const PointStyle& style, const Plot& plot) {
  std::string text;
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
    if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) continue;
    const bool hollow = i < style.hollow.size() && style.hollow[i];
    text += mark_element(mark_path(style.mark, plot.px(line.x[i]), plot.py(line.y[i])), colour_of(line), hollow,
                         style.faint, i < style.titles.size() ? style.titles[i] : "");
  }
  return text;
}

std::string draw_labels(const LineChart& chart, const Plot& plot) {
  std::string text;
  for (const EndLabel& label : end_labels(chart, plot)) {
    if (label.line->name.empty()) continue;
    // A thin grey line leads from where a line ends at the edge to its name; the piece before the name is the key.
    const bool at_edge = std::fabs(plot.px(label.end_x) - plot.right) < 3;
    if (at_edge && !label.line->points)
      text += fmt::format("<path class=\"leader\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", plot.right + 2, label.end,
                          plot.right + 9, label.at);
    const std::string key = label.line->points ? fmt::format("M{:.1f} {:.1f}h0", plot.right + 19, label.at)
                                               : fmt::format("M{:.1f} {:.1f}h13", plot.right + 12, label.at);
    text +=
        fmt::format("<path class=\"{}\" d=\"{}\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
                    stroke_class(*label.line), key, plot.right + 29, label.at + 4, escape_markup(label.line->name));
  }
  return text;
}

// --- The parts of a chart ---------------------------------------------------------------------------------

Plot layout(const ScatterChart& scatter) {
  const LineChart& chart = scatter.chart;
  Plot plot;
  const AxisRange x = x_range(chart), y = y_of_lines_and_errors(chart);
  plot.x = scatter.chart.x.decades ? decades_of(with_air(x)) : scale_of(x, 6, chart.x.whole);
  plot.y = scatter.chart.y.decades
               ? decades_of(with_air(y))
               : scale_of(y_range(chart.y.from_zero ? with_zero(y) : y, chart.y.whole), 5, chart.y.whole);
  double ticks = 0, names = 0;
  for (const std::string& label : plot.y.labels) ticks = std::max(ticks, text_width(label));
  for (const ChartLine& line : chart.lines)
    if (!line.filled) names = std::max(names, text_width(line.name));
  plot.left = ticks + 32;
  plot.right = chart.width - names - 35;
  plot.top = chart.bands.empty() ? 10 : 24;
  plot.bottom = chart.height - 42;
  return plot;
}

std::string draw_bands(const LineChart& chart, const Plot& plot) {
  std::string text;
  for (const ChartBand& band : chart.bands) {
    if (!std::isfinite(band.from) || !std::isfinite(band.to)) continue;
    const double from = plot.px(std::max(band.from, plot.x.range.low));
    const double to = plot.px(std::min(band.to, plot.x.range.high));
    if (to <= from) continue;
    text += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                        band.dark ? "hold" : "load", from, plot.top, to - from, plot.bottom - plot.top);
    if (text_width(band.label) < to - from)
      text += fmt::format("<text class=\"soft mid\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", 0.5 * (from + to),
                          plot.top - 7, escape_markup(band.label));
    text += "\n";
  }
  return text;
}

// Hatched from chart.beyond on, by lines that each program draws.
std::string draw_beyond(const LineChart& chart, const Plot& plot) {
  if (!std::isfinite(chart.beyond) || !(chart.beyond < plot.x.range.high)) return "";
  constexpr double apart = 9;
  const double from = plot.px(std::max(chart.beyond, plot.x.range.low)), high = plot.bottom - plot.top;
  std::string lines;
  for (double x = from - std::fmod(from - plot.left, apart) - high; x < plot.right; x += apart) {
    const double left = std::max(x, from), right = std::min(x + high, plot.right);
    if (right > left)
      lines += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", left, plot.bottom - (left - x), right,
                           plot.bottom - (right - x));
  }
  std::string text =
      fmt::format("<path class=\"hatch\" d=\"{}\"/><path class=\"edge\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", lines, from,
                  plot.top, plot.bottom);
  // Beside the edge, on the side with more room.
  const bool right = plot.right - from > from - plot.left;
  if (text_width(chart.beyond_name) + 8 < std::max(plot.right - from, from - plot.left))
    text += fmt::format("<text class=\"soft halo{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", right ? "" : " end",
                        right ? from + 5 : from - 5, plot.top + 12, escape_markup(chart.beyond_name));
  return text + "\n";
}

std::string draw_axes(const LineChart& chart, const Plot& plot) {
  std::string text;
  const auto to = std::back_inserter(text);
  for (std::size_t k = 0; k < plot.y.ticks.size(); ++k) {
    const double y = plot.py(plot.y.ticks[k]);
    fmt::format_to(
        to,
        "<path class=\"{}\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        plot.y.ticks[k] == 0 && !plot.y.decades ? "zero" : "grid", plot.left, y, plot.right, plot.left - 6, y + 4,
        plot.y.labels[k]);
  }
  for (std::size_t k = 0; k < plot.x.ticks.size(); ++k) {
    const double x = plot.px(plot.x.ticks[k]);
    fmt::format_to(
        to,
        "<path class=\"axis\" d=\"M{:.1f} {:.1f}v4\"/><text class=\"mid\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", x,
        plot.bottom, x, plot.bottom + 18, plot.x.labels[k]);
  }
  fmt::format_to(to, "<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", plot.left, plot.bottom, plot.right);
  fmt::format_to(to, "<text class=\"mid\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", 0.5 * (plot.left + plot.right),
                 plot.bottom + 36, escape_markup(axis_text(chart.x, plot.x.power)));
  fmt::format_to(to, "<text class=\"mid\" transform=\"translate(13 {:.1f}) rotate(-90)\">{}</text>\n",
                 0.5 * (plot.top + plot.bottom), escape_markup(axis_text(chart.y, plot.y.power)));
  return text;
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value < 0 ? "−∞" : "∞";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);  // no -0.0
  return with_true_minus(grouped(text));
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value) || value == 0) return fixed_text(value, 0);
  const int power = magnitude(value);
  if (power < -4 || power > 8) {
    const double mantissa = value / std::pow(10.0, power);
    return with_true_minus(fmt::format("{:.{}g}", mantissa, digits)) + "·10" + superscript(power);
  }
  std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - 1 - power));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return with_true_minus(grouped(text));
}

std::string viridis(double at) {
  static const double table[9][3] = {{68, 1, 84},    {71, 45, 123}, {59, 82, 139},  {44, 114, 142}, {33, 145, 140},
                                     {40, 174, 128}, {94, 201, 98}, {173, 220, 48}, {253, 231, 37}};
  const double s = 8 * std::min(1.0, std::max(0.0, std::isnan(at) ? 0.0 : at));
  const int k = std::min(7, static_cast<int>(s));
  std::string text = "#";
  for (int c = 0; c < 3; ++c)
    text += fmt::format("{:02x}",
                        static_cast<int>(std::lround(table[k][c] + (s - k) * (table[k + 1][c] - table[k][c]))));
  return text;
}

int sequential_colour(std::size_t k, std::size_t n) {
  if (n < 2) return categorical_colours;
  return categorical_colours + static_cast<int>(k * (sequential_colours - 1) / (n - 1));
}

std::string svg_css() {
  std::string css =
      R"(:root{--paper:#fff;--ink:#1c1e22;--soft:#5b616e;--rule:#d5d8de;--grid:#d9dce2;
--load:#f2f3f5;--hold:#e2e5ea;
--c0:#0072b2;--c1:#d55e00;--c2:#009e73;--c3:#b0479a;--c4:#9a7500;--c5:#3f4a5a;
--c6:#440154;--c7:#414487;--c8:#2a788e;--c9:#22a884;--c10:#5fae3c;--c11:#b5a51a}
@media screen and (prefers-color-scheme:dark){
:root{--paper:#16181c;--ink:#e6e7ea;--soft:#a3a9b5;--rule:#3a3f49;--grid:#333842;
--load:#1e2127;--hold:#282c34;
--c0:#5ab4e6;--c1:#ff8f52;--c2:#3fcf9f;--c3:#e28ccb;--c4:#e3bb4a;--c5:#b9c0cc;
--c6:#8a78d0;--c7:#6c8fd8;--c8:#3fa0b8;--c9:#35c59b;--c10:#86d957;--c11:#f2e03a}}
.chart,.section,.bar{font:12px "Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif;
font-variant-numeric:tabular-nums;max-width:100%;height:auto}
.chart text,.section text,.bar text{fill:var(--ink)}
.mid{text-anchor:middle}.end{text-anchor:end}.chart .soft{fill:var(--soft)}
.axis{stroke:var(--soft);fill:none}.grid{stroke:var(--grid);stroke-width:.7}
.zero{stroke:var(--soft);stroke-width:.9}
.load{fill:var(--load)}.hold{fill:var(--hold)}
.leader{fill:none;stroke:var(--soft);stroke-width:.7}
.line{fill:none;stroke-width:1.7;stroke-linejoin:round;stroke-linecap:round}
.error{fill-opacity:.2;stroke:none}.region{fill-opacity:.1;stroke:none}
.points{stroke-width:5.5}
.mark{stroke:var(--paper);stroke-width:.6}.mark:hover{stroke:var(--ink);stroke-width:1.6}
.hollow{fill:var(--paper);stroke-width:1.4}.faint{opacity:.3}
.halo{paint-order:stroke;stroke:var(--paper);stroke-width:2.5px}
.key{vertical-align:-3px}
.dashed{stroke-dasharray:5 3.5;stroke-linecap:butt}
.beyond{opacity:.5;stroke-dasharray:.1 3.4}
.hatch{stroke:var(--grid);stroke-width:1;fill:none}.edge{stroke:var(--soft);stroke-width:.8;stroke-dasharray:2 2;fill:none}
.n5{fill:#d7352f}.n7{fill:#2b6cc4}.nx{fill:#e0a010}.n6{fill:#6b7078}.outermost{fill:#d4d7dc}
.section circle{stroke:#4a4e55;stroke-width:.5}
)";
  for (int k = 0; k < line_colours; ++k)
    css += fmt::format(".c{0}{{stroke:var(--c{0})}}.e{0}{{fill:var(--c{0})}}", k);
  return css + "\n";
}

bool can_draw(const LineChart& chart) {
  const AxisRange r = x_range(chart);
  return r.span() > 1e-9 * std::max(std::abs(r.low), std::abs(r.high));  // false where there are no points
}

std::string chart_svg(const LineChart& chart) { return scatter_svg({chart, {}, {}}); }

std::string scatter_svg(const ScatterChart& drawn) {
  const ScatterChart scatter = in_logarithms(drawn);
  const LineChart& chart = scatter.chart;
  if (!can_draw(chart)) return "";
  const Plot plot = layout(scatter);
  std::string text = fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\">\n",
      chart.width, chart.height, escape_markup(chart.title));
  text += draw_bands(chart, plot) + draw_beyond(chart, plot) + draw_axes(chart, plot) + draw_errors(chart, plot) +
          draw_regions(chart, plot) + draw_areas(chart, plot);
  for (std::size_t l = 0; l < chart.lines.size(); ++l) {
    const ChartLine& line = chart.lines[l];
    if (line.filled) continue;
    if (line.points && l < scatter.styles.size())
      text += draw_marks(line, scatter.styles[l], plot);
    else if (line.beyond < line.x.size())
      text += draw_in_two(line, plot);
    else
      text +=
          fmt::format("<path class=\"{}{}\" d=\"{}\"/>\n", stroke_class(line),
                      l < scatter.styles.size() && scatter.styles[l].faint ? " faint" : "", path_of(plot, line));
  }
  if (!chart.note.empty())
    text += fmt::format("<text class=\"soft halo end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", plot.right - 6,
                        plot.bottom - 7, escape_markup(chart.note));
  return text + draw_point_labels(scatter, plot) + draw_labels(chart, plot) + "</svg>\n";
}

std::string svg_file(const std::string& body, double width, double height) {
  // Colours as they are on a light page; in place, since few programs but browsers know variables.
  const std::string all = svg_css();
  const std::size_t dark = all.find("@media screen"), after = all.find("}}", dark) + 2;
  const std::string variables = all.substr(0, dark);
  // In a file the elements have their sizes, which these rules for pages would undo.
  std::string css = all.substr(after);
  const std::string fluid = "max-width:100%;height:auto";
  css.erase(css.find(fluid), fluid.size());
  const auto in_place = [&](std::string text) {
    for (std::size_t at = text.find("var(--"); at != std::string::npos; at = text.find("var(--")) {
      const std::size_t end = text.find(')', at);
      const std::string name = text.substr(at + 4, end - at - 4) + ":";
      const std::size_t value = variables.find(name) + name.size();
      text.replace(at, end + 1 - at, variables.substr(value, variables.find_first_of(";}", value) - value));
    }
    return text;
  };
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
             "height=\"{1:.0f}\" font-family=\"Helvetica,Arial,sans-serif\" font-size=\"13\">\n<style>",
             width, height) +
         in_place(css) + "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + in_place(body) +
         "</svg>\n";
}

std::string mark_svg(Mark mark, int colour, bool hollow) {
  return "<svg class=\"chart key\" viewBox=\"0 0 16 16\" width=\"16\" height=\"16\" aria-hidden=\"true\">" +
         mark_element(mark_path(mark, 8, 8), colour, hollow, false, "") + "</svg>";
}

std::string chart_file(const ScatterChart& scatter) {
  const std::string svg = scatter_svg(scatter);
  return svg.empty() ? "" : svg_file(svg, scatter.chart.width, scatter.chart.height);
}

void write_drawing(const std::string& path, const std::string& svg, const std::string& format, double zoom,
                   const char* option) {
  Draft from(path), to(path);
  from.write(svg);
  switch (
      run_program({"rsvg-convert", "-o", to.name(), "-f", format, "-z", fmt::format("{}", zoom), from.name()})) {
    case ProgramEnd::missing:
      throw InputError({path, 0, option}, "cannot be made: rsvg-convert is missing",
                       "install librsvg2-bin, or write .svg");
    case ProgramEnd::failed:
      to.need_room();
      throw InputError({path, 0, option}, "cannot be made: rsvg-convert failed", "write .svg");
    case ProgramEnd::well:
      to.replace();
  }
}

}  // namespace ropewalk
