// The scenes of the chart, from scenes.toml and scenes/NAME.toml, and what a model makes of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cases/common/twisted_rope.hpp"
#include "chart/chart.hpp"
#include "chart/own_kinds.hpp"
#include "core/case_text.hpp"
#include "core/reference.hpp"
#include "io/data_files.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "scene/dissipation.hpp"
#include "scene/ends/twist.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/loads/fix.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/loads/rotate.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk::validate {
namespace {

// --- Files ---

ChartScene read_chart_scene(const TomlTable& t) {
  const Bounds positive = Bounds::positive();
  ChartScene s;
  s.name = t.string("name");
  s.title = t.string("title");
  s.setup = t.string("setup");
  s.observables = t.strings("observables");
  s.relaxes = t.boolean_or("relaxes", true);
  s.band = t.number_or("band_nm", 0, positive);
  s.hold = t.number("hold_ps", positive);
  s.increments = static_cast<int>(t.integer_or("increments", 1, 1, 1000));
  s.about_itself = t.word_or("turns", false, Words<bool>{{"as one", false}, {"each", true}});
  s.interior_follows = t.boolean_or("follows", true);
  s.above_start = t.word_or("from", true, Words<bool>{{"start", true}, {"straight", false}});
  s.starts_at_rest = t.boolean_or("rests", true);
  s.moment_resists = t.word_or("moment", true, Words<bool>{{"resists", true}, {"turns", false}});
  const std::string file = "chart/scenes/" + s.name + ".toml";
  s.scene = scene_of_text(registered_text(file), file);
  s.element = t.number_or("element_nm", s.scene.element_length, positive);
  s.contact = s.scene.contact.law != "none";
  s.published = s.scene.parameters().chirality.n == 10 && s.scene.parameters().chirality.m == 10;
  s.soft_bonds = s.scene.bond.anharmonic;
  return s;
}

std::vector<ChartScene> read_chart_scenes() {
  constexpr const char* file = "chart/scenes.toml";
  add_own_kinds();
  const TomlTable top = TomlTable::parse(registered_text(file), file);
  std::vector<ChartScene> all;
  for (const TomlTable& t : top.tables("scene")) all.push_back(read_chart_scene(t));
  top.finish();
  return all;
}

// --- Elements of another length ---

// Drives hold so many more elements at either end of each tube.
void hold_more(int beyond, Scene& scene) {
  for (auto& drive : scene.drives) {
    const auto* load = dynamic_cast<const LoadDrive*>(drive.get());
    if (!load || load->on.all_elements) continue;
    auto longer = std::make_shared<LoadDrive>(*load);
    longer->on.elements.clear();
    for (const int e : load->on.elements)
      for (int k = 0; k <= beyond; ++k) longer->on.elements.push_back(e < 0 ? e - beyond + k : e + k);
    drive = std::move(longer);
  }
}

// Divides the deforming part into whole bonds, as long as the model has them or shorter.
void divide(const ChartScene& chart, const ChartModel& model, Scene& scene) {
  const double own = scene.element_length;
  const double length = (scene.source->sizes(own).elements - elements_held(scene, 0)) * own;
  const int bonds = static_cast<int>(std::ceil(length / (chart.element * model.length) - 1e-6));
  scene.element_length = length / bonds;
  if (const auto beyond = std::lround(chart.band / scene.element_length - 0.5); beyond > 0)
    hold_more(static_cast<int>(beyond), scene);
  if (const auto* rope = dynamic_cast<const RopeSource*>(scene.source.get())) {
    auto longer = std::make_shared<RopeSource>(*rope);
    longer->length = (bonds + elements_held(scene, 0)) * scene.element_length;
    scene.source = std::move(longer);
  }
}

// --- Specimens ---

// What turns and how far, from the loads: held elements, the whole angle or the moment, and the share of each
// element, evenly from one grip of its tube to the other.
void add_turns(Specimen& s) {
  std::vector<std::optional<double>> turned(s.state.size());  // angle (rad) of a grip, or the sign of its couple
  double lowest = 0, highest = 0;
  for (const auto& load : s.acting) {
    double by = 0;
    if (const auto* rotation = dynamic_cast<const PrescribedRotation*>(load.get())) by = rotation->angle;
    if (const auto* couple = dynamic_cast<const TwistLoad*>(load.get())) {
      by = couple->sign;
      s.moment = couple->moment;
    }
    lowest = std::min(lowest, by);
    highest = std::max(highest, by);
    for (const int e : load->elements) {
      turned[static_cast<std::size_t>(e)] = by;
      s.grips.push_back(e);
    }
  }
  const double whole = highest > 0 ? highest - lowest : lowest;
  if (s.moment == 0) s.angle = whole;
  s.twist_share.assign(s.state.size(), 0.0);
  for (int t = 0; t < s.topology.tubes() && whole != 0; ++t) {
    const int first = s.topology.tube_begin[t], last = s.topology.tube_begin[t + 1] - 1;
    int low = first, high = last;
    while (low + 1 < high && turned[static_cast<std::size_t>(low + 1)]) ++low;
    while (low + 1 < high && turned[static_cast<std::size_t>(high - 1)]) --high;
    const double from = *turned[static_cast<std::size_t>(first)] / whole,
                 to = *turned[static_cast<std::size_t>(last)] / whole;
    for (int e = first; e <= last; ++e)
      s.twist_share[static_cast<std::size_t>(e)] =
          from + (to - from) * std::clamp((e - low) / double(high - low), 0.0, 1.0);
  }
}

double time_step_of(const ChartModel& model, const Specimen& s) {
  const double limit = time_step_limit(s.topology, s.interaction, s.spacing).limit;
  const double part = model.step_fraction > 0 ? model.step_fraction : automatic_step_fraction(s.scene);
  const double step = model.time_step > 0 ? model.time_step : part * limit;
  if (step < limit) return step;
  throw InputError(
      {"", 0, model.name},
      fmt::format("{:.4g} fs is not below the stability limit of {:.4g} fs", step / units::fs, limit / units::fs),
      "take a smaller step");
}

// --- Atoms ---

ReferenceTable atoms_table(const ChartScene& scene, const std::string& name) {
  return read_reference(
      fmt::format("{}/references/{}/{}.csv", data_directory(), scene.scene.parameters().name, name));
}

std::vector<ChartReference> atoms_of_tube(const ChartScene& scene) {
  const Specimen s = scene.build(ChartModel());
  const double length = (s.topology.length_of(0) - 1) * s.scene.element_length, rate = s.angle / length;
  const ReferenceTable t = atoms_table(scene, "tube-twist");
  const std::vector<double> twist = t.column("twist_rad_per_nm"), energy = t.column("energy_eV_per_nm");
  for (std::size_t k = 0; k < twist.size(); ++k)
    if (std::fabs(twist[k] - rate) < 1e-9) return {{"energy", energy[k] * length}};
  throw InputError({"tube-twist.csv", 0, ""}, fmt::format("has no row at {} rad/nm", rate),
                   "restore the shipped file");
}

std::vector<ChartReference> atoms_of_seven_tubes(const ChartScene& scene) {
  const std::vector<TwistedState> states = states_of(atoms_table(scene, "rope-7-short"), false);
  const TwistedState& at = states.at(static_cast<std::size_t>(scene.increments));
  return {{"energy", at.total - states[0].total}, {"end_moment", at.moment * units::eV_in_nN_nm}};
}

std::vector<ChartReference> atoms_of_crossed_tubes(const ChartScene& scene) {
  const Specimen s = scene.build(ChartModel());
  const auto at = [&](int tube) { return axis_of(s.state.orientation[s.topology.tube_begin[tube]]); };
  const double degrees = (std::acos(at(0).dot(at(1))) + s.angle) * units::rad_in_degree,
               distance = s.state.position.z[s.state.size() - 1];
  const ReferenceTable t = atoms_table(scene, "crossed-tubes");
  const std::vector<double> angle = t.column("angle_deg"), apart = t.column("distance_nm"),
                            energy = t.column("energy_eV"), torque = t.column("torque_eV_per_rad");
  for (std::size_t k = 0; k < angle.size(); ++k)
    if (std::fabs(angle[k] - degrees) < 1e-6 && std::fabs(apart[k] - distance) < 1e-9)
      return {{"energy", energy[k]}, {"end_moment", torque[k] * units::eV_in_nN_nm}};
  throw InputError({"crossed-tubes.csv", 0, ""}, fmt::format("has no row at {} degrees, {} nm", degrees, distance),
                   "restore the shipped file");
}

}  // namespace

