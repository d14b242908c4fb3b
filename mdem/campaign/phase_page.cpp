// The tables and the page of `ropewalk threshold`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "campaign/threshold.hpp"
#include "io/base64.hpp"
#include "io/csv_reader.hpp"
#include "observe/observables.hpp"
#include "report/log_figures.hpp"
#include "report/page.hpp"
#include "report/scatter.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "nan"; }

// To the digits that a run and its row in trials.csv share.
std::string rough_cell(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "nan"; }

std::string values(const PhasePoint& p) {
  std::string text;
  for (const std::string& v : p.values) text += csv_cell(v) + ",";
  return text;
}

// A diagram over the length: the points that have all else in common.
struct Diagram {
  std::string name;
  std::vector<const PhasePoint*> points;
};
std::vector<Diagram> diagrams_of(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  std::vector<Diagram> all;
  const std::vector<std::string> keys = sweep.keys();
  for (const PhasePoint& p : points) {
    std::string name = fmt::format("{} tubes", p.tubes);
    std::size_t cell = 0;  // values are without that of start.seed
    for (const std::string& key : keys) {
      if (key == "start.seed") continue;
      const std::string& value = p.values[cell++];
      if (key != "rope.length_nm" && key != "rope.tubes") name += fmt::format(", {} = {}", leaf_of(key), value);
    }
    const auto same = std::find_if(all.begin(), all.end(), [&](const Diagram& d) { return d.name == name; });
    if (same == all.end())
      all.push_back({name, {&p}});
    else
      same->points.push_back(&p);
  }
  return all;
}

struct Series {
  std::vector<double> x, y;
};
Series by_bisection(const std::vector<const PhasePoint*>& points) {
  Series s;
  for (const PhasePoint* p : points) s.x.push_back(p->length), s.y.push_back(p->by_bisection());
  return s;
}
Series by_theory(const std::vector<const PhasePoint*>& points, double (PhasePoint::*theory)() const) {
  Series s;
  for (const PhasePoint* p : points) s.x.push_back(p->length), s.y.push_back((p->*theory)());
  return s;
}
bool has_values(const Series& s) {
  return std::any_of(s.y.begin(), s.y.end(), [](double y) { return std::isfinite(y); });
}

std::string law_words(const Series& s) {
  const auto law = power_law(s.x, s.y);
  if (!law) return "has too few points for an exponent";
  return fmt::format("goes as the length to the power {}",
                     law->error > 0 ? measured_text(law->exponent, law->error)
                                    : fmt::format("{:.2f}, of two points alone", law->exponent));
}

// The title of a column or key: the words of the observable of this name, else the key without its unit.
ChartAxis axis_of_key(const std::string& key) {
  const std::string leaf = leaf_of(key);
  for (const Observable& o : observables())
    if (o.name == leaf) return column_axis(leaf);
  for (const SceneKey& k : scene_keys()) {
    if (k.key != leaf) continue;
    std::string suffix = k.unit, quantity = leaf;
    std::replace(suffix.begin(), suffix.end(), ' ', '_');
    const std::size_t at = suffix.empty() ? std::string::npos : leaf.rfind("_" + suffix);
    if (at != std::string::npos && at + 1 + suffix.size() == leaf.size()) quantity = leaf.substr(0, at);
    std::replace(quantity.begin(), quantity.end(), '_', ' ');
    return {quantity, at == std::string::npos ? "" : k.unit, false};
  }
  return {leaf, "", false};
}

std::string title_of(const std::string& key) {
  const ChartAxis axis = axis_of_key(key);
  return "Critical " + axis.quantity + (axis.unit.empty() ? "" : ", " + axis.unit);
}

