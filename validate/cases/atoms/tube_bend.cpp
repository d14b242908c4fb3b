// Bending of one tube beyond its kink.
// Atoms: finite tubes between held bands, bent step by step at constant arc length of the axis. The difference of
// two lengths has no ends in it and gives the energy per length, up to the first kink. Model: a chain of elements,
// EI/2 curvature^2 per length.
#include <fmt/format.h>

#include <cmath>

#include "atomistic/finite_tube.hpp"
#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::tube_bend {
namespace {

// Other lengths than those that the stiffness was fitted to.
constexpr double short_length = 8, long_length = 14;  // nm
constexpr double step = 0.0025, most = 0.06;          // nm, of curvature times radius squared
constexpr double end_band = 0.6;                      // nm, held beyond either end
constexpr double max_turn = 5.6;  // rad, between the ends of the long specimen; they meet at a larger turn

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
  const long short_part = hexagons_in(c, shape, short_length);
  const long extra = extra_hexagons(c, shape, long_length - short_length);
  std::vector<std::vector<std::vector<double>>> results;
  std::vector<double> lengths;
  for (const long hexagons : {short_part, short_part + extra}) {
    const FiniteTube finite(c, shape, hexagons, held_band(session.potential()));
    const std::string name = hexagons == short_part ? "bend-short" : "bend-long";
    session.write(name + ".data", finite.data());
    results.push_back(
        session.run(name, bend_input(finite, session.potential(), name, curvatures), curvatures.size() + 1, 1));
    lengths.push_back(finite.free_length());
  }
  ReferenceTable t = session.table(
      fmt::format("Energy of a short and a long finite {} tube against curvature, held end bands", tube_name(set)),
      "tube-bend", false, {"curvature_per_nm", "short_eV", "long_eV", "short_nm", "long_nm"});
  for (std::size_t k = 0; k <= curvatures.size(); ++k)
    t.rows.push_back({k == 0 ? 0 : curvatures[k - 1], results[0][k][0] - results[0][0][0],
                      results[1][k][0] - results[1][0][0], lengths[0], lengths[1]});
  return t;
}

TubeCurve curve_of(const CaseTube& tube, const ReferenceTable& data) {
  const std::vector<double> curvature = data.column("curvature_per_nm"), low = data.column("short_eV"),
                            high = data.column("long_eV");
  const double short_nm = data.column("short_nm").front(), long_nm = data.column("long_nm").front();
  const std::size_t whole =
      std::min(points_before_collapse(curvature, low), points_before_collapse(curvature, high));
  TubeCurve curve;
  curve.tube = tube.name;
  curve.amplitude_name = "curvature";
  curve.unit = "1/nm";
  for (std::size_t k = 0; k < curvature.size(); ++k) {
    if (k < whole) {
      curve.amplitude.push_back(curvature[k]);
      curve.atoms.push_back((high[k] - low[k]) / (long_nm - short_nm));
    }
    if (curvature[k] * (long_nm + 2 * end_band) > max_turn) continue;
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

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    const ReferenceTable data = reference(
        context, tube.set, "tube-bend", 0.02, [&] { return make_reference(context, tube.set); }, result);
    const TubeCurve curve = curve_of(tube, data);
    add_curve(curve, result);
    add_collapse(curve, curve.more_amplitude, curve.amplitude.size(),
                 "the specimen that kinks first, against the kink curvature of the set", result);
  }
  result.remarks.push_back(
      "The cross-section flattens, which the quartic term of the bond describes; without it the bond is 12 to 20 % "
      "too stiff at the kink. Beyond the kink the moment of the bond is constant, and that of the atoms falls by a "
      "third.");
  result.remarks.push_back(
      "A thin specimen that is bent far closes on itself. Turns beyond 5.6 rad are neither drawn nor compared.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "tube-bend";
  c.group = Case::Group::atoms;
  c.order = 30;
  c.sets = {"cnt-5-5-tersoff", "cnt-10-10-tersoff"};
  c.law = Case::Law::none;
  c.tables = {"tube-bend"};
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, short_length + long_length, most / step);
  };
  c.title = "One tube bent beyond its kink";
  c.why = "EI decides when a rope buckles into a helix. At the kink the model of rigid elements ends.";
  c.setup =
      "Finite tubes of {tube}, 8 and 14 nm between held bands, are bent step by step to a curvature of "
      "0.06 nm/r^2 and relaxed. The bond was fitted to other lengths.";
  c.oracle =
      "Energies of LAMMPS with the interatomic potential of the set, (E_long - E_short)/(L_long - L_short); for a "
      "chain of elements U/L = EI k^2/2 + c4 (r k)^4. Within 1 % up to the kink.";
  c.literature =
      "S. Iijima, C. Brabec, A. Maiti, J. Bernholc, J. Chem. Phys. 104, 2089 (1996), DOI 10.1063/1.470966";
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  c.stays_green = {wrong_EA(1.1), wrong_GJ(0.9), wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tube_bend
