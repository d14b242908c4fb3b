// The models of the chart, and the settings of a scene that each stands for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/chart.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "scene/laws/line.hpp"
#include "scene/laws/paper.hpp"
#include "scene/scene_to_model.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk::validate {
namespace {

using Precision = Interaction::Precision;

// Words of models that turn one setting, and of those that turn several.
constexpr const char *longer = "element length × {:g}", *heavier = "masses × {:g}", *nearer = "cutoff {:g} nm",
                     *relaxed_stepwise = "relaxed in increments", *relaxed_at_once = "relaxed at once";

template <class F>
ChartModel varied(const std::string& kind, const std::string& name, const std::string& words, F change) {
  ChartModel m;
  m.name = name;
  m.words = words;
  m.kind = kind;
  change(m);
  return m;
}

void add_anchors(std::vector<ChartModel>& all) {
  all.push_back(varied("finest", finest_model, "finest model", [](ChartModel& m) {
    m.length = 0.5;
    m.precision = Precision::full;
    m.step_fraction = 0.5;
  }));
  all.push_back(varied("default", default_model, "default", [](ChartModel&) {}));
  // Its programs calculate in double precision; its papers give 20 fs.
  all.push_back(varied("published", published_model, "published model", [](ChartModel& m) {
    m.set = "cnt-10-10-paper";
    m.law = "paper";
    m.precision = Precision::full;
    m.time_step = 20 * units::fs;
  }));
}

// One model for each value of a setting. `name` and `words` are formats that take the value.
template <class T>
void vary(std::vector<ChartModel>& all, const char* kind, const char* name, const char* words,
          T ChartModel::*setting, std::initializer_list<T> values) {
  for (const T value : values)
    all.push_back(varied(kind, fmt::format(fmt::runtime(name), value), fmt::format(fmt::runtime(words), value),
                         [&](ChartModel& m) { m.*setting = value; }));
}

void add_single_tube_knobs(std::vector<ChartModel>& all) {
  vary(all, "element_length", "length-{:g}", longer, &ChartModel::length, {0.5, 2.0, 4.0, 8.0});
  vary(all, "time_step", "step-{:g}", "time step {:g} of its limit", &ChartModel::step_fraction, {0.3, 0.6});
  all.push_back(
      varied("integrator", "rk4", "Runge-Kutta steps", [](ChartModel& m) { m.stepping.runge_kutta = true; }));
  vary(all, "mass_scale", "mass-{:g}", heavier, &ChartModel::mass_scale, {4.0, 16.0, 64.0});
  all.push_back(varied("mode", "relax", relaxed_stepwise, [](ChartModel& m) { m.mode = RunOptions::Mode::relax; }));
  all.push_back(varied("bond", "hooke", "Hooke's bonds", [](ChartModel& m) { m.hooke = true; }));
  vary(all, "bond_damping", "bond-damping-{:g}", "no damping of bonds", &ChartModel::bond_damping, {0.0});
  vary(all, "bond_damping", "bond-damping-{:g}", "damping of bonds × {:g}", &ChartModel::bond_damping, {4.0});
}

void add_contact_knobs(std::vector<ChartModel>& all) {
  // In a single tube only the grips would turn, by more than a bond bears.
  all.push_back(varied("mode", "relax-at-once", relaxed_at_once, [](ChartModel& m) {
    m.mode = RunOptions::Mode::relax;
    m.at_once = true;
  }));
  all.push_back(varied("law", "isotropic", "isotropic contact: one node", [](ChartModel& m) { m.nodes = 1; }));
  all.push_back(
      varied("law", "paper", "published law fitted to the same tube", [](ChartModel& m) { m.law = "paper"; }));
  all.push_back(varied("law", "published-mixed", "published model in mixed precision", [](ChartModel& m) {
    m.set = "cnt-10-10-paper";
    m.law = "paper";
  }));
  vary(all, "nodes_per_element", "nodes-{}", "{} nodes", &ChartModel::nodes, {2, 3, 4, 6, 8});
  vary(all, "cutoff", "cutoff-{:g}", nearer, &ChartModel::cutoff, {2.6, 2.4, 2.2});
  vary(all, "contact_viscosity", "viscosity-{:g}", "no contact viscosity", &ChartModel::contact_viscosity, {0.0});
  vary(all, "contact_viscosity", "viscosity-{:g}", "contact viscosity {:g} eV ps/nm²",
       &ChartModel::contact_viscosity, {5.0, 80.0});
  all.push_back(
      varied("precision", "double", "double precision", [](ChartModel& m) { m.precision = Precision::full; }));
}

// Combines the changes that pay alone.
void add_combinations(const ChartScene& scene, std::vector<ChartModel>& all) {
  const auto combined = [&](std::string name, double length, int nodes, double part_of_cutoff, double mass,
                            int relaxed) {
    std::vector<std::string> words;
    if (length != 1) words.push_back(fmt::format(fmt::runtime(longer), length));
    if (nodes > 0) words.push_back(fmt::format("{} nodes", nodes));
    if (part_of_cutoff > 0) words.push_back(fmt::format(fmt::runtime(nearer), part_of_cutoff));
    if (mass != 1) words.push_back(fmt::format(fmt::runtime(heavier), mass));
    if (relaxed > 0) words.emplace_back(relaxed > 1 ? relaxed_at_once : relaxed_stepwise);
    all.push_back(varied("combination", name, fmt::format("{}", fmt::join(words, ", ")), [&](ChartModel& m) {
      m.length = length;
      m.nodes = nodes;
      m.cutoff = part_of_cutoff;
      m.mass_scale = mass;
      if (relaxed > 0) m.mode = RunOptions::Mode::relax;
      m.at_once = relaxed > 1;
    }));
  };
  constexpr double near = 2.4;  // nm
  for (const double mass : {1.0, 4.0, 16.0}) {
    const std::string heavy = mass > 1 ? fmt::format("+mass-{:g}", mass) : "";
    if (scene.contact && scene.published) combined("nodes-4+cutoff-2.4" + heavy, 1, 4, near, mass, 0);
    if (scene.contact && scene.published) combined("length-2+nodes-8" + heavy, 2, 8, 0, mass, 0);
    if (mass > 1) combined("length-2" + heavy, 2, 0, 0, mass, 0);
    if (mass > 1) combined("length-4" + heavy, 4, 0, 0, mass, 0);
  }
  for (const double times : {2.0, 4.0}) {
    const std::string name = fmt::format("length-{:g}", times);
    combined(name + "+relax", times, 0, 0, 1, 1);
    if (scene.contact) combined(name + "+relax-at-once", times, 0, 0, 1, 2);
  }
}

// Without contact, settings of the contact have no effect.
void take_contact_away(ChartModel& m) {
  m.law = "none";
  m.nodes = 0;
  m.contact_viscosity = 0;
}

}  // namespace

