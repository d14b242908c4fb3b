// Stiffnesses of a tube of two species.
//
// Atoms: finite tubes of two lengths between held bands, differenced. The calibration strains and twists periodic cells,
// which have no ends. Model: a chain of the set.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "cases/common/strained_specimen.hpp"
#include "cases/common/tube_curve.hpp"
#include "sim/state/uniform_chain.hpp"

namespace ropewalk::validate::boron_nitride {
namespace {

constexpr double tolerance = 0.005;       // fixed beforehand
constexpr double fresh_tolerance = 1e-3;  // of the range of each column: what the minimiser leaves
constexpr double force = 1e-3;            // eV/Angstrom, norm over all atoms
// Other lengths (nm) and other strains than those of the calibration.
constexpr double short_length = 4, long_length = 7;
constexpr Amplitudes most{0.006, 0.008, 0.004};

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.rest_shape();
  const double band = held_band(session.potential());
  const std::vector<double> planes = bending_planes(c);
  const long few = hexagons_in(c, shape, short_length), extra = extra_hexagons(c, shape, long_length - short_length);
  SpecimenEnergies found{specimen_states(most, shape.radius), {}};
  const std::size_t count = found.states.size();
  std::array<std::vector<double>, 2> energy;
  std::array<double, 2> lengths{};
  for (const std::size_t longer : {std::size_t{0}, std::size_t{1}}) {
    const FiniteTube tube(c, shape, longer > 0 ? few + extra : few, band);
    const std::string name = longer > 0 ? "boron-nitride-long" : "boron-nitride-short";
    session.write(name + ".data", tube.data(session.potential().honeycomb));
    std::string input = "# a finite tube in one state after the other, each from rest\n";
    for (const double plane : planes)
      input += tube.commands(session.potential(), name + ".data", plane) +
               fmt::format("variable half equal {:.12g}\nvariable led atom 1\n", 0.5 * tube.free_length() / angstrom) +
               specimen_commands(found.states, force,
                                 fmt::format("print \"$(pe:%.15g)\" append {}.dat screen no\n", name));
    const auto rows = session.run(name, input, planes.size() * count, 1);
    energy[longer].resize(count);
    for (std::size_t i = 0; i < rows.size(); ++i)
      energy[longer][i % count] += rows[i][0] / static_cast<double>(planes.size());
    lengths[longer] = tube.free_length();
  }
  for (std::size_t i = 0; i < count; ++i)
    found.energy.push_back((energy[1][i] - energy[1][0] - energy[0][i] + energy[0][0]) / (lengths[1] - lengths[0]));
  ReferenceTable t = session.table(
      fmt::format("Energy of {} strained, twisted and bent: finite tubes, free between their bands over {:.2f} and {:.2f} "
                  "nm, differenced",
                  tube_name(set), lengths[0], lengths[1]),
      "boron-nitride", false, specimen_columns());
  add_specimen_rows(t, 0, found);
  return t;
}

// Half of the difference of the energies of both signs of the strain, over the strain.
double odd_part(const SpecimenEnergies& e, const std::function<double(std::size_t)>& energy) {
  double sum = 0;
  for (std::size_t i = 0; i < e.states.size(); ++i)
    if (e.states[i].strain != 0) sum += 0.5 * energy(i) / e.states[i].strain;
  return sum;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    if (tube.set.honeycomb.carbon())
      throw NotApplicable("the set is of carbon: tube-stretch, tube-twist and tube-bend are its cases");
    const ReferenceTable table = reference(
        context, tube.set, "boron-nitride", fresh_tolerance, [&] { return make_reference(context, tube.set); },
        result);
    const SpecimenEnergies atoms = specimen_rows(table, 0);
    const BondStiffness bond = tube.model.bond;
    compare_stiffnesses(tube.set.name, atoms, bond, tube.set.element_length, tolerance, result);
    const double model = odd_part(atoms, [&](std::size_t i) {
      const SpecimenState& s = atoms.states[i];
      return chain_energy(bond, tube.set.element_length, s.strain, s.twist, s.curvature);
    });
    result.check_relative(tube.set.name + ": part of the stretch energy that is odd in the strain", model,
                          odd_part(atoms, [&](std::size_t i) { return atoms.energy[i]; }), tolerance, "eV/nm",
                          "half of the difference of both signs, over the strain; the bond is harmonic");
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "boron-nitride";
  c.order = 37;
  c.law = Case::Law::none;
  c.sets = {"bn-10-10-extep", "bn-10-10-tersoff"};
  c.tables = {"boron-nitride"};
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, short_length + long_length,
                          static_cast<double>(specimen_states(most, set.radius).size()));
  };
  c.run = run;
  c.turns_red = {{wrong_EA(1.1), {"bn-10-10-extep: EA", "bn-10-10-tersoff: EA"}},
                 {wrong_GJ(0.9), {"bn-10-10-extep: GJ", "bn-10-10-tersoff: GJ"}},
                 {wrong_EI(1.1), {"bn-10-10-extep: EI", "bn-10-10-tersoff: EI"}}};
  c.stays_green = {wrong_contact(2)};
  for (const std::string& name : c.sets)
    c.known_misses.push_back({name + ": part of the stretch energy that is odd in the strain", {1, 0.01}});
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::boron_nitride
