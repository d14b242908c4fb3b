// Stretch and compression of one tube, far beyond the strains that its stiffness was fitted to.
//
// Atoms: a periodic cell, strained step by step in either direction from the relaxed tube, with a little noise so
// that it may buckle, and minimised at fixed length. Model: EA/2 strain^2 per length.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::tube_stretch {
namespace {

constexpr double cell_length = 5;  // nm: room for a buckle, which is about as long as the tube is wide
constexpr double magnitudes[] = {0.002, 0.004, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08};

std::string strain_input(const Potential& potential, const std::string& name, double length) {
  const std::string relax =
      fmt::format("minimize 0.0 3e-4 3000 30000\nprint \"$(pe:%.15g)\" append {}.dat screen no\n", name);
  std::string input = "# one periodic cell, compressed and then stretched from the relaxed tube\n";
  for (const double sign : {-1.0, 1.0}) {
    input += calibrate::cell_commands(potential, name + ".data") + relax;
    int step = 0;
    for (const double magnitude : magnitudes)
      input += fmt::format(
                   "change_box all z final 0.0 {:.12f} remap units box\n"
                   "displace_atoms all random 0.002 0.002 0.002 {} units box\n",
                   length * (1 + sign * magnitude) / angstrom, 2001 + step++) +
               relax;
  }
  return input;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.relaxed().shape;
  const long hexagons = period_hexagons(c) * std::max(1L, std::lround(cell_length / period_of(c, shape)));
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  session.write("stretch.data", data_file({tube_atoms(c, shape, hexagons)}, shape.radius + 1, 0, length,
                                          session.potential().honeycomb));
  const std::size_t steps = std::size(magnitudes) + 1;
  const auto results = session.run("stretch", strain_input(session.potential(), "stretch", length), 2 * steps, 1);
  ReferenceTable t = session.table(
      fmt::format("Energy of one {} tube against strain, periodic cell of {:.2f} nm", tube_name(set), length),
      "tube-stretch", false, {"strain", "energy_eV_per_nm"});
  const auto add = [&](double strain, std::size_t at, std::size_t zero) {
    t.rows.push_back({strain, (results[at][0] - results[zero][0]) / length});
  };
  for (std::size_t k = steps - 1; k >= 1; --k) add(-magnitudes[k - 1], k, 0);
  add(0, 0, 0);
  for (std::size_t k = 1; k < steps; ++k) add(magnitudes[k - 1], steps + k, steps);
  return t;
}

void add_buckling(const TubeCurve& curve, CaseResult& result) {
  std::vector<double> pressed, energy;
  for (std::size_t k = curve.amplitude.size(); k-- > 0;) {
    if (curve.amplitude[k] > 0) continue;
    pressed.push_back(-curve.amplitude[k]);
    energy.push_back(curve.atoms[k]);
  }
  add_collapse(
      curve, pressed, points_before_collapse(pressed, energy),
      "in compression, in a periodic cell of 5 nm; the set's value is that of a tube of 12 nm with held ends",
      result);
}

// The cell is not twisted: a chiral tube in it lacks its natural twist. It comes to rest at another length, from
// which its strain is measured.
double stretch_of_untwisted(const ParameterSet& set, double twist, double strain) {
  const auto energy = [&](double e) {
    return chain_energy(set.anharmonic_bond(0), set.element_length, e, twist, 0);
  };
  constexpr double h = 1e-4;
  const double slope = (energy(h) - energy(-h)) / (2 * h),
               bend = (energy(h) - 2 * energy(0) + energy(-h)) / (h * h);
  const double rest = -slope / bend;
  return (energy(rest + (1 + rest) * strain) - energy(rest)) / (1 + rest);
}

void compare(const CaseTube& tube, const ReferenceTable& data, CaseResult& result) {
  TubeCurve curve;
  curve.tube = tube.name;
  curve.amplitude_name = "strain";
  curve.amplitude = data.column("strain");
  curve.atoms = data.column("energy_eV_per_nm");
  curve.model = [set = tube.model, twist = -natural_twist(tube.set)](double strain) {
    return stretch_of_untwisted(set, twist, strain);
  };
  curve.window = curve.end = tube.set.validity.stretch;
  add_buckling(curve, result);
  end_at_collapse(curve);
  add_curve(curve, result);
}

const RegisteredCase registered([] {
  Case c = tube_curve_case("tube-stretch", 0.01, make_reference, compare);
  c.order = 10;
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, cell_length, 2 * std::size(magnitudes));
  };
  c.turns_red = {wrong_EA(1.1)};
  c.stays_green = {wrong_GJ(0.9), wrong_EI(1.1), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tube_stretch
