#include "chart/overview.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ropewalk::validate {
namespace {

constexpr double cheap = 0.9, dear = 1.1;  // relative to the time of the default
constexpr double far_off = 0.1;

// The rows of a point against the finest model as one place; the default's error is not known here.
ScenePlace place_of(const ChartPoint& point, const std::vector<ChartRow>& rows) {
  ScenePlace place;
  for (const ChartRow& r : rows) {
    if (r.point != &point || r.reference_kind != "finest") continue;
    if (!place.point || r.error > place.error) {
      place.error = r.error;
      place.observable = r.observable;
    }
    place.point = &point;
  }
  return place;
}

ModelPlaces& find_or_add(std::vector<ModelPlaces>& all, const ChartPoint& point) {
  for (ModelPlaces& m : all)
    if (m.model == point.model) return m;
  ModelPlaces m;
  m.model = point.model;
  m.kind = point.kind;
  m.words = model_words(point.model);
  all.push_back(m);
  return all.back();
}

void summarise(ModelPlaces& m) {
  std::vector<double> cost, error, of_default;
  for (const ScenePlace& p : m.scenes) {
    cost.push_back(p.cost);
    error.push_back(p.error);
    of_default.push_back(p.default_error);
  }
  m.cost = quartiles(cost);
  m.error = quartiles(error);
  m.default_error = quartiles(of_default).median;
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("no values have no quartiles");
  std::sort(values.begin(), values.end());
  const auto at = [&](double part) {
    const double rank = part * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(rank), above = std::min(below + 1, values.size() - 1);
    return values[below] + (rank - std::floor(rank)) * (values[above] - values[below]);
  };
  return {at(0.25), at(0.5), at(0.75)};
}

const ScenePlace& ModelPlaces::worst() const {
  return *std::max_element(scenes.begin(), scenes.end(),
                           [](const ScenePlace& a, const ScenePlace& b) { return a.error < b.error; });
}

std::vector<ModelPlaces> places_over_scenes(const std::vector<ChartPoint>& points,
                                            const std::vector<ChartRow>& rows) {
  std::map<std::string, ScenePlace> defaults;  // one for each scene
  for (const ChartPoint& p : points)
    if (p.model == default_model) {
      const ScenePlace place = place_of(p, rows);
      if (place.point) defaults[p.scene] = place;
    }
  std::vector<ModelPlaces> all;
  for (const ChartPoint& p : points) {
    const auto beside = defaults.find(p.scene);
    if (p.model == finest_model || beside == defaults.end()) continue;
    ScenePlace place = place_of(p, rows);
    if (!p.error.empty()) find_or_add(all, p).failed.push_back(p.scene);
    if (!place.point) continue;
    place.cost = p.cpu_per_ns() / beside->second.point->cpu_per_ns();
    place.default_error = beside->second.error;
    find_or_add(all, p).scenes.push_back(place);
  }
  all.erase(std::remove_if(all.begin(), all.end(), [](const ModelPlaces& m) { return m.scenes.empty(); }),
            all.end());
  for (ModelPlaces& m : all) summarise(m);
  return all;
}

Worth worth_of(const ModelPlaces& m) {
  if (m.error.median > far_off) return Worth::wrong;
  if (m.cost.median <= cheap)
    return m.error.median <= 2 * m.default_error ? Worth::cheap_and_right : Worth::cheap_at_a_price;
  if (m.cost.median < dear) return Worth::like_the_default;
  return m.error.median < 0.5 * m.default_error ? Worth::dear_and_better : Worth::dear_for_nothing;
}

std::string model_words(const std::string& name) {
  static const std::map<std::string, std::string> words = [] {
    std::map<std::string, std::string> all;
    for (const ChartScene& scene : chart_scenes())
      for (const ChartModel& m : chart_models(scene, false)) all.emplace(m.name, m.words);
    return all;
  }();
  const auto found = words.find(name);
  return found == words.end() ? name : found->second;
}

}  // namespace ropewalk::validate
