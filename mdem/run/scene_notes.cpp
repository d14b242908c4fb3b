// Notes on a scene before and after a run: grades, warnings, error bars.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/grade.hpp"
#include "io/toml_text.hpp"
#include "model/contact/line_parameters.hpp"
#include "model/self_contact.hpp"
#include "model/units.hpp"
#include "observe/bending.hpp"
#include "observe/centre_line.hpp"
#include "run/run_directory.hpp"
#include "scene/dissipation.hpp"
#include "scene/ends/periodic.hpp"
#include "scene/laws/line.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/spacing.hpp"
#include "sim/contact/paper/law.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

// Moment over curvature of a chain of bonds bent by d each is 1 + (3 s/8 - 1/6) d^2 of the rod's.
void warn_of_long_elements(const ParameterSet& set, double length, std::vector<std::string>& warnings) {
  const double bend = set.validity.kink_curvature * length;
  const double error = std::fabs(0.375 * shear_share(set.bond, length) - 1.0 / 6) * bend * bend;
  if (error > 0.01)
    warnings.push_back(fmt::format(
        "Elements of {:.3g} nm of {} are bent by {:.2f} rad each where the tube kinks, and its stiffness is "
        "{:.0f} % off there. Take shorter elements where tubes bend strongly.",
        length, set.name, bend, 100 * error));
}

// Filaments start straight, which a natural curvature is not.
void warn_of_straight_start(const Scene& scene, std::vector<std::string>& warnings) {
  if (scene.from_file()) return;
  for (const ParameterSet& set : scene.sets) {
    const BondStiffness& k = set.bond;
    const double energy = 0.5 * ((k.bend + k.bend_difference) * k.natural.x * k.natural.x +
                                 (k.bend - k.bend_difference) * k.natural.y * k.natural.y);
    if (energy > 0)
      warnings.push_back(fmt::format(
          "{} has a natural curvature of {:.4g}/nm and starts straight, with {:.3g} eV/nm of bending. Bring it to rest "
          "first, by mode = \"relax\", and begin with its final.csv ([state]).",
          set.name, std::hypot(k.natural.x, k.natural.y), energy));
  }
}

// The `paper` law has one point on an element, so that crossed tubes feel where along their elements they cross.
void warn_of_paper(const Scene& scene, const ContactLaw* law, std::vector<std::string>& warnings) {
  const ParameterSet& set = scene.parameters();
  const auto* paper = dynamic_cast<const PaperLaw*>(law);
  if (!paper || !set.law<LineParameters>()) return;
  const PaperWells w = paper_wells(paper->contact, scene.element_length);
  const LineParameters& integral = *set.law<LineParameters>();
  const double off = std::max({std::fabs(w.parallel / integral.pair_energy - 1),
                               std::fabs(w.crossed_deepest / integral.cross90_energy - 1),
                               std::fabs(w.crossed_shallowest / integral.cross90_energy - 1)});
  if (off < 0.01) return;
  warnings.push_back(fmt::format(
      "law = \"paper\" is up to {:.2g} % off for {}. Tubes crossed at 90 degrees bind with {:.2f} to {:.2f} eV, "
      "which depends on where along their elements they cross, and the surface integral gives {:.2f} eV. Parallel "
      "tubes bind with {:.3f} eV/nm at {:.3f} nm, and the integral gives {:.3f} eV/nm at {:.3f} nm. law = \"line\" "
      "agrees with the integral.",
      100 * off, set.name, w.crossed_shallowest, w.crossed_deepest, integral.cross90_energy, w.parallel, w.spacing,
      integral.pair_energy, integral.pair_spacing));
}

// A key of earlier scenes, which belongs to a pair of elements.
void warn_of_viscosity_per_pair(const Scene& scene, std::vector<std::string>& warnings) {
  const toml::table top = parsed_toml(scene.text, scene.path);
  const double typed = top["damping"]["contact_viscosity_eV_ps_per_nm2"].value_or(0.0);
  if (!(typed > 0)) return;
  const double own = own_element_length(scene);
  const double per_length = default_viscosity * scene.damping.contact.eta /
                            contact_viscosity(default_viscosity, scene.element_length, scene.sets);
  warnings.push_back(fmt::format(
      "damping.contact_viscosity_eV_ps_per_nm2 = {:.6g} stands for pairs of elements of {:.4g} nm, the set's own "
      "length{}. damping.contact_viscosity_eV_ps_per_nm3 = {:.6g} says the same per length of contact.",
      typed, own,
      scene.element_length == own
          ? ""
          : fmt::format(", and is {:.4g} for those of {:.4g} nm", scene.damping.contact.eta, scene.element_length),
      per_length));
}