ScatterChart diagram(const Sweep& sweep, const std::string& name, const std::vector<const PhasePoint*>& points) {
  ScatterChart scatter;
  LineChart& chart = scatter.chart;
  chart.title = "Phase diagram of " + name;
  chart.x = {"length", "nm", false, true};
  chart.y = axis_of_key(sweep.threshold->key);
  chart.y.decades = true;
  chart.height = 380;
  // The runs by the shape that they took, hollow where they did not pass.
  std::map<std::string, std::size_t> lines;
  for (const PhasePoint* p : points)
    for (const Threshold& seed : p->seeds)
      for (const Trial& t : seed.trials) {
        const std::string name = t.shape.empty() ? "shape not known" : t.shape;
        if (lines.emplace(name, chart.lines.size()).second) {
          ChartLine line{name, {}, {}, static_cast<int>(chart.lines.size())};
          line.points = true;
          chart.lines.push_back(line);
          scatter.styles.push_back({static_cast<Mark>(scatter.styles.size() % marks), {}, {}});
        }
        const std::size_t k = lines[name];
        chart.lines[k].x.push_back(p->length);
        chart.lines[k].y.push_back(t.value);
        scatter.styles[k].titles.push_back(
            fmt::format("{:g}: {}, {}", t.value, name, t.passed ? "passes" : "does not"));
        scatter.styles[k].hollow.push_back(!t.passed);
      }
  const auto add = [&](const char* name, const Series& s, bool dashed) {
    if (has_values(s)) chart.lines.push_back({name, s.x, s.y, static_cast<int>(chart.lines.size()), dashed});
  };
  add("by bisection", by_bisection(points), false);
  add("theory, in this time", by_theory(points, &PhasePoint::kinetic_theory), true);
  add("theory, infinite time", by_theory(points, &PhasePoint::static_theory), true);
  return scatter;
}

std::string positive_cell(double v) { return v > 0 ? fmt::format("{:.4g}", v) : std::string("–"); }

std::string off_theory(const PhasePoint& p) {
  const double off = p.by_bisection() / p.kinetic_theory() - 1;
  return std::isfinite(off) ? fmt::format("{:+.0f} %", 100 * off) : std::string("–");
}

}  // namespace

std::string thresholds_csv(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  std::string text = key_cells(sweep, sweep.keys()) +
                     "tubes,length_nm,radius_nm,seeds,by_bisection,by_bisection_error,theory,static_theory,glued_"
                     "theory,theory_windings,"
                     "winding,rate_over_theory,rates,falling_seeds,unclear_seeds,outside_seeds,cut_short_runs\n";
  for (const PhasePoint& p : points)
    text += values(p) +
            fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.tubes, cell(p.length),
                        cell(p.radius), p.seeds.size(), cell(p.by_bisection()), cell(p.bisection_error()),
                        rough_cell(p.kinetic_theory()), cell(p.static_theory()), cell(p.glued_theory()),
                        rough_cell(p.theory_windings()), rough_cell(p.winding()), rough_cell(p.rate_over_theory()),
                        p.rates(), p.falling_seeds(), p.unclear_seeds(), p.outside_seeds(), p.cut_short_runs());
  return text;
}

std::string trials_csv(const Sweep& sweep, const std::vector<PhasePoint>& points) {
  std::string text = key_cells(sweep, sweep.keys()) + column_names(trial_columns()) + "\n";
  for (const PhasePoint& p : points)
    for (std::size_t s = 0; s < p.seeds.size(); ++s)
      for (const Trial& t : p.seeds[s].trials)
        text +=
            values(p) + fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", s + 1, cell(t.value), t.passed ? 1 : 0,
                                    cell(t.passed || t.cut_short ? t.time : nan), cell(t.rate.value_or(nan)),
                                    cell(t.error.value_or(nan)), cell(t.turn ? *t.turn / units::degree : nan),
                                    t.shape, t.first_limit, cell(t.first_limit_time.value_or(nan)), t.scene_hash);
  return text;
}