std::vector<ChartModel> chart_models(const ChartScene& scene, bool quick) {
  std::vector<ChartModel> all;
  add_anchors(all);
  add_single_tube_knobs(all);
  if (scene.contact) add_contact_knobs(all);
  add_combinations(scene, all);
  if (!scene.contact) std::for_each(all.begin(), all.end(), take_contact_away);
  const auto drop = [&](auto unfit) { all.erase(std::remove_if(all.begin(), all.end(), unfit), all.end()); };
  // Cutoffs are in nm, for (10,10) as well.
  if (!scene.published)
    drop([](const ChartModel& m) { return !m.set.empty() || m.law == "paper" || m.cutoff > 0; });
  if (!scene.relaxes) drop([](const ChartModel& m) { return m.mode == RunOptions::Mode::relax; });
  if (!scene.soft_bonds) drop([](const ChartModel& m) { return m.hooke; });
  if (quick) {
    static const std::vector<std::string> few = {finest_model, default_model, published_model,
                                                 "length-2",   "isotropic",   "relax"};
    drop([](const ChartModel& m) { return !std::count(few.begin(), few.end(), m.name); });
  }
  return all;
}

const ChartModel& find_chart_model(const std::vector<ChartModel>& models, const std::string& name) {
  for (const ChartModel& m : models)
    if (m.name == name) return m;
  throw InputError({"", 0, "model"}, fmt::format("there is no model \"{}\"", printable(name, 60)),
                   "see points.csv for those that there are");
}

Scene knobs_of(const ChartModel& model, const std::string& default_set, double element_length) {
  Scene scene;
  scene.sets = {read_parameters(find_parameters(model.set.empty() ? default_set : model.set, ""))};
  scene.element_length = element_length;
  scene.contact.law = model.law;
  scene.contact.nodes = model.nodes;
  scene.contact.precision = model.precision;
  scene.contact.cutoff = model.cutoff;
  scene.run.stepping = model.stepping;
  scene.run.mass_scale = model.mass_scale;
  scene.damping.contact.eta = model.contact_viscosity;
  scene.damping.bond.rate = model.bond_damping;
  scene.run.mode = model.mode;
  scene.bond.anharmonic = !model.hooke && scene.parameters().anharmonic.has_value();
  return scene;
}

double rest_spacing(const Scene& scene) {
  if (scene.contact.law == "none") return 0;
  if (scene.contact.law == "paper") return pair_spacing(paper_contact(scene), scene.element_length);
  return line_parallel_well(line_contacts(scene).front().density).distance;
}

}  // namespace ropewalk::validate
