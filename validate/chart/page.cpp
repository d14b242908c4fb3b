// The page of the chart: for each scene and observable cost against error, with the Pareto front.

#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "chart/chart.hpp"
#include "chart/kinds.hpp"
#include "chart/overview.hpp"
#include "model/contact/line_parameters.hpp"
#include "report/scatter.hpp"

namespace ropewalk::validate {
namespace {

constexpr double smallest_error = 1e-5, largest_error = 0.3;  // points beyond are drawn here, hollow
constexpr double much = 10;                                   // times as cheap

// Measured cost of another program for a step of this scene's rope; its accuracy is not known.
struct Peer {
  const char* name;
  const char* scene;
  double seconds_per_element_step;
  double time_step;  // ps
  const char* remark;
};
constexpr Peer peers[] = {
    {"waLBerla", "rope91", 22.5e-6, 20e-3,
     "waLBerla MESA-PD CNT, the published law, one core, 91 x 50 elements of 1.356 nm: 22.5 us per element-step, "
     "plotted for steps of 20 fs"},
    {"LAMMPS mesocnt", "rope91", 1 / (55.0 * 91 * 50), 20e-3,
     "LAMMPS mesocnt, one rank, 91 x 50 elements: 55 steps per second, plotted for steps of 20 fs. It has no "
     "torsion and cannot run this scene"},
};

std::vector<const ChartRow*> rows_of(const std::vector<ChartRow>& rows, const std::string& scene,
                                     const std::string& observable, const std::string& kind) {
  std::vector<const ChartRow*> out;
  for (const ChartRow& r : rows)
    if (r.point->scene == scene && r.observable == observable && r.reference_kind == kind &&
        !(kind == "finest" && r.point->model == finest_model))
      out.push_back(&r);
  return out;
}

struct Series {
  std::vector<double> cost, error;
};
Series series_of(const std::vector<const ChartRow*>& rows) {
  Series s;
  for (const ChartRow* r : rows) {
    s.cost.push_back(r->point->cpu_per_ns());
    s.error.push_back(r->error);
  }
  return s;
}

// --- Figures ---

double drawn(double error) { return 100 * std::clamp(error, smallest_error, largest_error); }
bool beyond(double error) { return error < smallest_error || error > largest_error; }

ChartLine front_line(const Series& s, const std::vector<std::size_t>& front) {
  ChartLine line;
  line.colour = 5;
  line.steps = true;
  for (const std::size_t k : front) {
    line.x.push_back(s.cost[k]);
    line.y.push_back(drawn(s.error[k]));
  }
  return line;
}

// The text that a reader sees who points at a model.
std::string title_of(const ChartRow& r) {
  return fmt::format("{}: {} % off, {} s per ns, {} elements, steps of {} fs", model_words(r.point->model),
                     number_text(100 * r.error, 3), number_text(r.point->cpu_per_ns(), 3), r.point->elements,
                     r.point->mode == "relax" ? "-" : number_text(r.point->time_step / units::fs, 3));
}

// Adds the models by kind; those on the front have its numbers, from the cheapest.
void add_kinds(const std::vector<const ChartRow*>& rows, const std::vector<std::size_t>& front,
               ScatterChart& scatter) {
  for (const ChartRow* r : rows) style_of(r->point->kind);  // every kind has one
  for (const KindStyle& kind : kind_styles) {
    ChartLine line;
    line.colour = kind.colour;
    line.points = true;
    PointStyle style;
    style.mark = kind.mark;
    std::vector<std::string> labels;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k]->point->kind != kind.kind) continue;
      line.x.push_back(rows[k]->point->cpu_per_ns());
      line.y.push_back(drawn(rows[k]->error));
      style.titles.push_back(title_of(*rows[k]));
      style.hollow.push_back(beyond(rows[k]->error));
      const auto at = std::find(front.begin(), front.end(), k);
      labels.push_back(at == front.end() ? "" : std::to_string(at - front.begin() + 1));
    }
    if (line.x.empty()) continue;
    scatter.chart.lines.push_back(line);
    scatter.labels.push_back(labels);
    scatter.styles.resize(scatter.chart.lines.size());
    scatter.styles.back() = style;
  }
}

double peer_cost(const Peer& peer, const ChartPoint& published) {
  return peer.seconds_per_element_step * published.elements * 1e3 / peer.time_step;
}

