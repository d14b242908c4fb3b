// The models of the chart, from models.toml, and what each changes in a scene.
#include <fmt/format.h>

#include <algorithm>

#include "chart/chart.hpp"
#include "core/case_text.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"

namespace ropewalk::validate {
namespace {

constexpr const char* file = "chart/models.toml";

ChartModel read_model(const TomlTable& t) {
  using Precision = Interaction::Precision;
  const Bounds positive = Bounds::positive(), not_negative = Bounds::non_negative();
  ChartModel m;
  m.name = t.string("name");
  m.kind = t.string("kind");
  m.words = t.string("words");
  m.needs_contact = t.boolean_or("contact", false);
  m.only_10_10 = t.boolean_or("only_10_10", false);
  m.set = t.string_or("parameters", "");
  m.law = t.string_or("law", m.law);
  m.nodes = static_cast<int>(t.integer_or("nodes", 0, 1, 64));
  m.precision = t.word_or("precision", m.precision,
                          Words<Precision>{{"mixed", Precision::mixed}, {"double", Precision::full}});
  m.cutoff = t.number_or("cutoff_nm", 0, positive);
  m.length = t.number_or("element_length", 1, positive);
  m.time_step = t.number_or("time_step_fs", 0, positive) * units::fs;
  m.step_fraction = t.number_or("step_fraction", 0, positive);
  m.stepping.runge_kutta = t.word_or("integrator", false, Words<bool>{{"verlet", false}, {"rk4", true}});
  m.mass_scale = t.number_or("mass_scale", 1, positive);
  if (t.has("relaxed")) {
    m.mode = RunOptions::Mode::relax;
    m.at_once = t.word("relaxed", Words<bool>{{"in increments", false}, {"at once", true}});
  }
  m.contact_viscosity = t.number_or("contact_viscosity", m.contact_viscosity, not_negative);
  m.bond_damping = t.number_or("bond_damping", m.bond_damping, not_negative);
  m.hooke = t.word_or("bond", false, Words<bool>{{"anharmonic", false}, {"harmonic", true}});
  return m;
}

const std::vector<ChartModel>& all_models() {
  static const std::vector<ChartModel> models = [] {
    const TomlTable top = TomlTable::parse(registered_text(file), file);
    std::vector<ChartModel> all;
    for (const TomlTable& t : top.tables("models")) all.push_back(read_model(t));
    top.finish();
    return all;
  }();
  return models;
}

}  // namespace

std::vector<ChartModel> chart_models(const ChartScene& scene, bool quick) {
  static const std::vector<std::string> few = {finest_model, default_model, published_model,
                                               "length-2",   "isotropic",   "relax"};
  std::vector<ChartModel> fit;
  for (ChartModel m : all_models()) {
    if (m.needs_contact && !scene.contact) continue;
    if (m.only_10_10 && !scene.published) continue;
    if (m.mode == RunOptions::Mode::relax && !scene.relaxes) continue;
    if (m.hooke && !scene.soft_bonds) continue;
    if (quick && !std::count(few.begin(), few.end(), m.name)) continue;
    if (!scene.contact) {
      m.law = "none";
      m.contact_viscosity = 0;
    }
    fit.push_back(std::move(m));
  }
  return fit;
}

const ChartModel& find_chart_model(const std::vector<ChartModel>& models, const std::string& name) {
  for (const ChartModel& m : models)
    if (m.name == name) return m;
  throw InputError({"", 0, "model"}, fmt::format("there is no model \"{}\"", printable(name, 60)),
                   "see points.csv for those that there are");
}

void apply(const ChartModel& model, Scene& scene) {
  const bool soft = scene.bond.anharmonic && !model.hooke, contact = scene.contact.law != "none";
  if (!model.set.empty()) scene.sets = {read_parameters(find_parameters(model.set, ""))};
  scene.bond.anharmonic = soft && scene.parameters().anharmonic.has_value();
  if (contact) scene.contact.law = model.law;
  scene.contact.nodes = model.nodes;
  scene.contact.precision = model.precision;
  scene.contact.cutoff = model.cutoff;
  scene.run.stepping = model.stepping;
  scene.run.mass_scale = model.mass_scale;
  scene.run.mode = model.mode;
  scene.damping.contact.eta = model.contact_viscosity;
  scene.damping.bond.rate = model.bond_damping;
}

}  // namespace ropewalk::validate