// A shorter cutoff makes another, weaker law.
void warn_of_cutoff(const Scene& scene, const ContactLaw* law, std::vector<std::string>& warnings) {
  if (scene.contact.cutoff <= 0) return;
  Scene whole = scene;
  whole.contact.cutoff = 0;
  const std::vector<ContactRange> now = contact_ranges(scene, law),
                                  own = contact_ranges(whole, contact_law(whole).get());
  double left = 1;
  for (std::size_t k = 0; k < own.size(); ++k) left = std::min(left, now[k].binding / own[k].binding);
  if (left < 0.99)
    warnings.push_back(
        fmt::format("With contact.cutoff_nm = {:.4g} two parallel tubes bind with {:.0f} % of the energy that the "
                    "law of the set gives.",
                    scene.contact.cutoff, 100 * left));
}

// Neighbours are counted within one distance of the axes, which suits one kind of tube.
void warn_of_unlike_tubes(const Scene& scene, std::vector<std::string>& warnings) {
  const auto [least, most] =
      std::minmax_element(scene.sets.begin(), scene.sets.end(),
                          [](const ParameterSet& a, const ParameterSet& b) { return a.radius < b.radius; });
  if (most->radius < 1.05 * least->radius) return;
  warnings.push_back(fmt::format(
      "Tubes of {:.3g} and {:.3g} nm radius: the packing charge Q and the voids go by the spacing of the widest "
      "tubes, and are meaningless for narrow ones. Q_delaunay needs no distance.",
      least->radius, most->radius));
}

// Observables of the rope as a whole take sections through elements of equal number along their tubes.
void warn_of_no_centre_line(const Topology& topology, const State& state, std::vector<std::string>& warnings) {
  const bool unequal = common_length(strands_of(topology)) == 0, opposed = !run_the_same_way(topology, state);
  if (topology.tubes() < 2 || (!unequal && !opposed)) return;
  warnings.push_back(
      fmt::format("Tubes {}: they have no common centre line, and beta_deg, geometric_twist_deg, slip_nm, Q and "
                  "all else of the "
                  "cross-section, radius_mid_nm, radius_end_nm, length_nm, amplitude_nm and windings are nan.{}",
                  unequal ? "have different numbers of elements" : "run in opposite directions",
                  opposed ? " The columns of the upper and the lower end mix both ends of the rope." : ""));
}

// Collapsed tubes twist on without end where nothing else holds the moment.
void warn_of_collapsing_moment(const Scene& scene, const Prepared& p, std::vector<std::string>& warnings) {
  // The warning is about the type that bears least.
  double most = std::numeric_limits<double>::infinity();
  std::size_t weakest = 0;
  for (const int k : p.topology.tube_type) {
    const TubeType& type = p.topology.types[static_cast<std::size_t>(k)];
    const double torque = largest_torque(type.bond, type.element_length);
    if (torque < most) most = torque, weakest = static_cast<std::size_t>(k);
  }
  const std::optional<EndMoment> load = end_moment(end_drives(p.loads, p.topology));
  const double moment = load ? load->of_each(p.topology.strands()) : 0;
  if (scene.bond.anharmonic && moment > most)
    warnings.push_back(
        fmt::format("The moment of {:.4g} nN nm on each tube is more than the {:.4g} nN nm at which the wall of {} "
                    "collapses. From "
                    "there on only stretch and contact resist it, and real tubes would be flat ribbons.",
                    moment / units::nN_nm, most / units::nN_nm, scene.sets[weakest].name));
}

// Warns of a radius for Q that reaches the second shell of the packing.
void warn_of_second_neighbours(const Scene& scene, double spacing, std::vector<std::string>& warnings) {
  const double typed = scene.observe.neighbour_radius, second = std::sqrt(3.0) * spacing;
  if (spacing > 0 && typed >= second)
    warnings.push_back(fmt::format(
        "observe.neighbour_radius_nm = {:.4g} reaches the second neighbours of the packing, at {:.4g} nm: "
        "Q and contacts count them too, and Q of a perfect rope of 19 tubes or more is below zero. Q_delaunay "
        "needs "
        "no radius.",
        typed, second));
}