// A line at its cost, since its error is not known, and a mark that names its source.
void add_peers(const std::vector<const ChartRow*>& rows, ScatterChart& scatter) {
  LineChart& chart = scatter.chart;
  double low = 1e300, high = 0;
  for (const ChartRow* r : rows) {
    low = std::min(low, drawn(r->error));
    high = std::max(high, drawn(r->error));
  }
  const ChartPoint* published = nullptr;
  for (const ChartRow* r : rows)
    if (r->point->model == published_model) published = r->point;
  for (const Peer& peer : peers) {
    if (!published || published->scene != peer.scene) continue;
    ChartLine line;
    line.name = peer.name;
    line.colour = 5;
    line.dashed = true;
    line.x = {peer_cost(peer, *published), peer_cost(peer, *published)};
    line.y = {low, high};
    chart.lines.push_back(line);
    ChartLine mark;
    mark.colour = 5;
    mark.points = true;
    mark.x = {line.x.back()};
    mark.y = {line.y.back()};
    chart.lines.push_back(mark);
    scatter.styles.resize(chart.lines.size());
    scatter.styles.back() = {Mark::triangle, {peer.remark}, {true}};
  }
}

std::string front_names(const std::vector<const ChartRow*>& rows, const std::vector<std::size_t>& front) {
  std::string names;
  for (std::size_t k = 0; k < front.size(); ++k)
    names += fmt::format("{}{} {} ({} %)", names.empty() ? "" : "; ", k + 1,
                         model_words(rows[front[k]]->point->model), number_text(100 * rows[front[k]]->error, 2));
  return names;
}

std::string figure_html(const ChartScene& scene, const std::string& observable, const std::string& kind,
                        const std::vector<ChartRow>& all, Figures& figures) {
  const std::vector<const ChartRow*> rows = rows_of(all, scene.name, observable, kind);
  const Series s = series_of(rows);
  const std::vector<std::size_t> front = pareto_front(s.cost, s.error);
  ScatterChart scatter;
  scatter.labels.resize(1);  // the front has no labels
  LineChart& chart = scatter.chart;
  const std::string against = kind == "md" ? "atoms" : "the finest model";
  chart.title = fmt::format("{}: error of the {} against cost", scene.title, observable_title(observable));
  chart.x = {"CPU time per simulated ns", "s", false, true};
  chart.y = {"error of the " + observable_title(observable), "%", false, true};
  chart.width = 520;
  chart.height = 340;
  chart.lines = {front_line(s, front)};
  add_kinds(rows, front, scatter);
  add_peers(rows, scatter);
  const std::string svg = scatter_svg(scatter);
  if (svg.empty()) return "";
  return "<figure>" + svg +
         figures.caption(fmt::format(
             "<b>{}</b> against {}: {} {}. Front, from the cheapest: {}.",
             escape_markup(observable_title(observable)), against, number_text(rows.front()->reference, 6),
             escape_markup(observable_unit(observable)), escape_markup(front_names(rows, front)))) +
         "</figure>\n";
}

// --- Tables ---

// The model's error in an observable; empty where there is none.
std::string error_cell(const std::vector<ChartRow>& rows, const ChartPoint& p, const std::string& observable,
                       const std::string& kind) {
  for (const ChartRow& r : rows)
    if (r.point == &p && r.observable == observable && r.reference_kind == kind)
      return number_text(100 * r.error, 2);
  return "";
}

std::string points_table(const ChartScene& scene, const std::vector<ChartPoint>& points,
                         const std::vector<ChartRow>& rows) {
  std::string html =
      "<details><summary>All models of this scene</summary>\n<div class=\"scroll\"><table "
      "class=\"facts\"><thead><tr>"
      "<th>Model</th><th>Name in points.csv</th><th class=\"number\">Elements</th><th class=\"number\">Step, "
      "fs</th>"
      "<th class=\"number\">s per ns</th><th class=\"number\">ns per element-step</th>"
      "<th class=\"number\">10<sup>9</sup> instructions per ns</th>";
  std::vector<std::pair<std::string, std::string>> columns;
  const std::vector<ChartReference> atoms = scene.atoms();
  for (const std::string& o : scene.observables) {
    columns.emplace_back(o, "finest");
    for (const ChartReference& a : atoms)
      if (a.observable == o) columns.emplace_back(o, "md");
  }
  for (const auto& [o, kind] : columns)
    html += fmt::format("<th class=\"number\">{}, % of {}</th>", escape_markup(observable_title(o)),
                        kind == "md" ? "atoms" : "finest");
  html += "</tr></thead><tbody>\n";
  for (const ChartPoint& p : points) {
    if (p.scene != scene.name) continue;
    html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>",
                        escape_markup(model_words(p.model)), escape_markup(p.model), p.elements,
                        p.mode == "relax" ? "" : number_text(p.time_step / units::fs, 3));
    if (!p.error.empty()) {
      html += fmt::format("<td colspan=\"{}\">could not be run: {}</td></tr>\n", columns.size() + 3,
                          escape_markup(p.error));
      continue;
    }
    html += fmt::format("<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>",
                        number_text(p.cpu_per_ns(), 3), number_text(1e9 * p.cpu_per_element_step(), 3),
                        p.instructions ? number_text(1e-9 * *p.instructions * p.element_steps_per_ns(), 3) : "");
    for (const auto& [o, kind] : columns) html += "<td class=\"number\">" + error_cell(rows, p, o, kind) + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div></details>\n";
}