Specimen ChartScene::build(const ChartModel& model) const {
  Specimen s;
  static_cast<ChartProtocol&>(s) = *this;
  s.scene = scene;
  apply(model, s.scene);
  divide(*this, model, s.scene);
  BuiltScene built = ropewalk::build(s.scene);
  // Constants of damping are those of elements of the default length.
  s.scene.damping = same_dissipation(s.scene.damping, element, s.scene.element_length);
  s.spacing = contact ? built.spacing : 0;
  s.topology = std::move(built.topology);
  s.state = std::move(built.state);
  s.interaction = interaction_of(s.scene, built.law);
  s.acting = loads_of(s.scene, s.topology, s.interaction);
  s.time_step = time_step_of(model, s);
  s.ramp = s.scene.run.duration - hold;
  s.element = element;
  s.is_rope = s.scene.kind != "film";
  add_turns(s);
  return s;
}

std::vector<ChartReference> ChartScene::atoms() const {
  if (name == "tube-twist") return atoms_of_tube(*this);
  if (name == "rope7-md") return atoms_of_seven_tubes(*this);
  if (name == "crossed-tubes") return atoms_of_crossed_tubes(*this);
  return {};
}

LoadsAndConstraints Specimen::held() const {
  LoadsAndConstraints loads;
  for (const auto& load : acting) {
    const auto* rotation = dynamic_cast<const PrescribedRotation*>(load.get());
    if (rotation) loads.add(FixLoad(rotation->elements, true, true, !rotation->axial_free, true));
    if (dynamic_cast<const FixLoad*>(load.get())) loads.add(load);
  }
  return loads;
}