// Warns of tubes long enough to come back to themselves without a kink, where the contact is left out.
void warn_of_long_exclusion(const Scene& scene, const Topology& topology, const ContactLaw* law,
                            std::vector<std::string>& warnings) {
  const double excluded = scene.contact.exclude_along_tube;
  std::vector<bool> told(scene.sets.size());
  for (int t = 0; law && t < topology.tubes(); ++t) {
    const int type = topology.tube_type[t];
    const auto set = static_cast<std::size_t>(type);
    const double loop = smallest_loop(scene.sets[set].validity.kink_curvature, law->range({type, type}));
    const double length = topology.length_of(t) * topology.type_of(t).element_length;
    if (told[set] || length <= loop || excluded <= loop) continue;
    told[set] = true;
    warnings.push_back(fmt::format(
        "contact.exclude_along_tube_nm = {:.4g}: a tube of {:.4g} nm of {} can touch itself in loops of {:.3g} nm "
        "without a kink, and {}.",
        excluded, length, scene.sets[set].name, loop,
        length <= excluded ? "nothing of it attracts itself"
                           : "parts nearer than the key along it do not attract"));
  }
}

// Drives act along and about z, whatever the axis of a snapshot is.
void warn_of_tilted_rope(const Scene& scene, const Prepared& p, std::vector<std::string>& warnings) {
  constexpr double least = 1, most = 45, parallel = 0.9;  // degrees, degrees, part of the sum of lengths
  std::string driven;
  for (const auto& drive : scene.drives)
    if (const std::string name = drive->table().name;
        (name == "grip" || name == "twist") && driven.find(name) == std::string::npos)
      driven += (driven.empty() ? "[" : ", [") + name + "]";
  if (driven.empty()) return;
  Vector3 sum = Vector3::Zero();
  double lengths = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const Vector3 along = Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t + 1] - 1)]) -
                          Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]);
    sum += along;
    lengths += along.norm();
  }
  const double tilt = std::atan2(sum.head<2>().norm(), std::fabs(sum.z())) / units::degree;
  if (!(sum.norm() > parallel * lengths) || !(tilt > least && tilt < most)) return;
  warnings.push_back(
      fmt::format("The axis of the rope stands at {:.3g} degrees to z. {} acts along and about z, not along and "
                  "about this axis. Turn the snapshot upright before it is read.",
                  tilt, driven));
}

// Runs of 19 strands of tubes of 40 nm: beyond 20 degrees five of six ended since strands slid beyond their images,
// and the sixth crept longer by itself.
void warn_of_opening_slice(const Prepared& p, std::vector<std::string>& warnings) {
  constexpr double bears = 20 * units::degree;
  const auto slices = p.loads.of<PeriodicLoad>();
  if (slices.empty() || p.topology.strands() == p.topology.tubes()) return;
  const auto begin_of = [&](int strand) {
    const int first = p.topology.groups.strand_begin[static_cast<std::size_t>(strand)];
    return Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[static_cast<std::size_t>(first)])]);
  };
  Vector3 axis = Vector3::Zero();
  for (int s = 0; s < p.topology.strands(); ++s) axis += begin_of(s) / p.topology.strands();
  double rim = 0, twist = 0;
  for (int s = 0; s < p.topology.strands(); ++s) rim = std::max(rim, (begin_of(s) - axis).head<2>().norm());
  for (const Schedule::Point& point : slices.front()->schedule().points())
    twist = std::max(twist, std::fabs(point.value));
  const double angle = std::atan(rim * twist);
  if (angle > bears)
    warnings.push_back(
        fmt::format("Tubes with ends inside of a slice slide when the slice is twisted: at {:.3g} degrees at its "
                    "surface it may open, grow longer by itself, or end the run because strands slide beyond their "
                    "images. Twist it to 15 degrees, take more periodic.images, or leave tube_length_nm away.",
                    angle / units::degree));
}

}  // namespace

std::vector<std::string> grades_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const ParameterSet& set : scene.sets) out.push_back(set.name + ": " + grade_of(set).words());
  return out;
}