// --- Against the published model ---

struct Beaten {
  const ChartPoint* point = nullptr;
  double times_cheaper = 0;
  double worst = 0;  // error against atoms, of all observables
};

// Models that are cheaper than the published one and not farther from the atoms in any observable.
std::vector<Beaten> better_than_published(const ChartScene& scene, const std::vector<ChartPoint>& points,
                                          const std::vector<ChartRow>& rows) {
  std::map<std::string, double> bar;
  const ChartPoint* published = nullptr;
  for (const ChartRow& r : rows)
    if (r.point->scene == scene.name && r.point->model == published_model && r.reference_kind == "md") {
      bar[r.observable] = r.error;
      published = r.point;
    }
  std::vector<Beaten> out;
  for (const ChartPoint& p : points) {
    if (!published || p.scene != scene.name || !p.error.empty() || &p == published) continue;
    Beaten b{&p, published->cpu_per_ns() / p.cpu_per_ns(), 0};
    bool holds = true;
    for (const ChartRow& r : rows) {
      if (r.point != &p || r.reference_kind != "md") continue;
      holds = holds && r.error <= bar.at(r.observable);
      b.worst = std::max(b.worst, r.error);
    }
    if (holds && b.times_cheaper > 1) out.push_back(b);
  }
  std::sort(out.begin(), out.end(),
            [](const Beaten& a, const Beaten& b) { return a.times_cheaper > b.times_cheaper; });
  return out;
}

std::string published_part(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows) {
  std::string html =
      heading("Against the published model") +
      paragraph(
          "An error against atoms is the sum of the errors of the model and of its discretisation, and these may "
          "cancel. The finest model is not equal to the atoms; a coarse model may lie between the two by chance. "
          "The errors against the finest model, below, are those of the discretisation alone.");
  for (const ChartScene& scene : chart_scenes()) {
    const std::vector<Beaten> better = better_than_published(scene, points, rows);
    const bool there = std::any_of(rows.begin(), rows.end(), [&](const ChartRow& r) {
      return r.point->scene == scene.name && r.reference_kind == "md" && r.point->model == published_model;
    });
    if (!there) continue;
    std::string text = fmt::format("<b>{}.</b> ", escape_markup(scene.title));
    if (better.empty() || better.front().times_cheaper < much)
      text += fmt::format("No model is {:g} times cheaper without a larger error against atoms.  ", much);
    for (std::size_t k = 0; k < std::min<std::size_t>(4, better.size()); ++k)
      text += fmt::format("{}<i>{}</i>: {} times cheaper, at most {} % from the atoms", k > 0 ? "; " : "",
                          escape_markup(model_words(better[k].point->model)),
                          number_text(better[k].times_cheaper, 3), number_text(100 * better[k].worst, 2));
    html += paragraph(text + (better.empty() ? "" : "."));
  }
  return html;
}

// --- Good enough ---

constexpr double tolerances[] = {0.005, 0.01, 0.02, 0.05};

// The cheapest model whose observables all lie within this tolerance of the finest.
const ChartPoint* cheapest_within(const ChartScene& scene, double tolerance, const std::vector<ChartPoint>& points,
                                  const std::vector<ChartRow>& rows) {
  const ChartPoint* cheapest = nullptr;
  for (const ChartPoint& p : points) {
    if (p.scene != scene.name || !p.error.empty()) continue;
    const bool holds = std::all_of(rows.begin(), rows.end(), [&](const ChartRow& r) {
      return r.point != &p || r.reference_kind != "finest" || r.error <= tolerance;
    });
    if (holds && (!cheapest || p.cpu_per_ns() < cheapest->cpu_per_ns())) cheapest = &p;
  }
  return cheapest;
}

