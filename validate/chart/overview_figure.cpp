// The first figure of the page: all scenes in one, with what follows from it in words.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "chart/kinds.hpp"
#include "chart/overview.hpp"

namespace ropewalk::validate {
namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();
// Single scenes beyond are drawn at these edges, hollow.
constexpr double least_time = 0.05, most_time = 10, least_error = 1e-4, most_error = 1;
constexpr double wide = 2;  // quartiles of the time that are so many times apart have a bar
constexpr const char* combined = "combination";

// Settings one by one; of several together those that are not wrong, and that no model beats in the medians of cost
// and error.
std::vector<ModelPlaces> shown(const std::vector<ModelPlaces>& all) {
  std::size_t most = 0;
  for (const ModelPlaces& m : all) most = std::max(most, m.scenes.size());
  std::vector<const ModelPlaces*> compared;  // models that half of the scenes or more have
  std::vector<double> cost, error;
  for (const ModelPlaces& m : all) {
    if (2 * m.scenes.size() < most) continue;
    compared.push_back(&m);
    cost.push_back(m.cost.median);
    error.push_back(m.error.median);
  }
  std::vector<const ModelPlaces*> best;
  for (const std::size_t k : pareto_front(cost, error)) best.push_back(compared[k]);
  std::vector<ModelPlaces> out;
  for (const ModelPlaces& m : all)
    if (m.kind != combined || (worth_of(m) != Worth::wrong && std::count(best.begin(), best.end(), &m) > 0))
      out.push_back(m);
  return out;
}

const std::string& scene_title(const std::string& name) { return find_chart_scene(name).title; }

std::string percent(double error) { return number_text(100 * error, 2) + "\u00a0%"; }

std::string place_title(const ModelPlaces& m, const ScenePlace& p) {
  return fmt::format("{}, scene “{}”: {} of the time of the default, {} off ({}); the default {}", m.words,
                     scene_title(p.point->scene), number_text(p.cost, 2), percent(p.error),
                     observable_title(p.observable), percent(p.default_error));
}

std::string median_title(const ModelPlaces& m) {
  return fmt::format(
      "{}, median of {} scenes: {} of the time of the default ({} to {}), {} off ({} to {}); the default {}",
      m.words, m.scenes.size(), number_text(m.cost.median, 2), number_text(m.cost.lower, 2),
      number_text(m.cost.upper, 2), percent(m.error.median), percent(m.error.lower), percent(m.error.upper),
      percent(m.default_error));
}

// --- The figure ---

void add(ScatterChart& scatter, const ChartLine& line, const PointStyle& style,
         const std::vector<std::string>& labels) {
  scatter.chart.lines.push_back(line);
  scatter.styles.push_back(style);
  scatter.labels.push_back(labels);
}

ChartLine empty_line(const KindStyle& kind, bool points) {
  ChartLine line;
  line.colour = kind.colour;
  line.points = points;
  return line;
}

void add_scenes(const KindStyle& kind, const std::vector<ModelPlaces>& models, ScatterChart& scatter) {
  ChartLine line = empty_line(kind, true);
  PointStyle style;
  style.mark = kind.mark;
  style.faint = true;
  for (const ModelPlaces& m : models)
    for (const ScenePlace& p : m.scenes) {
      if (m.kind != kind.kind) continue;
      line.x.push_back(std::clamp(p.cost, least_time, most_time));
      line.y.push_back(100 * std::clamp(p.error, least_error, most_error));
      style.hollow.push_back(line.x.back() != p.cost || line.y.back() != 100 * p.error);
      style.titles.push_back(place_title(m, p));
    }
  add(scatter, line, style, {});
}

// Cross from quartile to quartile, through the median.
void add_bars(const KindStyle& kind, const std::vector<ModelPlaces>& models, ScatterChart& scatter) {
  ChartLine line = empty_line(kind, false);
  for (const ModelPlaces& m : models) {
    if (m.kind != kind.kind) continue;
    const double x = m.cost.median, y = 100 * m.error.median;
    line.x.insert(line.x.end(), {x, x, gap});
    line.y.insert(line.y.end(),
                  {100 * std::max(m.error.lower, least_error), 100 * std::min(m.error.upper, most_error), gap});
    if (m.cost.upper < wide * m.cost.lower) continue;
    line.x.insert(line.x.end(), {std::max(m.cost.lower, least_time), std::min(m.cost.upper, most_time), gap});
    line.y.insert(line.y.end(), {y, y, gap});
  }
  PointStyle style;
  style.faint = true;
  add(scatter, line, style, {});
}

void add_median(const ModelPlaces& m, ScatterChart& scatter) {
  const KindStyle& kind = style_of(m.kind);
  ChartLine line = empty_line(kind, true);
  line.x = {m.cost.median};
  line.y = {100 * m.error.median};
  PointStyle style;
  style.mark = kind.mark;
  style.titles = {median_title(m)};
  add(scatter, line, style, {m.words});
}

// The default, single settings, several together; each from the cheapest. Where there is little room the first ones
// have their names.
std::vector<ModelPlaces> in_order_of_names(std::vector<ModelPlaces> models) {
  const auto rank = [](const ModelPlaces& m) { return m.model == default_model ? 0 : m.kind == combined ? 2 : 1; };
  std::stable_sort(models.begin(), models.end(), [&](const ModelPlaces& a, const ModelPlaces& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.cost.median < b.cost.median;
  });
  return models;
}

// Cheaper models are on its left, better ones below it.
void add_cross(const ModelPlaces& ours, ScatterChart& scatter) {
  ChartLine across, upright;
  across.colour = upright.colour = style_of(ours.kind).colour;
  across.dashed = upright.dashed = true;
  across.x = {least_time, most_time};
  across.y = {100 * ours.error.median, 100 * ours.error.median};
  upright.x = {1, 1};
  upright.y = {100 * least_error, 100 * most_error};
  add(scatter, across, {}, {});
  add(scatter, upright, {}, {});
}

std::string figure_svg(const std::vector<ModelPlaces>& models, const ModelPlaces& ours) {
  ScatterChart scatter;
  scatter.names_keep_apart = true;
  LineChart& chart = scatter.chart;
  chart.title = "All scenes: error of every model against its time, relative to the default";
  chart.x = {"time over that of the default", "", false, true};
  chart.y = {"largest error of a scene's observables", "%", false, true};
  chart.width = 820;
  chart.height = 560;
  add_cross(ours, scatter);
  for (const KindStyle& kind : kind_styles) add_scenes(kind, models, scatter);
  for (const KindStyle& kind : kind_styles) add_bars(kind, models, scatter);
  for (const ModelPlaces& m : in_order_of_names(models)) add_median(m, scatter);
  return scatter_svg(scatter);
}

// --- What follows ---

std::string verdict(const char* words, Worth worth, const std::vector<ModelPlaces>& models) {
  std::vector<const ModelPlaces*> of_it;
  for (const ModelPlaces& m : models)
    if (worth_of(m) == worth && m.model != default_model) of_it.push_back(&m);
  if (of_it.empty()) return "";
  std::sort(of_it.begin(), of_it.end(),
            [](const ModelPlaces* a, const ModelPlaces* b) { return a->cost.median < b->cost.median; });
  std::vector<std::string> each;
  for (const ModelPlaces* m : of_it) {
    std::string text = fmt::format("{} ({}; {}", escape_markup(m->words), number_text(m->cost.median, 2),
                                   percent(m->error.median));
    if (worth == Worth::cheap_and_right) text += ", up to " + percent(m->worst().error);
    if (!m->failed.empty()) text += fmt::format("; fails in {}", m->failed.size());
    each.push_back(text + ")");
  }
  return fmt::format("<li><b>{}:</b> {}.</li>\n", words, fmt::join(each, ", "));
}

std::string verdicts(const std::vector<ModelPlaces>& models) {
  return "<ul>\n" + verdict("Cheap, and at most twice as far off as the default", Worth::cheap_and_right, models) +
         verdict("Cheap at a price", Worth::cheap_at_a_price, models) +
         verdict("Wrong by more than 10 %", Worth::wrong, models) +
         verdict("Dearer, and less than half as far off", Worth::dear_and_better, models) +
         verdict("Dearer for nothing", Worth::dear_for_nothing, models) +
         verdict("Time within a tenth of the default's", Worth::like_the_default, models) + "</ul>\n";
}

std::string scenes_text(const ModelPlaces& m) {
  return m.failed.empty() ? std::to_string(m.scenes.size())
                          : fmt::format("{}, fails in {}", m.scenes.size(), m.failed.size());
}

std::string table_row(const ModelPlaces& m) {
  const ScenePlace& worst = m.worst();
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{} to {}</td><td "
      "class=\"number\">{}</td><td>{} to {}</td><td class=\"number\">{}</td><td>{}, {}: {}</td></tr>\n",
      escape_markup(m.words), scenes_text(m), number_text(m.cost.median, 2), number_text(m.cost.lower, 2),
      number_text(m.cost.upper, 2), percent(m.error.median), percent(m.error.lower), percent(m.error.upper),
      percent(m.default_error), escape_markup(scene_title(worst.point->scene)),
      escape_markup(observable_title(worst.observable)), percent(worst.error));
}

