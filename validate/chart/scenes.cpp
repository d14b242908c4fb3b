// The scenes of the chart: specimens, grips and loads.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "cases/common/chain.hpp"
#include "cases/common/twisted_rope.hpp"
#include "chart/chart.hpp"
#include "core/reference.hpp"
#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "scene/dissipation.hpp"
#include "scene/ends/twist.hpp"
#include "scene/kinds/film.hpp"
#include "scene/lattice.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate {
namespace {

constexpr const char* set_name = "cnt-10-10-tersoff";
constexpr double element = 1.356;                  // nm, of the published model: the default in all scenes
constexpr double viscosity_reach = 1.5;            // spacings, as a scene has it
constexpr double tube_twist_rate = 0.04127579842;  // rad/nm: a row of tube-twist.csv within the elastic window
constexpr double tube_length = 32 * element;       // nm
constexpr double ring_length = 72 * element,
                 ring_twist = 6;              // nm, rad: half of the twist at which the ring leaves its plane
constexpr double rope_length = 30 * element;  // nm
constexpr double rope_angle = 90 * units::degree;
constexpr double strong_angle = 130 * units::degree;
constexpr double wall_shear = 0.02;                   // twist per length times the tube's radius
constexpr double moment_length = 26 * element;        // nm
constexpr double end_moment = 10;                     // nN nm per tube
constexpr double strong_moment = 40;                  // nN nm: twists a tube by 0.12 rad/nm
constexpr double moment_ramp = 66, moment_hold = 44;  // ps: three periods and two
constexpr int film_tubes = 40;
constexpr double film_length = 32 * element, film_side = 60, film_spacing = 1.7;  // nm
constexpr double film_time = 30;                                                  // ps, twice
constexpr double crossed_length = 8 * element;                                    // nm
constexpr double crossed_from = 90, crossed_to = 30;                              // degrees
constexpr std::size_t md_increment = 4;                                           // increment of rope-7-short
constexpr double md_angle = 18 * units::degree;                                   // there

// Damping constants of a model are given for elements of the default length.
void scale_damping(Specimen& s) {
  Damping& damping = s.scene.damping;
  damping.contact.inner = s.spacing;
  damping.contact.outer = viscosity_reach * s.spacing;
  damping = same_dissipation(damping, s.element, s.scene.element_length);
}

// Applies the model's settings to a specimen with topology and spacing.
Specimen settled(const ChartModel& model, Specimen s) {
  set_collapse(s.scene, s.topology);
  scale_damping(s);
  s.interaction = interaction_of(s.scene);
  const double limit = time_step_limit(s.topology, s.interaction, s.spacing).limit;
  const double part = model.step_fraction > 0 ? model.step_fraction : automatic_step_fraction(s.scene);
  s.time_step = model.time_step > 0 ? model.time_step : part * limit;
  if (s.time_step >= limit)
    throw InputError({"", 0, model.name},
                     fmt::format("{:.4g} fs is not below the stability limit of {:.4g} fs", s.time_step / units::fs,
                                 limit / units::fs),
                     "take a smaller step");
  return s;
}

// A specimen without elements, which are `length` (nm) long; those of the default model `default_length`.
Specimen empty_specimen(const ChartModel& model, double length, bool contact, const char* set = set_name,
                        double default_length = element) {
  Specimen s;
  s.scene = knobs_of(model, set, length);
  s.element = default_length;
  s.topology = empty_topology(s.scene);
  s.spacing = contact ? rest_spacing(s.scene) : 0;
  return s;
}

// Number of bonds whose elements are not longer than this.
int bonds_of(const ChartModel& model, double length, double element_length = element) {
  return static_cast<int>(std::ceil(length / (element_length * model.length) - 1e-6));
}

// Parallel tubes along z, hexagonally packed, centred; `beyond` more elements on either side of the deforming
// length.
Specimen parallel_tubes(const ChartModel& model, int tubes, double length, double band, const char* set = set_name,
                        double element_length = element) {
  const int bonds = bonds_of(model, length, element_length);
  const double a = length / bonds;
  Specimen s = empty_specimen(model, a, tubes > 1, set, element_length);
  const int beyond = std::max(0, static_cast<int>(std::lround(band / a - 0.5)));
  const int elements = bonds + 1 + 2 * beyond;
  s.state = State(static_cast<std::size_t>(tubes * elements));
  for (const auto& [x, y] : hexagonal_lattice(tubes, s.spacing)) {
    const int first = s.topology.elements();
    s.topology.add_tube(elements);
    for (int e = 0; e < elements; ++e) {
      s.state.position.set(static_cast<std::size_t>(first + e), {x, y, (e - 0.5 * (elements - 1)) * a});
      s.twist_share.push_back(std::clamp((e - beyond) / double(bonds), 0.0, 1.0) - 0.5);
      if (e <= beyond || e >= bonds + beyond) s.grips.push_back(first + e);
    }
  }
  return settled(model, std::move(s));
}

// --- tube-twist ---

Specimen twisted_tube(const ChartModel& model) {
  Specimen s = parallel_tubes(model, 1, tube_length, 0);
  s.angle = tube_twist_rate * tube_length;
  s.follow(200, 50, 4);
  s.interior_follows = false;
  return s;
}

ReferenceTable atoms_table(const std::string& name) {
  return read_reference(fmt::format("{}/references/{}/{}.csv", data_directory(), set_name, name));
}

std::vector<ChartReference> atoms_of_tube() {
  const ReferenceTable t = atoms_table("tube-twist");
  const std::vector<double> twist = t.column("twist_rad_per_nm"), energy = t.column("energy_eV_per_nm");
  for (std::size_t k = 0; k < twist.size(); ++k)
    if (std::fabs(twist[k] - tube_twist_rate) < 1e-9) return {{"energy", energy[k] * tube_length}};
  throw InputError({"tube-twist.csv", 0, ""}, fmt::format("has no row at {} rad/nm", tube_twist_rate),
                   "restore the shipped file");
}

// --- rope7-md ---

Specimen seven_tubes(const ChartModel& model) {
  const ParameterSet set = read_parameters(find_parameters(set_name, ""));
  const TwistedRope rope = rope_of_length("rope-7-short", 8, set);
  Specimen s = parallel_tubes(model, 7, clamped_length(rope, set), (rope.band_rows - 0.5) * row_distance(set));
  s.angle = md_angle;
  s.follow(60, 30, md_increment);
  return s;
}

std::vector<ChartReference> atoms_of_seven_tubes() {
  const ReferenceTable t = atoms_table("rope-7-short");
  const std::vector<TwistedState> states = states_of(t, false);
  const TwistedState& at = states.at(md_increment);
  return {{"energy", at.total - states[0].total}, {"end_moment", at.moment * units::eV_in_nN_nm}};
}

// --- rope91 ---

Specimen rope_of_91(const ChartModel& model, double angle, double ramp, int increments) {
  Specimen s = parallel_tubes(model, 91, rope_length, 0);
  s.angle = angle;
  s.axial_free = true;
  s.follow(ramp, 20, increments);
  return s;
}

// --- rope19-thin, rope19-wide ---

// Has the same number of elements, of the set's own length, turned so that the walls are sheared alike.
Specimen rope_of_19(const ChartModel& model, const char* set) {
  const ParameterSet parameters = read_parameters(find_parameters(set, ""));
  const double length = 30 * parameters.element_length;
  Specimen s = parallel_tubes(model, 19, length, 0, set, parameters.element_length);
  s.angle = wall_shear / parameters.radius * length;
  s.axial_free = true;
  s.follow(60, 30, 10);
  return s;
}

// --- rope19-moment ---

Specimen rope_under_moment(const ChartModel& model, double moment) {
  Specimen s = parallel_tubes(model, 19, moment_length, 0);
  s.moment = moment * units::nN_nm;
  s.follow(moment_ramp, moment_hold);
  return s;
}

// --- crossed-tubes ---

// One tube along x, the other at an angle above it; the crossing on the axis z.
Specimen crossed_tubes(const ChartModel& model) {
  const int bonds = bonds_of(model, crossed_length);
  const double a = crossed_length / bonds;
  Specimen s = empty_specimen(model, a, true);
  s.state = State(static_cast<std::size_t>(2 * (bonds + 1)));
  const ReferenceTable atoms = atoms_table("crossed-tubes");
  const double distance = atoms.column("distance_nm")[2];  // distance of the energy minimum at 90 degrees
  for (const int tube : {0, 1}) {
    const double angle = tube * crossed_from * units::degree;
    const Vector3 along(std::cos(angle), std::sin(angle), 0);
    const int first = s.topology.elements();
    s.topology.add_tube(bonds + 1);
    for (int e = 0; e <= bonds; ++e) {
      const auto i = static_cast<std::size_t>(first + e);
      s.state.position.set(i, (e - 0.5 * bonds) * a * along + Vector3(0, 0, tube * distance));
      s.state.orientation.set(i, Quaternion::FromTwoVectors(Vector3::UnitZ(), along));
      s.twist_share.push_back(tube);
    }
    s.grips.push_back(first);
    s.grips.push_back(first + bonds);
  }
  s.angle = (crossed_to - crossed_from) * units::degree;
  s.follow(300, 100, 6);
  s.moment_resists = false;
  s.above_start = false;
  return settled(model, std::move(s));
}

std::vector<ChartReference> atoms_of_crossed_tubes() {
  const ReferenceTable t = atoms_table("crossed-tubes");
  const std::vector<double> angle = t.column("angle_deg"), energy = t.column("energy_eV"),
                            torque = t.column("torque_eV_per_rad");
  const auto first = std::find(angle.begin(), angle.end(), crossed_to) - angle.begin();
  const auto at_rest = static_cast<std::size_t>(first) + 2;
  return {{"energy", energy.at(at_rest)}, {"end_moment", torque.at(at_rest) * units::eV_in_nN_nm}};
}

// --- ring ---

// Round the line y through (R, 0, 0), from the origin along z and back to it: both ends in one place.
Specimen closed_ring(const ChartModel& model) {
  const int bonds = bonds_of(model, ring_length);
  const double a = ring_length / bonds, step = 2 * units::pi / bonds;
  Specimen s = empty_specimen(model, a, false);
  s.topology.add_tube(bonds + 1);
  s.state = State(static_cast<std::size_t>(bonds + 1));
  const double radius = 0.5 * a / std::sin(0.5 * step);
  for (int e = 0; e <= bonds; ++e) {
    const auto i = static_cast<std::size_t>(e);
    s.state.position.set(i, {radius * (1 - std::cos(e * step)), 0, radius * std::sin(e * step)});
    s.state.orientation.set(i, turn_about(Vector3::UnitY(), e * step));
    s.twist_share.push_back(e / double(bonds) - 0.5);
  }
  s.about_itself = true;
  s.grips = {0, bonds};
  s.angle = ring_twist;
  s.follow(200, 50, 6);
  s.interior_follows = false;
  s.above_start = false;
  return settled(model, std::move(s));
}

// --- film ---

Specimen free_film(const ChartModel& model) {
  Specimen s = empty_specimen(model, film_length / bonds_of(model, film_length), true);
  FilmSource film;
  film.tubes = film_tubes;
  film.length = film_length;
  film.width = film.depth = film_side;
  film.spacing = film_spacing;
  Random random(s.scene.start.seed);
  film.place(s.scene, s.spacing, random, s.topology, s.state);
  s.twist_share.assign(s.state.size(), 0.0);
  s.is_rope = s.starts_at_rest = s.above_start = false;
  s.follow(film_time, film_time);
  return settled(model, std::move(s));
}

std::vector<ChartScene> all_scenes() {
  return {
      {"tube-twist",
       "One tube, twisted",
       fmt::format("One (10,10) tube of {:.4g} nm between its grips, twisted by {:.4g} rad ({:.3g} rad/nm, within "
                   "the elastic window) in 200 ps and held for 50. Atoms: a uniformly twisted periodic cell of the "
                   "same twist, energy per length times this length.",
                   tube_length, tube_twist_rate * tube_length, tube_twist_rate),
       false,
       {"energy", "end_moment"},
       twisted_tube,
       atoms_of_tube},
      {"rope7-md",
       "Seven tubes against atoms",
       "Seven (10,10) tubes of 8.11 nm between rigid grips at a fixed distance, turned by 18 degrees in 60 ps and "
       "held for 30. Atoms: the same rope in LAMMPS (case rope-7-short), with the Tersoff potential within tubes "
       "and Lennard-Jones between them, relaxed at each increment.",
       true,
       {"energy", "end_moment", "beta", "spacing", "bending_moment"},
       seven_tubes,
       atoms_of_seven_tubes},
      {"rope91",
       "91 tubes of 41 nm",
       "91 (10,10) tubes of 40.7 nm between grips that turn as rigid discs by 90 degrees in 40 ps and are held for "
       "20. At its grip each tube is free along the axis, so that tubes slide.",
       true,
       {"energy", "beta", "spacing", "end_moment", "bending_moment", "Q"},
       [](const ChartModel& m) { return rope_of_91(m, rope_angle, 40, 15); },
       {}},
      {"rope91-strong",
       "91 tubes of 41 nm, strongly twisted",
       fmt::format("The same rope turned by {:.0f} degrees in 60 ps, {:.2g} rad/nm, and held for 20. Turned by 200 "
                   "degrees, its rim folds at the discs: no model here describes that.",
                   strong_angle / units::degree, strong_angle / rope_length),
       true,
       {"energy", "beta", "spacing", "end_moment", "bending_moment", "Q"},
       [](const ChartModel& m) { return rope_of_91(m, strong_angle, 60, 22); },
       {}},
      {"rope19-thin",
       "19 thin tubes",
       fmt::format("19 (5,5) tubes of 30 elements between grips that turn as rigid discs until the walls are "
                   "sheared by {:g}, in "
                   "60 ps, and are held for 30. The tubes slide in the grips.",
                   wall_shear),
       true,
       {"energy", "beta", "spacing", "end_moment", "bending_moment"},
       [](const ChartModel& m) { return rope_of_19(m, "cnt-5-5-tersoff"); },
       {},
       true,
       false},
      {"rope19-wide",
       "19 wide tubes",
       "The same with (20,20) tubes.",
       true,
       {"energy", "beta", "spacing", "end_moment", "bending_moment"},
       [](const ChartModel& m) { return rope_of_19(m, "cnt-20-20-tersoff"); },
       {},
       true,
       false},
      {"rope19-moment",
       "19 tubes under a moment",
       fmt::format("19 (10,10) tubes of {:.4g} nm with free ends. A couple of {:g} nN nm acts on either end of "
                   "each tube, ramped in {:g} ps from rest and held for {:g}. The twist is the response and "
                   "vibrates; observables are means over one period.",
                   moment_length, end_moment, moment_ramp, moment_hold),
       true,
       {"energy", "beta", "end_angle", "spacing", "bending_moment"},
       [](const ChartModel& m) { return rope_under_moment(m, end_moment); },
       {},
       false},
      {"rope19-strong-moment",
       "19 tubes under a strong moment",
       fmt::format(
           "The same under {:g} nN nm, which twists each tube by {:.2g} rad/nm, as in the published ropes, "
           "with Hooke's bonds. A real (10,10) tube collapses at half of that twist, and bonds as soft as its "
           "atoms bear no such moment.",
           strong_moment, strong_moment * units::nN_nm / read_parameters(find_parameters(set_name, "")).bond.twist),
       true,
       {"energy", "beta", "end_angle", "spacing", "bending_moment"},
       [](ChartModel m) {
         m.hooke = true;
         return rope_under_moment(m, strong_moment);
       },
       {},
       false,
       true,
       false},
      {"film",
       "A film of 40 tubes",
       fmt::format(
           "{} (10,10) tubes of {:.4g} nm, laid at random over one another in a square of {:g} nm. They bend "
           "towards one another for {:g} ps. Energies are those of contact and bonds.",
           film_tubes, film_length, film_side, 2 * film_time),
       true,
       {"energy", "bending_moment"},
       free_film,
       {},
       false},
      {"crossed-tubes",
       "Two crossed tubes",
       "Two (10,10) tubes of 10.8 nm between held ends, crossed at 90 degrees at the distance of the energy "
       "minimum. The ends of one tube are turned to 30 degrees in 300 ps and held for 100. The energy is that of "
       "contact and bonds; the end moment is that which turns the tubes parallel. Atoms: frozen tubes at this "
       "distance and angle, mean over registries (case crossed-tubes); bending between the held ends adds less "
       "than 1 %.",
       true,
       {"energy", "end_moment", "spacing"},
       crossed_tubes,
       atoms_of_crossed_tubes},
      {"ring",
       "A tube closed to a ring, twisted",
       fmt::format("One (10,10) tube of {:.4g} nm bent into a circle with both ends held in one place. The ends "
                   "turn against each other by {:g} rad in 200 ps, half of the twist at which a ring leaves its "
                   "plane, and are held for 50. Energies are above that of the straight tube.",
                   ring_length, ring_twist),
       false,
       {"energy", "end_moment", "bending_moment"},
       closed_ring,
       {}},
  };
}

LoadsAndConstraints ramped_moment(const Specimen& s) {
  std::vector<int> upper, lower;
  for (const int e : s.grips) (s.twist_share[static_cast<std::size_t>(e)] > 0 ? upper : lower).push_back(e);
  TwistLoad twist;
  twist.moment = s.moment;
  twist.rate = s.moment / s.ramp;
  LoadsAndConstraints loads;
  loads.add(twist.on_grip(upper, 1));
  loads.add(twist.on_grip(lower, -1));
  return loads;
}

}  // namespace

FixLoad Specimen::still(int grip) const { return FixLoad({grip}, true, true, !axial_free, true); }

LoadsAndConstraints Specimen::held() const {
  LoadsAndConstraints loads;
  if (moment > 0) return loads;
  for (const int e : grips) loads.add(still(e));
  return loads;
}

LoadsAndConstraints Specimen::loads() const {
  if (moment > 0) return ramped_moment(*this);
  LoadsAndConstraints loads;
  std::set<double> shares;
  for (const int e : grips) shares.insert(twist_share[static_cast<std::size_t>(e)]);
  for (const double part : shares) {
    PrescribedRotation load;
    for (const int e : grips)
      if (twist_share[static_cast<std::size_t>(e)] == part) load.elements.push_back(e);
    load.angle = part * angle;
    load.rate = load.angle / ramp;
    load.axial_free = axial_free;
    if (part != 0)
      loads.add(load);
    else
      for (const int e : load.elements) loads.add(still(e));
  }
  return loads;
}

const std::vector<ChartScene>& chart_scenes() {
  static const std::vector<ChartScene> scenes = all_scenes();
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