std::string good_enough_part(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows) {
  std::string html = heading("Good enough") +
                     paragraph(
                         "The cheapest model whose observables <i>all</i> lie within the tolerance of the finest "
                         "model. In brackets: cost of the default over its cost.") +
                     "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>Scene</th>";
  for (const double t : tolerances) html += fmt::format("<th>within {:g} %</th>", 100 * t);
  html += "</tr></thead><tbody>\n";
  for (const ChartScene& scene : chart_scenes()) {
    const auto ours = std::find_if(points.begin(), points.end(), [&](const ChartPoint& p) {
      return p.scene == scene.name && p.model == default_model && p.error.empty();
    });
    if (ours == points.end()) continue;
    html += "<tr><th>" + escape_markup(scene.title) + "</th>";
    for (const double t : tolerances) {
      const ChartPoint* p = cheapest_within(scene, t, points, rows);
      html += p ? fmt::format("<td>{} ({})</td>", escape_markup(model_words(p->model)),
                              number_text(ours->cpu_per_ns() / p->cpu_per_ns(), 2))
                : "<td></td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

// The numbers that make ropes of different tubes alike.
std::string scenes_table(const std::vector<ChartRow>& rows) {
  std::string html =
      heading("The scenes") +
      paragraph(
          "In units of the tube's radius r, so that other tubes can be compared. R is the radius of the "
          "outermost axes, tau the twist per length of the rope or, under a moment, of its tubes; gamma "
          "the depth of the well of two parallel tubes per length.") +
      "<div class=\"scroll\"><table class=\"facts\"><thead><tr><th>Scene</th><th class=\"number\">tubes</th>"
      "<th class=\"number\">r, nm</th><th class=\"number\">r tau</th><th class=\"number\">R tau</th>"
      "<th class=\"number\">element/r</th><th class=\"number\">gamma r<sup>2</sup>/EI</th></tr></thead><tbody>\n";
  for (const ChartScene& scene : chart_scenes()) {
    if (std::none_of(rows.begin(), rows.end(), [&](const ChartRow& r) { return r.point->scene == scene.name; }))
      continue;
    const Specimen s = scene.build(ChartModel());
    const ParameterSet& set = s.scene.parameters();
    const Topology& t = s.topology;
    const double length = (t.length_of(0) - 1) * s.scene.element_length;
    const double twist = s.moment > 0 ? s.moment / set.bond.twist : s.angle / length;
    double outermost = 0;
    for (std::size_t i = 0; i < s.state.size(); ++i)
      outermost = std::max(outermost, Vector3(s.state.position[i]).head<2>().norm());
    const bool rope = s.is_rope && t.tubes() > 2, turned = rope || !scene.contact;
    html += fmt::format(
        "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        escape_markup(scene.title), t.tubes(), number_text(set.radius, 3),
        turned ? number_text(set.radius * twist, 2) : "", rope ? number_text(outermost * twist, 2) : "",
        number_text(s.element / set.radius, 3),
        scene.contact
            ? number_text(
                  std::fabs(set.law<LineParameters>()->pair_energy) * set.radius * set.radius / set.bond.bend, 2)
            : "");
  }
  return html + "</tbody></table></div>\n";
}

std::string lead() {
  return "Which numerical setting saves time, and what it costs in accuracy. Every mark is a model that differs "
         "from "
         "the default in one setting, or in a few. Point at it for its numbers.";
}

std::string reading_part() {
  return heading("Scene by scene") +
         paragraph(
             "Cost is CPU time of one thread per simulated nanosecond; for a relaxation, per nanosecond of the "
             "ramp "
             "and hold that it replaces. Errors are against the finest model (half the element length, all nodes, "
             "double precision) and, where there are results of atoms, against atoms. Both axes are logarithmic. "
             "No "
             "model is both cheaper and more accurate than one on the Pareto front, the line; its models are "
             "numbered and named below each figure. Each scene and observable has its own front. Instructions, "
             "where "
             "counted, are those of the AVX2 kernels by callgrind, which do not depend on the load of the "
             "machine.") +
         fmt::format("<p class=\"legend\">{}<span>{} hollow: error below {:g} or above {:g} %</span></p>\n",
                     kinds_legend(""), mark_svg(Mark::dot, 5, true), 100 * smallest_error, 100 * largest_error);
}

}  // namespace

std::string chart_page(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows,
                       const std::vector<std::string>& facts) {
  Figures figures;
  std::string html = page_head("Speed against accuracy") +
                     "<body>\n<main>\n<p class=\"kicker\">Ropewalk: which settings pay</p>\n<h1>Speed against "
                     "accuracy</h1>\n<p class=\"lead\">" +
                     lead() + "</p>\n" + overview_part(points, rows, figures) + published_part(points, rows) +
                     good_enough_part(points, rows) + scenes_table(rows) + reading_part();
  for (const ChartScene& scene : chart_scenes()) {
    std::string part;
    for (const std::string& o : scene.observables)
      for (const char* kind : {"md", "finest"})
        if (!rows_of(rows, scene.name, o, kind).empty()) part += figure_html(scene, o, kind, rows, figures);
    if (part.empty()) continue;
    html += heading(scene.title) + paragraph(escape_markup(scene.setup)) + "<div class=\"pair\">\n" + part +
            "</div>\n" + points_table(scene, points, rows);
  }
  html += heading("Other programs");
  for (const Peer& peer : peers) html += paragraph(escape_markup(std::string(peer.remark) + "."));
  html += heading("How this page was made");
  for (const std::string& f : facts) html += paragraph(escape_markup(f));
  return html + "</main>\n</body>\n</html>\n";
}

}  // namespace ropewalk::validate
