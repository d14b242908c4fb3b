#include "cases/common/torsion_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cases/common/scene_of_case.hpp"
#include "model/contact/line_parameters.hpp"
#include "observe/loading.hpp"
#include "scene/prepare.hpp"
#include "scene/spacing.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk::validate {
namespace {

constexpr double largest_force = 1e-4;  // eV/nm
constexpr long most_steps = 400000;

GripLoad clamp(const Topology& topology, End end, bool free_length, bool spins_free) {
  GripLoad grip;
  grip.end = end;
  grip.spin_free = spins_free;
  if (free_length) grip.axes[GripLoad::z] = {GripAxis::Is::free, {}, false};
  return grip.on_elements(tube_ends(topology)[end], topology);
}

Simulation relaxed(const RopeInMachine& rope, const State& start, bool free_length, bool spins_free, double step) {
  LoadsAndConstraints loads;
  loads.add(clamp(rope.topology, lower_end, false, spins_free));
  loads.add(clamp(rope.topology, upper_end, free_length, spins_free));
  Simulation s(rope.topology, rope.interaction, loads, start, step);
  if (!s.relax(largest_force, most_steps, [](long) { return true; }))
    throw std::runtime_error(fmt::format("a rope of {} tubes does not come to rest", rope.tubes));
  return s;
}

double apart(const Topology& topology, const State& s) {
  const EndElements ends = tube_ends(topology);
  return (centre_of(topology, s, ends[upper_end]) - centre_of(topology, s, ends[lower_end])).norm();
}

// The contact energy of element `at` of a tube with all others, eV.
double contact_of(const Topology& topology, const State& s, const ContactLaw& law, int tube, int at) {
  double sum = 0;
  const auto i = static_cast<std::size_t>(topology.tube_begin[tube] + at);
  for (int other = 0; other < topology.tubes(); ++other) {
    if (other == tube) continue;
    for (int e = topology.tube_begin[other]; e < topology.tube_begin[other + 1]; ++e) {
      const auto j = static_cast<std::size_t>(e);
      sum +=
          law.energy({0, 0}, s.position[j] - s.position[i], axis_of(s.orientation[i]), axis_of(s.orientation[j]));
    }
  }
  return sum;
}

// The energy of two parallel rows of elements side by side, eV/nm.
double side_by_side(const ContactLaw& law, double element, double distance) {
  const int reach = static_cast<int>(law.cutoff() / element) + 2;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k)
    sum += law.energy({0, 0}, Vector3(distance, 0, k * element), Vector3::UnitZ(), Vector3::UnitZ());
  return sum / element;
}

}  // namespace

RopeInMachine::RopeInMachine(const ParameterSet& with, int count, int elements) : set(with), tubes(count) {
  const std::string length_of_tubes = fmt::to_string(elements * with.element_length);
  Scene scene = scene_of_case("torsion-machine", with, {{"rope.length_nm", length_of_tubes}});
  spacing = parallel_spacing(scene, contact_law(scene).get());
  ChangedValues tubes_in_it = {{"rope.length_nm", length_of_tubes}, {"rope.tubes", fmt::to_string(count)}};
  if (count == 2)
    tubes_in_it.emplace_back("rope.places_nm", fmt::format("[[{}, 0], [{}, 0]]", -0.5 * spacing, 0.5 * spacing));
  scene = scene_of_case("torsion-machine", with, tubes_in_it);
  const Prepared p = prepare(scene);
  topology = p.topology;
  interaction = p.interaction;
  const Simulation s = relaxed(*this, p.state, true, false, p.time_step);
  straight_ = s.state();
  straight_energy_ = s.forces().energy.potential();
  length = apart(topology, straight_);
  bond_stretch_ = length / bonded();
  const int middle = elements / 2;
  const ContactLaw& law = *interaction.law;
  for (int t = 0; t < tubes; ++t) {
    radii.push_back(
        Vector3(straight_.position[static_cast<std::size_t>(topology.tube_begin[t] + middle)]).head<2>().norm());
    cohesion.push_back(-0.5 * contact_of(topology, straight_, law, t, middle) / with.element_length);
  }
  constexpr double d = 1e-3;
  const double spring =
      (side_by_side(law, with.element_length, spacing + d) + side_by_side(law, with.element_length, spacing - d) -
       2 * side_by_side(law, with.element_length, spacing)) /
      (d * d);
  modulus = 2 / std::sqrt(3.0) * spring;
}

double RopeInMachine::outer_radius() const { return *std::max_element(radii.begin(), radii.end()); }

double RopeInMachine::twist_at(double angle) const { return std::tan(angle) / outer_radius(); }