std::vector<std::string> warnings_of(const Scene& scene, const Prepared& p) {
  const ContactLaw* law = p.interaction.law.get();
  std::vector<std::string> warnings;
  if (scene.contact.legacy_torque)
    warnings.push_back(
        "This run leaves out the torque that the published force code leaves out (legacy_torque), so that the rope "
        "gains energy.");
  for (const auto& drive : scene.drives) drive->warn(scene, p.topology, p.loads, warnings);
  warn_of_collapsing_moment(scene, p, warnings);
  if (scene.run.mass_scale != 1)
    warnings.push_back(fmt::format(
        "Masses are {:.4g} times those of the tubes: times, velocities and waves are not those of real tubes.",
        scene.run.mass_scale));
  warn_of_viscosity_per_pair(scene, warnings);
  if (scene.damping.local > 0)
    warnings.push_back("PFC local damping depends on the frame and does not conserve momentum.");
  if (scene.contact.law == "line" && scene.contact.nodes > 0) {
    Scene free = scene;
    free.contact.nodes = 0;
    const int needed = line_contacts(free).front().nodes_i;
    if (scene.contact.nodes < needed)
      warnings.push_back(
          fmt::format("With contact.nodes_per_element = {} tubes feel one another's elements: {} would keep the "
                      "corrugation below "
                      "2e-4 of the binding energy.",
                      scene.contact.nodes, needed));
  }
  warn_of_long_exclusion(scene, p.topology, law, warnings);
  warn_of_cutoff(scene, law, warnings);
  warn_of_unlike_tubes(scene, warnings);
  warn_of_tilted_rope(scene, p, warnings);
  warn_of_opening_slice(p, warnings);
  warn_of_no_centre_line(p.topology, p.state, warnings);
  if (const double last = protocol_time(scene);
      scene.run.mode != RunOptions::Mode::relax && last > 1.001 * p.duration)
    warnings.push_back(fmt::format(
        "The run ends at {:.4g} ps, before all drives have done what they do, at {:.4g} ps.", p.duration, last));
  warn_of_second_neighbours(scene, p.spacing, warnings);
  warn_of_paper(scene, law, warnings);
  warn_of_straight_start(scene, warnings);
  for (const ParameterSet& set : scene.sets) warn_of_long_elements(set, scene.element_length, warnings);
  return warnings;
}

// Error bars by registry, which the model leaves out, of the energies at the end of the run.
std::vector<std::string> error_bars_of(const Scene& scene, const Topology& topology,
                                       const std::vector<LogRow>& log) {
  if (scene.contact.law == "none") return {};
  double deviation = -1;
  for (const ParameterSet& set : scene.sets) deviation = std::max(deviation, registry_deviation(set));
  const std::string what =
      "Registry, how the lattices of two neighbouring tubes lie on one another, is left out: tubes are smooth. ";
  if (deviation < 0)
    return {
        what +
        "The parameter sets of this scene do not say how much that matters. For other tubes the binding energy has "
        "a "
        "standard deviation of 0.2 to 3 % over all registries, and the twisting energy of small ropes changes by "
        "some per cent at small angles."};
  std::vector<std::string> out = {
      what +
      fmt::format("Over all registries the binding energy of two real tubes has a standard deviation of {:.2g} % "
                  "of the well. Every energy, force and moment of the contact bears this error.",
                  100 * deviation)};
  if (log.empty()) return out;
  const LogRow& last = log.back();
  const double bonds = last["stretch_eV"] + last["shear_eV"] + last["bend_eV"] + last["twist_eV"];
  const double alike = deviation * std::fabs(last["vdw_eV"]), n = topology.strands();
  if (alike == 0) return out;
  const auto of_bonds = [&](double energy) { return 100 * energy / bonds; };
  std::string words = fmt::format(
      "At the end of this run the error is ± {:.3g} eV of {:.5g} eV of van der Waals energy if all pairs of "
      "neighbours "
      "have the same registry",
      alike, last["vdw_eV"]);
  if (scene.source->is_parallel()) {
    // No more circles than this touch one another in a plane.
    const double pairs = std::max(1.0, std::floor(3 * n - std::sqrt(12 * n - 3))),
                 random = alike / std::sqrt(pairs);
    words += fmt::format(
        ", and ± {:.3g} eV if the {:.0f} pairs of a close-packed rope of this size have random registries", random,
        pairs);
    if (bonds > 0)
      words += fmt::format(": {:.2g} and {:.2g} % of the energy of the bonds", of_bonds(alike), of_bonds(random));
  } else if (bonds > 0) {
    words += fmt::format(": {:.2g} % of the energy of the bonds", of_bonds(alike));
  }
  out.push_back(words + ".");
  return out;
}

}  // namespace ropewalk
