// The tables and the page of `ropewalk threshold`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "campaign/threshold.hpp"
#include "io/csv_reader.hpp"
#include "report/page.hpp"
#include "report/scatter.hpp"

namespace ropewalk {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "nan"; }

std::vector<std::string> keys_without_seed(const Sweep& sweep) {
  std::vector<std::string> keys = sweep.keys();
  keys.erase(std::remove(keys.begin(), keys.end(), "start.seed"), keys.end());
  return keys;
}

std::string head(const Sweep& sweep) {
  std::string text;
  for (const std::string& key : keys_without_seed(sweep)) text += key + ",";
  return text;
}

std::string values(const PhasePoint& p) {
  std::string text;
  for (const std::string& v : p.values) text += csv_cell(v) + ",";
  return text;
}

// By the number of tubes, which a diagram has a line for.
std::map<int, std::vector<const PhasePoint*>> by_size(const std::vector<PhasePoint>& points) {
  std::map<int, std::vector<const PhasePoint*>> out;
  for (const PhasePoint& p : points) out[p.tubes].push_back(&p);
  return out;
}

struct Series {
  std::vector<double> x, y;
};
Series by_bisection(const std::vector<const PhasePoint*>& points) {
  Series s;
  for (const PhasePoint* p : points) s.x.push_back(p->length), s.y.push_back(p->by_bisection());
  return s;
}
Series by_growth(const std::vector<const PhasePoint*>& points) {
  Series s;
  for (const PhasePoint* p : points) {
    const auto g = p->by_growth();
    s.x.push_back(p->length);
    s.y.push_back(g ? g->critical : nan);
  }
  return s;
}

std::string law_words(const Series& s) {
  const auto law = power_law(s.x, s.y);
  if (!law) return "has too few points for an exponent";
  return fmt::format("goes as the length to the power {}",
                     law->error > 0 ? measured_text(law->exponent, law->error)
                                    : fmt::format("{:.2f}, of two points alone", law->exponent));
}

ScatterChart diagram(const Sweep& sweep, int tubes, const std::vector<const PhasePoint*>& points) {
  ScatterChart scatter;
  scatter.x_decades = scatter.y_decades = true;
  LineChart& chart = scatter.chart;
  chart.title = fmt::format("Phase diagram of {} tubes", tubes);
  chart.x = {"length", "nm", false};
  chart.y = {leaf_of(sweep.threshold->key), "", false};
  chart.height = 380;
  ChartLine yes{"passes", {}, {}, 1}, no{"does not", {}, {}, 0};
  yes.points = no.points = true;
  for (const PhasePoint* p : points)
    for (const Threshold& seed : p->seeds)
      for (const Trial& t : seed.trials) {
        ChartLine& line = t.passed ? yes : no;
        line.x.push_back(p->length);
        line.y.push_back(t.value);
      }
  const Series bisection = by_bisection(points), growth = by_growth(points);
  chart.lines = {yes, no, {"by bisection", bisection.x, bisection.y, 2}, {"by growth", growth.x, growth.y, 3}};
  ChartLine sliding{"sliding tubes", {}, {}, 5, true}, glued{"glued tubes", {}, {}, 4, true};
  for (const PhasePoint* p : points) {
    sliding.x.push_back(p->length);
    sliding.y.push_back(p->sliding > 0 ? p->sliding : nan);
    glued.x.push_back(p->length);
    glued.y.push_back(p->glued > 0 ? p->glued : nan);
  }
  if (!points.empty() && points.front()->sliding > 0) {
    chart.lines.push_back(sliding);
    // Far above all else, it would press the rest together.
    if (points.front()->glued < 3 * sweep.threshold->to) chart.lines.push_back(glued);
  }
  return scatter;
}

}  // namespace