std::string phase_page(const Sweep& sweep, const std::vector<PhasePoint>& points,
                       const std::vector<StatePicture>& states) {
  const ThresholdQuestion& q = *sweep.threshold;
  Figures figures;
  std::string html = page_head("Thresholds") +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: critical values</p>\n<h1>" +
                     escape_markup(title_of(q.key)) + "</h1>\n";
  html +=
      paragraph(escape_markup(fmt::format("The critical {}: {} within the time of the scene, narrowed to {:g} % of "
                                          "the value. Errors are standard errors over seeds and "
                                          "brackets.",
                                          q.key,
                                          q.shape ? fmt::format("where the rope becomes a {},", name_of(*q.shape))
                                                  : fmt::format("where {} passes {:g}", q.column, q.above),
                                          100 * q.accuracy)));
  const bool theory = std::any_of(points.begin(), points.end(),
                                  [](const PhasePoint& p) { return std::isfinite(p.static_theory()); });
  html +=
      "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th>point</th><th>tubes</th><th>length, "
      "nm</th><th>length/radius</th><th>by bisection</th>";
  if (theory) html += "<th>theory, in this time</th><th>deviation from theory</th>";
  html += "</tr></thead><tbody>\n";
  for (const PhasePoint& p : points) {
    html += fmt::format(
        "<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", escape_markup(p.name), p.tubes,
        positive_cell(p.length), positive_cell(p.radius > 0 ? p.length / p.radius : 0),
        escape_markup((std::isfinite(p.by_bisection()) ? measured_text(p.by_bisection(), p.bisection_error())
                       : p.begun()                     ? "not in the range"
                                                       : "not run yet") +
                      (p.remarks().empty() ? "" : "; " + p.remarks())));
    if (theory) html += fmt::format("<td>{}</td><td>{}</td>", positive_cell(p.kinetic_theory()), off_theory(p));
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (theory) {
    html += paragraph(escape_markup(
        "Theory: tubes that slide on each other against the viscosity of their contacts bend as one rod with the "
        "stiffness EI and the mass of one tube. Under couples of fixed direction on free ends a helix grows from "
        "8.987 EI/L on each tube on, if one waits long enough. The threshold for the time of the scene is the moment "
        "at which half of the initial wave grows, during ramp and hold, to the size that the search asks for. The "
        "winding "
        "is the measured turn of the rope over ML/EI: 1 for tubes without contact forces, less in a rope that "
        "stays packed. The turns of the helix are those of the helix that grows fastest. Glued tubes would need EI "
        "+ EA⟨ρ²⟩/2 in place of EI."));
    html +=
        "<div class=\"scroll\"><table class=\"facts numbers\"><thead><tr><th>point</th><th>infinite waiting "
        "time</th><th>glued "
        "tubes</th><th>turns of the helix</th><th>winding</th><th>growth rate / theory "
        "(runs)</th></tr></thead><tbody>\n";
    for (const PhasePoint& p : points) {
      html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                          escape_markup(p.name), positive_cell(p.static_theory()), positive_cell(p.glued_theory()),
                          positive_cell(p.theory_windings()), positive_cell(p.winding()),
                          p.rates() > 0 ? fmt::format("{:.2f} ({})", p.rate_over_theory(), p.rates()) : "–");
    }
    html += "</tbody></table></div>\n";
  }
  for (const auto& [name, some] : diagrams_of(sweep, points)) {
    const std::string svg = scatter_svg(diagram(sweep, name, some));
    if (svg.empty()) continue;
    const Series foreseen = by_theory(some, &PhasePoint::kinetic_theory);
    html += heading(escape_markup(name)) + "<figure>" + svg +
            figures.caption(escape_markup(
                fmt::format("Each mark is a run, with the shape that the rope took; it is filled where the run "
                            "passed. Lines are thresholds. By bisection the threshold {}{}.",
                            law_words(by_bisection(some)),
                            has_values(foreseen) ? "; by theory it " + law_words(foreseen) : std::string()))) +
            "</figure>\n";
  }
  if (!states.empty()) {
    html += heading("States") +
            paragraph(
                "The last state of the runs next to each threshold. Each run has a report of its own in the "
                "directory of its point.");
    html += "<div class=\"pair\">\n";
    for (const StatePicture& s : states)
      html += "<figure><img alt=\"" + escape_markup(s.words) + "\" src=\"data:image/svg+xml;base64," +
              base64(s.svg) + "\">" + figures.caption(escape_markup(s.words + ".")) + "</figure>\n";
    html += "</div>\n";
  }
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace ropewalk