RopeInMachine::Reading RopeInMachine::wound(double twist, Length kept, bool spins_free) const {
  const bool free_length = kept == Length::free;
  const double stretch = theory(set, twist, kept, spins_free).stretch;
  State start = straight_;
  double middle = 0;
  for (const double z : start.position.z) middle += z / static_cast<double>(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vector3 at = straight_.position[i];
    const double height = at.z() - middle, slope = at.head<2>().norm() * twist / stretch;
    const Quaternion about(Eigen::AngleAxisd(twist * height, Vector3::UnitZ()));
    Quaternion q = straight_.orientation[i];
    if (slope > 0)
      q = Quaternion(Eigen::AngleAxisd(-std::atan(slope), Vector3(at.x(), at.y(), 0).normalized())) * q;
    start.position.set(i, about * Vector3(at.x(), at.y(), stretch * height));
    start.orientation.set(i, (about * q).normalized());
  }
  if (spins_free) relax_spins(topology, start);
  const double step = 0.5 * time_step_limit(topology, interaction, spacing).limit;
  Simulation s = relaxed(*this, start, free_length, spins_free, step);
  const EndReadings read = s.read_gauges();
  const Energies& e = s.forces().energy;
  Reading out;
  out.torque = 0.5 * (read[upper_end].torque.z() - read[lower_end].torque.z()) / tubes;
  out.tension = 0.5 * (read[upper_end].force.z() - read[lower_end].force.z()) / tubes;
  out.stretch = apart(topology, s.state()) / length;
  out.energy = (e.potential() - straight_energy_) / tubes;
  out.stretch_share = (e.stretch + e.shear) / e.bonds();
  out.core_pressure = TubePressures(topology, s.state(), *interaction.law, {cell()}).of(0);
  return out;
}

RopeInMachine::Reading RopeInMachine::theory(const ParameterSet& oracle, double twist, Length kept,
                                             bool spins_free) const {
  BondStiffness bond = topology.types[0].bond;
  bond.stretch = oracle.bond.stretch;
  bond.bend = oracle.bond.bend;
  bond.twist = oracle.bond.twist;
  const double a = set.element_length, disc = disc_radius();
  const auto crowding = [&](double phi) {
    if (tubes < 7) return 0.0;
    return units::pi * modulus * 9 * std::pow(phi, 4) * std::pow(disc, 6) / 384 / tubes;
  };
  // eV/nm of bonds, mean over the tubes.
  const auto bonds = [&](double phi, double lambda) {
    double sum = 0;
    for (const double rho : radii) {
      const double s = std::hypot(lambda, rho * phi);
      sum += chain_energy(bond, a, bond_stretch_ * s - 1, spins_free ? 0 : phi * lambda / s * bond_stretch_,
                          phi * rho * phi / s * bond_stretch_);
    }
    return sum / tubes;
  };
  const auto energy = [&](double phi, double lambda) {
    double bound = 0;
    for (std::size_t t = 0; t < radii.size(); ++t)
      bound += cohesion[t] / (bond_stretch_ * std::hypot(lambda, radii[t] * phi));
    const double wound = set.law<LineParameters>() ? 1 + std::pow(phi * spacing, 2) / 4 : 1;
    return bonds(phi, lambda) - wound * bound / tubes + bond_stretch_ * crowding(phi);
  };
  constexpr double step = 1e-6;
  const double relaxed = (energy(0, 1 + step) - energy(0, 1 - step)) / (2 * step);  // its remaining tension
  const auto tension = [&](double lambda) {
    return ((energy(twist, lambda + step) - energy(twist, lambda - step)) / (2 * step) - relaxed) / bond_stretch_;
  };
  Reading out;
  if (kept == Length::free) {
    double low = 0.8, high = 1.05;
    for (int k = 0; k < 60; ++k) (tension(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
    out.stretch = 0.5 * (low + high);
  }
  out.tension = kept == Length::held ? tension(1) : 0;
  out.torque = (energy(twist + step, out.stretch) - energy(twist - step, out.stretch)) / (2 * step) / bond_stretch_;
  out.energy = (energy(twist, out.stretch) - energy(0, 1)) * bonded();
  // All terms with the strain in them are counted as stretch, those with the twist too: twisted tubes of one hand
  // are stretched at another cost.
  double stretched = 0;
  for (const double rho : radii) {
    const double s = std::hypot(out.stretch, rho * twist);
    const double turned = spins_free ? 0 : twist * out.stretch / s * bond_stretch_;
    const double bent = twist * rho * twist / s * bond_stretch_;
    stretched +=
        (chain_energy(bond, a, bond_stretch_ * s - 1, turned, bent) - chain_energy(bond, a, 0, turned, bent)) /
        tubes;
  }
  out.stretch_share = stretched / bonds(twist, out.stretch);
  const double turn = twist * disc;
  out.core_pressure = -3 * modulus * turn * turn / 16;
  if (kept == Length::held) out.core_pressure += oracle.bond.stretch / cell() * std::pow(turn, 4) / 8;
  return out;
}

}  // namespace ropewalk::validate