const std::vector<ChartScene>& chart_scenes() {
  static const std::vector<ChartScene> scenes = read_chart_scenes();
  return scenes;
}

const ChartScene& find_chart_scene(const std::string& name) {
  std::vector<std::string> names;
  for (const ChartScene& s : chart_scenes()) {
    if (s.name == name) return s;
    names.push_back(s.name);
  }
  const std::string near = nearest_word(name, names);
  throw InputError({"", 0, "--scenes"}, fmt::format("there is no scene \"{}\"", printable(name, 60)),
                   near.empty() ? fmt::format("choose of {}", fmt::join(names, ", "))
                                : fmt::format("did you mean \"{}\"?", near));
}

std::string observable_title(const std::string& observable) {
  static const std::map<std::string, std::string> titles = {
      {"energy", "energy"},         {"beta", "twist angle beta"},         {"spacing", "spacing"},
      {"end_moment", "end moment"}, {"bending_moment", "bending moment"}, {"Q", "packing charge Q"},
      {"end_angle", "end angle"}};
  return titles.at(observable);
}

std::string observable_unit(const std::string& observable) {
  static const std::map<std::string, std::string> units = {{"energy", "eV"},
                                                           {"beta", "deg"},
                                                           {"spacing", "nm"},
                                                           {"end_moment", "nN nm"},
                                                           {"bending_moment", "nN nm"},
                                                           {"Q", "1"},
                                                           {"end_angle", "deg"}};
  return units.at(observable);
}

}  // namespace ropewalk::validate
