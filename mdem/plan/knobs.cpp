#include "plan/knobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {
namespace {

using Id = Knob::Id;
using Model = ChartedModel;

double charted_length(const ChartedScene& c) {
  return c.standard()->elements * c.standard()->element_length / c.tubes;
}

// With so few elements that ends and middle are one, the chart says nothing: at least as many as it had, or eight.
bool long_enough(const ChartedScene& c, const ChartedModel& m, const Scene& scene) {
  const double length = m.element_length / c.standard()->element_length * scene.parameters().element_length;
  const double elements = elements_of(scene) * scene.element_length / length;
  return elements > std::min(8.0, static_cast<double>(m.elements) / c.tubes) - 0.5;
}

// Heavy tubes follow a motion that gives their waves as much time as in the chart.
bool slow_enough(const ChartedScene& c, const ChartedModel& m, const SceneFeatures& f) {
  return f.duration / f.length > 0.9 * m.simulated / charted_length(c);
}

bool is_double(const Model& m) { return m.precision.rfind("double", 0) == 0; }

// --- what is written ---

void write_precision(PlannedScene& w, const Model& m, const Model&, const std::string& why) {
  w.set("contact", "precision", is_double(m) ? "\"double\"" : "\"mixed\"", why);
}

void write_mode(PlannedScene& w, const Model&, const Model&, const std::string& why) {
  w.set("run", "mode", "\"relax\"", why + "; only the end is asked for");
  for (const char* key : {"duration_ps", "contact_every", "integrator", "mass_scale"}) w.take_away("run", key);
}

// --- the table ---

std::vector<Knob> table() {
  const auto always = [](const KnobUse&, const Model&) { return true; };
  const auto with_contact = [](const KnobUse& u, const Model&) { return u.features.contact; };
  return {
      {Id::cutoff,
       {"cutoff", "cutoff_nm"},
       [](const Model& m) { return m.cutoff; },
       with_contact,
       [](PlannedScene& w, const Model& m, const Model&, const std::string& why) {
         w.set("contact", "cutoff_nm", fmt::format("{:.6g}", m.cutoff), why);
       },
       {{"contact", "cutoff_nm", [](const Scene& s) { return s.contact.cutoff > 0; }}}},
      {Id::integrator,
       {"integrator"},
       [](const Model& m) -> double { return m.integrator == "verlet"; },
       always,
       [](PlannedScene& w, const Model& m, const Model&, const std::string& why) {
         w.set("run", "integrator", m.integrator == "rk4" ? "\"rk4\"" : "\"verlet\"", why);
       },
       {{"run", "integrator", [](const Scene& s) { return s.run.stepping.runge_kutta; }}},
       true},
      {Id::length,
       {"element_length", "element_length_nm"},
       [](const Model& m) { return -m.element_length; },
       [](const KnobUse& u, const Model& m) {
         return !fixed_length(u.scene).empty() || long_enough(u.charted, m, u.scene);
       },
       [](PlannedScene& w, const Model& m, const Model& standard, const std::string& why) {
         w.lengthen(m.element_length / standard.element_length, why);
       }},
      {Id::levels,
       {"contact_every"},
       [](const Model& m) -> double { return -m.contact_every; },
       [](const KnobUse& u, const Model&) {
         return u.features.contact && u.scene.damping.local <= 0 && !u.scene.thermostat;
       },
       [](PlannedScene& w, const Model& m, const Model&, const std::string& why) {
         w.set("run", "contact_every", std::to_string(m.contact_every), why);
       },
       {{"run", "contact_every", [](const Scene& s) { return s.run.stepping.contact_every > 1; }}},
       true},
      {Id::mass,
       {"mass_scale"},
       [](const Model& m) { return -std::fabs(std::log(m.mass_scale)); },
       [](const KnobUse& u, const Model& m) {
         return u.end_state && u.scene.start.temperature == 0 && !u.features.sudden &&
                slow_enough(u.charted, m, u.features);
       },
       [](PlannedScene& w, const Model& m, const Model&, const std::string& why) {
         w.set("run", "mass_scale", fmt::format("{:g}", m.mass_scale), why);
       },
       {{"run", "mass_scale", [](const Scene& s) { return s.run.mass_scale != 1; }}},
       true},
      {Id::mode,
       {"mode"},
       [](const Model& m) -> double { return m.mode == "dynamics"; },
       [](const KnobUse& u, const Model&) { return u.end_state && needs_time(u.scene).empty(); },
       write_mode},
      // Where tubes feel nodes they settle in them, which scenes of the chart that are driven from rest hardly show:
      // seven free tubes with two nodes instead of six lost 11 % of the energy of twisting.
      {Id::nodes,
       {"nodes_per_element", "nodes", "law"},
       [](const Model& m) -> double { return m.nodes; },
       [](const KnobUse& u, const Model& m) {
         return u.features.contact && m.nodes >= u.charted.standard()->nodes;
       },
       [](PlannedScene& w, const Model& m, const Model&, const std::string& why) {
         w.set_nodes(m.nodes / m.element_length, why);
       },
       {{"contact", "nodes_per_element", [](const Scene& s) { return s.contact.nodes > 0; }}}},
      {Id::precision,
       {"precision"},
       [](const Model& m) -> double { return is_double(m) + 2 * (m.precision.size() > 6); },
       with_contact,
       write_precision,
       {{"contact", "precision", [](const Scene& s) { return s.contact.precision.has_value(); }}}},
      {Id::step,
       {"time_step", "time_step_fs"},
       [](const Model& m) { return -m.time_step; },
       always,
       [](PlannedScene& w, const Model& m, const Model& standard, const std::string& why) {
         w.set_step(m.time_step / standard.time_step, why);
       },
       {{"run", "time_step_fs", [](const Scene& s) { return s.run.time_step > 0; }}},
       true},
  };
}

}  // namespace

const std::vector<Knob>& all_knobs() {
  static const std::vector<Knob> knobs = table();
  return knobs;
}

const Knob* knob_of(const ChartedModel& model) {
  for (const Knob& knob : all_knobs())
    if (std::count(knob.kinds.begin(), knob.kinds.end(), model.kind)) return &knob;
  return nullptr;
}

std::string needs_time(const Scene& scene) {
  if (scene.twist) return "the moment of [twist] is ramped, and where a rope ends depends on the way";
  for (const SceneLoad& load : scene.loads)
    if (!load.load->needs_time().empty()) return load.load->needs_time();
  if (scene.start.temperature > 0) return "the scene is warm";
  return "";
}

}  // namespace ropewalk
