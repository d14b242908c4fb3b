#include "plan/model_changes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/laws/line.hpp"
#include "scene/scene_to_model.hpp"

namespace ropewalk {
namespace {

constexpr int least_elements = 8;  // of a tube: with fewer, ends and middle are one

ModelChange length_change(double times, std::string name) {
  return {"element_length_nm", name, [=](PlannedScene& w) { w.lengthen(times, name); }};
}

bool has_line_law(const Scene& scene, const SceneFeatures& f) { return f.contact && scene.contact.law == "line"; }

// Nodes of the line law per element, where none are typed.
int default_nodes(Scene scene) {
  scene.contact.nodes = 0;
  return line_contacts(scene).front().nodes_i;
}

ModelChange nodes_change(const Scene& scene, int nodes) {
  const std::string name =
      fmt::format("{} nodes for {} in {:.3g} nm", nodes, default_nodes(scene), scene.element_length);
  const double per_nm = nodes / scene.element_length;
  return {"nodes_per_element", name, [=](PlannedScene& w) { w.set_nodes(per_nm, name); }};
}

ModelChange cutoff_change(const Scene& scene, double part) {
  const ParameterSet& set = scene.parameters();
  const double cutoff = part * (scene.contact.law == "line" ? set.line->density.cutoff() : set.paper->cutoff());
  const std::string name = fmt::format("contact cut off at {:.3g} nm", cutoff);
  return {"cutoff_nm", name,
          [=](PlannedScene& w) { w.set("contact", "cutoff_nm", fmt::format("{:.4g}", cutoff), name); }};
}

ModelChange mass_change(int times) {
  const std::string name = fmt::format("masses x {}", times);
  return {"mass_scale", name, [=](PlannedScene& w) { w.set("run", "mass_scale", std::to_string(times), name); }};
}

ModelChange relaxation() {
  return {"mode", "relaxed at once", [](PlannedScene& w) {
            w.set("run", "mode", "\"relax\"", "only the end is asked for");
            for (const char* key : {"duration_ps", "integrator", "mass_scale"}) w.take_away("run", key);
          }};
}

}  // namespace

ModelChange step_change(double times) {
  const std::string name = fmt::format("{:g} of the time step", times);
  return {"time_step_fs", name, [=](PlannedScene& w) { w.set_step(times, name); }};
}

std::string kept_length(const Scene& scene) {
  const std::string fixed = fixed_length(scene);
  if (!fixed.empty() || !is_warm(scene)) return fixed;
  return "the scene is warm, and its heat goes with the number of elements";
}

std::string needs_time(const Scene& scene) {
  for (const auto& drive : scene.drives)
    if (const std::string why = drive->needs_time(); !why.empty()) return why;
  if (scene.start.temperature > 0 || scene.bath()) return "the scene is warm";
  return "";
}

std::vector<ModelChange> cheaper_changes(const Scene& scene, const SceneFeatures& f, bool end_state,
                                         std::vector<std::string>& not_tried) {
  std::vector<ModelChange> out;
  const std::string kept = kept_length(scene);
  const double longer = 2 * scene.parameters().element_length;
  if (!kept.empty())
    not_tried.push_back("longer elements: " + kept);
  else if (elements_of(scene) * scene.element_length < least_elements * longer)
    not_tried.push_back(fmt::format("longer elements: tubes would have fewer than {}", least_elements));
  else
    out.push_back(length_change(2, "elements twice as long"));
  if (has_line_law(scene, f)) {
    const int nodes = default_nodes(scene);
    for (const int fewer : {nodes - 1, nodes - 2})
      if (fewer >= 3) out.push_back(nodes_change(scene, fewer));
  }
  if (f.contact && scene.sets.size() == 1) out.push_back(cutoff_change(scene, 0.86));
  if (scene.bond.anharmonic)
    out.push_back(
        {"law", "Hooke's bonds", [](PlannedScene& w) { w.set("bond", "law", "\"harmonic\"", "Hooke's bonds"); }});
  if (scene.run.mode == RunOptions::Mode::relax) return out;
  if (!end_state) {
    not_tried.push_back(
        "heavier masses and relaxation: they change the motion (give --end-state if only the final state matters)");
    return out;
  }
  if (f.sudden)
    not_tried.push_back("heavier masses: a load acts at once, and heavy tubes swing for longer");
  else if (is_warm(scene) || scene.bath())
    not_tried.push_back("heavier masses: the scene is warm");
  else
    for (const int times : {4, 16}) out.push_back(mass_change(times));
  if (const std::string why = needs_time(scene); why.empty())
    out.push_back(relaxation());
  else
    not_tried.push_back("relaxation: " + why);
  return out;
}

std::vector<ModelChange> finest_changes(const Scene& scene, const SceneFeatures& f) {
  std::vector<ModelChange> out;
  if (kept_length(scene).empty())
    out.push_back(length_change(0.5, "elements half as long"));
  else if (has_line_law(scene, f))
    out.push_back(nodes_change(scene, default_nodes(scene) + 2));
  if (scene.run.mode != RunOptions::Mode::relax) out.push_back(step_change(0.5));
  return out;
}

std::string text_with(const Scene& scene, const SceneFeatures& features, const std::vector<ModelChange>& changes,
                      std::vector<std::string>* why) {
  PlannedScene w(scene, features);
  w.start_from_default();
  w.drop_what_is_not_there();
  if (std::none_of(changes.begin(), changes.end(), [](const auto& c) { return c.key == "element_length_nm"; }))
    w.default_length();
  for (const ModelChange& change : changes) change.write(w);
  w.finish();
  if (why) *why = w.why();
  return w.text();
}

}  // namespace ropewalk