std::string thresholds_csv(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  std::string text =
      head(sweep) +
      "tubes,length_nm,radius_nm,seeds,by_bisection,by_bisection_error,by_growth,by_growth_error,"
      "growing_runs,sliding_tubes,glued_tubes,falling_seeds,unclear_seeds,outside_seeds,cut_short_runs\n";
  for (const PhasePoint& p : points) {
    const auto growth = p.by_growth();
    text += values(p) + fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.tubes, cell(p.length),
                                    cell(p.radius), p.seeds.size(), cell(p.by_bisection()),
                                    cell(p.bisection_error()), cell(growth ? growth->critical : nan),
                                    cell(growth ? growth->error : nan), growth ? growth->runs : 0,
                                    cell(p.sliding > 0 ? p.sliding : nan), cell(p.glued > 0 ? p.glued : nan),
                                    p.falling_seeds(), p.unclear_seeds(), p.outside_seeds(), p.cut_short_runs());
  }
  return text;
}

std::string trials_csv(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  std::string text = head(sweep) + column_names(trial_columns()) + "\n";
  for (const PhasePoint& p : points)
    for (std::size_t s = 0; s < p.seeds.size(); ++s)
      for (const Trial& t : p.seeds[s].trials)
        text += values(p) + fmt::format("{},{},{},{},{},{},{}\n", s + 1, cell(t.value), t.passed ? 1 : 0,
                                        cell(t.passed || t.cut_short ? t.time : nan), cell(t.rate.value_or(nan)),
                                        cell(t.error.value_or(nan)), t.scene_hash);
  return text;
}

std::string phase_page(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  const ThresholdQuestion& q = *sweep.threshold;
  Figures figures;
  std::string html = page_head("Thresholds") +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: critical values</p>\n<h1>" +
                     escape_markup(q.key) + "</h1>\n";
  html +=
      paragraph(escape_markup(fmt::format("Where {} passes {:g}. By bisection: within the time of the scene, "
                                          "narrowed to {:g} % of the value. By growth: where "
                                          "the square of the rate of its exponential growth, extrapolated over the "
                                          "runs that passed, goes to zero; a longer run "
                                          "does not change it. Errors are standard errors over seeds and fits.",
                                          q.column, q.above, 100 * q.accuracy)));
  html +=
      "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th>point</th><th>tubes</th><th>length, "
      "nm</th><th>length/radius</th><th>by bisection</th><th>by growth</th><th>runs that grow</th><th>theory, "
      "sliding tubes</th><th>glued tubes</th></tr></thead><tbody>\n";
  for (const PhasePoint& p : points) {
    const auto growth = p.by_growth();
    const auto number = [](double v) { return v > 0 ? fmt::format("{:.4g}", v) : std::string("–"); };
    html += fmt::format(
        "<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}"
        "</td></tr>\n",
        escape_markup(p.name), p.tubes, number(p.length), number(p.radius > 0 ? p.length / p.radius : 0),
        escape_markup((std::isfinite(p.by_bisection()) ? measured_text(p.by_bisection(), p.bisection_error())
                                                       : "not in the range") +
                      (p.remarks().empty() ? "" : "; " + p.remarks())),
        growth ? measured_text(growth->critical, growth->error) : "–", growth ? growth->runs : 0, number(p.sliding),
        number(p.glued));
  }
  html += "</tbody></table></div>\n";
  for (const auto& [tubes, some] : by_size(points)) {
    const std::string svg = scatter_svg(diagram(sweep, tubes, some));
    if (svg.empty()) continue;
    html += heading(fmt::format("{} tubes", tubes)) + "<figure>" + svg +
            figures.caption(escape_markup(
                fmt::format("Every run, and the thresholds. By bisection it {}; by growth it {}. Theory: a rope "
                            "whose ends may tilt, of "
                            "tubes that slide on each other freely, 2 pi EI/L for each of them, and of glued ones.",
                            law_words(by_bisection(some)), law_words(by_growth(some))))) +
            "</figure>\n";
  }
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace ropewalk
