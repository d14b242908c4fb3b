// Bending of one tube beyond its kink.
// Atoms: finite tubes between held bands, bent step by step at constant arc length of the axis. The difference of
// two lengths has no ends in it and gives the energy per length, up to the first kink. Model: a chain of elements,
// EI/2 curvature^2 per length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "atomistic/finite_tube.hpp"
#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::tube_bend {
namespace {

// Other lengths than those that the stiffness was fitted to.
constexpr double short_length = 8, long_length = 14;        // nm
constexpr double step = 0.0025, most = 0.06, kink = 0.044;  // curvature times radius squared, nm
constexpr double end_band = 0.6;  // nm, held beyond either end, where a table does not say
constexpr double max_turn = 5.6;  // rad, between the ends of a specimen with its bands; they meet at a larger turn

// The factor on the usual lengths of a specimen. A specimen of a thin tube is shorter, so that it kinks before it
// closes on itself.
double part_of_length(double radius, double band) {
  return std::min(1.0, (max_turn * radius * radius / kink - 2 * band) / long_length);
}

std::string bend_input(const FiniteTube& tube, const Potential& potential, const std::string& name,
                       const std::vector<double>& curvatures) {
  const std::string relax =
      fmt::format("minimize 0.0 2e-3 1500 20000\nprint \"$(pe:%.15g)\" append {}.dat screen no\n", name);
  std::string input = "# bent step by step, with a little noise\n" + tube.commands(potential, name + ".data") +
                      calibrate::affine_bend_variables() + relax;
  double last = 0;
  int seed = 4001;
  for (const double curvature : curvatures) {
    input +=
        fmt::format("variable k0 delete\nvariable k0 equal {:.12g}\nvariable k delete\nvariable k equal {:.12g}\n",
                    last * angstrom, curvature * angstrom);
    input +=
        last == 0 ? "set group all x v_bent_x z v_bent_z\n" : "set group all x v_next_x y v_next_y z v_next_z\n";
    input += fmt::format("displace_atoms free random 0.002 0.002 0.002 {} units box\n", seed++) + relax;
    last = curvature;
  }
  return input;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.rest_shape();
  std::vector<double> curvatures;
  for (double x = step; x < most + 0.5 * step; x += step) curvatures.push_back(x / (shape.radius * shape.radius));
  const double band = held_band(session.potential()), part = part_of_length(shape.radius, band);
  const long short_part = hexagons_in(c, shape, part * short_length);
  const long extra = extra_hexagons(c, shape, part * (long_length - short_length));
  std::vector<std::vector<std::vector<double>>> results;
  std::vector<double> lengths;
  for (const long hexagons : {short_part, short_part + extra}) {
    const FiniteTube finite(c, shape, hexagons, band);
    const std::string name = hexagons == short_part ? "bend-short" : "bend-long";
    session.write(name + ".data", finite.data(session.potential().honeycomb));
    results.push_back(
        session.run(name, bend_input(finite, session.potential(), name, curvatures), curvatures.size() + 1, 1));
    lengths.push_back(finite.free_length());
  }
  ReferenceTable t = session.table(
      fmt::format("Energy of a short and a long finite {} tube against curvature, held end bands", tube_name(set)),
      "tube-bend", false, {"curvature_per_nm", "short_eV", "long_eV", "short_nm", "long_nm"});
  t.add("band_nm", fmt::format("{:.6g}", band));
  for (std::size_t k = 0; k <= curvatures.size(); ++k)
    t.rows.push_back({k == 0 ? 0 : curvatures[k - 1], results[0][k][0] - results[0][0][0],
                      results[1][k][0] - results[1][0][0], lengths[0], lengths[1]});
  return t;
}

// The number of points of a specimen that are compared. The comparison ends at the kink, where the ends of the
// specimen meet, or where the energy leaps. A remark names the cause of an end before the kink of the set.
std::size_t points_of(const std::string& which, const CaseTube& tube, const std::vector<double>& curvature,
                      const std::vector<double>& energy, double length, double band, CaseResult& result) {
  const std::size_t whole = points_before_collapse(curvature, energy),
                    sound = points_before_break(curvature, energy);
  std::size_t open = 0;
  while (open < curvature.size() && curvature[open] * (length + 2 * band) <= max_turn) ++open;
  const std::size_t points = std::min({whole, sound, open});
  if (points == whole || curvature[points] > tube.set.validity.kink_curvature) return points;
  result.remarks.push_back(
      points == open
          ? fmt::format(
                "The {} specimen of {} closes on itself at {:.3g}/nm, before the kink of the set at {:.3g}/nm. "
                "Its atoms beyond are not compared; those made anew have a shorter one.",
                which, tube.name, curvature[points], tube.set.validity.kink_curvature)
          : fmt::format(
                "The reference of the {} specimen of {} is broken from {:.3g}/nm on: its energy goes from {:.4g} "
                "to {:.4g} eV in one step, which bending does not. These atoms are not compared; make them anew.",
                which, tube.name, curvature[points], energy[points - 1], energy[points]));
  return points;
}

TubeCurve curve_of(const CaseTube& tube, const ReferenceTable& data, CaseResult& result) {
  const std::vector<double> curvature = data.column("curvature_per_nm"), low = data.column("short_eV"),
                            high = data.column("long_eV");
  const double short_nm = data.column("short_nm").front(), long_nm = data.column("long_nm").front();
  const std::string stated = data.value("band_nm");
  const double band = stated.empty() ? end_band : std::strtod(stated.c_str(), nullptr);
  const std::size_t whole = std::min(points_of("short", tube, curvature, low, short_nm, band, result),
                                     points_of("long", tube, curvature, high, long_nm, band, result));
  TubeCurve curve;
  curve.tube = tube.name;
  curve.amplitude_name = "curvature";
  curve.unit = "1/nm";
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    if (k < whole) {
      curve.amplitude.push_back(curvature[k]);
      curve.atoms.push_back((high[k] - low[k]) / (long_nm - short_nm));
    }
    if (curvature[k] * (long_nm + 2 * band) > max_turn) continue;
    curve.more_amplitude.push_back(curvature[k]);
    curve.more_atoms.push_back(high[k] / long_nm);
  }
  curve.more_name = "long specimen, kink and ends included";
  curve.model = [set = tube.model](double k) {
    return chain_energy(set.anharmonic_bond(0), set.element_length, 0, 0, k);
  };
  curve.window = curve.end = tube.set.validity.kink_curvature;
  return curve;
}

void compare(const CaseTube& tube, const ReferenceTable& data, CaseResult& result) {
  const TubeCurve curve = curve_of(tube, data, result);
  add_curve(curve, result);
  add_collapse(curve, curve.more_amplitude, curve.amplitude.size(),
               "the specimen that kinks first, against the kink curvature of the set", result);
}

const RegisteredCase registered([] {
  Case c = tube_curve_case("tube-bend", 0.02, make_reference, compare);
  c.order = 30;
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, short_length + long_length, most / step);
  };
  c.turns_red = {wrong_EI(1.1)};
  c.stays_green = {wrong_EA(1.1), wrong_GJ(0.9), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tube_bend