std::string table(const std::vector<ModelPlaces>& models) {
  std::string html =
      "<details><summary>Numbers of all models, several settings together too</summary>\n<div "
      "class=\"scroll\"><table class=\"facts\"><thead><tr><th>Model</th><th>Scenes</th><th "
      "class=\"number\">Time</th><th>Quartiles</th><th class=\"number\">Error</th><th>Quartiles</th><th "
      "class=\"number\">Default there</th><th>Farthest off</th></tr></thead><tbody>\n";
  for (const ModelPlaces& m : models) html += table_row(m);
  return html + "</tbody></table></div></details>\n";
}

}  // namespace

const KindStyle& style_of(const std::string& kind) {
  for (const KindStyle& s : kind_styles)
    if (kind == s.kind) return s;
  throw std::logic_error("no mark for models of kind " + kind);
}

std::string kinds_legend(const std::string& without) {
  std::string html;
  for (const KindStyle& s : kind_styles)
    if (s.kind != without)
      html += fmt::format("<span>{} {}</span> ", mark_svg(s.mark, s.colour), escape_markup(s.words));
  return html;
}

std::string overview_part(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows,
                          Figures& figures) {
  const std::vector<ModelPlaces> all = places_over_scenes(points, rows);
  const auto ours =
      std::find_if(all.begin(), all.end(), [](const ModelPlaces& m) { return m.model == default_model; });
  if (ours == all.end()) return "";
  const std::vector<ModelPlaces> models = shown(all);
  const std::string svg = figure_svg(models, *ours);
  const std::string caption = fmt::format(
      "<b>All {0} scenes in one:</b> time over that of the default in the same scene, and the largest error of "
      "the scene's observables against the finest model. Full marks are medians over the scenes, bars reach "
      "from quartile to quartile (of times where these are {1:g} times apart or more), pale marks are single "
      "scenes, hollow where they lie beyond the edge. The dashed lines cross at the default, which is {2} off "
      "({3} to {4}). Models on the left are cheaper, those below are better. What follows, in medians: time "
      "over that of the default, and error. “Up to” is the scene where a model is farthest off, “fails” the "
      "number of scenes where it could not be run.",
      ours->scenes.size(), wide, percent(ours->error.median), percent(ours->error.lower),
      percent(ours->error.upper));
  return "<p class=\"keys\">" + kinds_legend("finest") + "</p>\n<figure>\n<div class=\"scroll wide\">" + svg +
         "</div>\n" + figures.caption(caption) + "</figure>\n" + verdicts(models) + table(all);
}

}  // namespace ropewalk::validate
