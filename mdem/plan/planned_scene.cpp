#include "plan/planned_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "plan/scene_edit.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {

int elements_of(const Scene& scene) { return scene.source->sizes(scene.element_length).elements; }

std::string fixed_length(const Scene& scene) {
  if (scene.from_file()) return "the elements come from a file";
  if (tube_size_key(scene).tube_size == SceneKey::TubeSize::no) return "the tubes have no common length";
  const ContactLawKind* law = contact_law_kind(scene.contact.law);
  if (law && !law->any_element_length) return fmt::format("law \"{}\" holds for its set's length alone", law->name);
  for (const auto& drive : scene.drives)
    if (const std::string why = drive->why_not_lengthened(); !why.empty()) return why;
  return "";
}

void PlannedScene::set(const std::string& table, const std::string& key, const std::string& value,
                       const std::string& why) {
  text_ = with_key(text_, table, key, value);
  why_.push_back(fmt::format("{}{}{} = {}: {}", table, table.empty() ? "" : ".", key, value, why));
}

void PlannedScene::take_away(const std::string& table, const std::string& key) {
  text_ = without_key(text_, table, key);
}

double PlannedScene::longest() const {
  const int elements = elements_of(scene_);
  return elements > 0 ? elements * scene_.element_length : std::numeric_limits<double>::infinity();
}

void PlannedScene::start_from_default() {
  struct Key {
    const char *table, *key;
    bool typed;
  };
  const ContactOptions& contact = scene_.contact;
  const RunOptions& run = scene_.run;
  for (const Key& k :
       {Key{"contact", "cutoff_nm", contact.cutoff > 0}, Key{"contact", "nodes_per_element", contact.nodes > 0},
        Key{"contact", "precision", contact.precision.has_value()},
        Key{"run", "integrator", run.stepping.runge_kutta}, Key{"run", "time_step_fs", run.time_step > 0}}) {
    if (k.typed) remark(fmt::format("{}.{}: left to the program first", k.table, k.key));
    take_away(k.table, k.key);
  }
}

void PlannedScene::drop_what_is_not_there() {
  if (scene_.contact.law == "none" || features_.contact) return;
  if (features_.curvature * longest() > units::pi) {
    remark("contact stays: the lone tube may bend back to itself");
    return;
  }
  set("contact", "law", "\"none\"", "one tube, which does not come back to itself");
}

void PlannedScene::lengthen(double times, const std::string& why) {
  if (!fixed_length(scene_).empty()) return;
  const double wanted = times * scene_.parameters().element_length, old = scene_.element_length;
  if (std::fabs(wanted / old - 1) < 1e-6) return;
  const int held = elements_held(scene_, 0);
  const double free = (elements_of(scene_) - held) * old;
  const std::int64_t parts = std::max<std::int64_t>(2, std::llround(free / wanted));
  const double length = free / static_cast<double>(parts);
  set("", "element_length_nm", fmt::format("{:.10g}", length), why);
  const std::int64_t now = parts + held;
  const SceneKey size = tube_size_key(scene_);
  set(size.table, size.key,
      size.tube_size == SceneKey::TubeSize::elements ? std::to_string(now)
                                                     : fmt::format("{:.10g}", static_cast<double>(now) * length),
      held ? "the ends' centres stay as far apart" : "the tubes stay as long");
}

void PlannedScene::finish() {
  if (nodes_per_nm_ > 0) {
    const int nodes = std::max(
        1, static_cast<int>(std::lround(nodes_per_nm_ * scene_of_text(text_, scene_.path).element_length)));
    set("contact", "nodes_per_element", std::to_string(nodes), nodes_why_);
  }
  if (step_ > 0) {
    text_ = with_key(text_, "run", "time_step_fs", "\"auto\"");
    Scene so_far = scene_of_text(text_, scene_.path);
    const Prepared p = prepare(so_far);
    const double most = is_warm(so_far) ? p.time_step : cold_step_fraction * p.limit.limit,
                 chosen = std::min(step_ * p.time_step, most);
    set("run", "time_step_fs", fmt::format("{:.4g}", chosen / units::fs), step_why_);
  }
}

}  // namespace ropewalk
