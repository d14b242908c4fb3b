// Energy of two tubes in line, end against end, against the gap between their ends.
//
// Atoms: frozen relaxed tubes that are cut flat, Lennard-Jones between them, averaged over turns about the axis.
// The end of a tube lies half a row of atoms beyond the middle of its last row, so that its length is that of the
// set. Model: two tubes of a strand.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/tube_pair.hpp"
#include "core/checks.hpp"
#include "model/contact/line_parameters.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk::validate::coaxial_ends {
namespace {

// Fixed beforehand.
constexpr double gap_tolerance = 0.002;    // nm
constexpr double energy_tolerance = 0.02;  // relative to the depth
constexpr int turn_count = 12;
constexpr double tube_length = 2.5;  // nm, beyond which no atom reaches the other tube
constexpr double fit_reach = 0.03;   // nm about the minimum

std::vector<double> gaps() {
  std::vector<double> list;
  for (int k = 0; k <= 20; ++k) list.push_back(0.16 + 0.01 * k);
  for (const double gap : {0.4, 0.45, 0.5, 0.6, 0.8, 1.0}) list.push_back(gap);
  return list;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.rest_shape();
  const long hexagons = hexagons_in(c, shape, tube_length);
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  std::string input = "# frozen tubes in line at many gaps, for several turns\n";
  for (int k = 0; k < turn_count; ++k) {
    const std::string data = fmt::format("ends-{}.data", k);
    session.write(data, data_file({centred_tube(c, shape, hexagons, 0, 0),
                                   centred_tube(c, shape, hexagons, (k + 0.5) / turn_count, 0)},
                                  4, -2 * length, 3 * length, session.potential().honeycomb));
    input += pair_commands(session, "s s s", data);
    double last = 0;
    for (const double gap : gaps()) {
      input += move_two({0, 0, length + gap - last}) + print_values("ends", "$(pe:%.15g)");
      last = length + gap;
    }
  }
  const std::size_t count = gaps().size();
  const auto results = session.run("ends", input, count * turn_count, 1);
  ReferenceTable t =
      session.table(fmt::format("Energy of two frozen {} tubes in line against their gap", tube_name(set)),
                    "coaxial-ends", true, {"gap_nm", "energy_eV", "turn_deviation_eV"});
  t.add("turns", fmt::format("{}, averaged at each gap", turn_count));
  for (std::size_t k = 0; k < count; ++k) {
    const Spread energy = spread_over(turn_count, [&](std::size_t r) { return results[r * count + k][0]; });
    t.rows.push_back({gaps()[k], energy.mean, energy.deviation});
  }
  return t;
}

std::vector<double> of_model(const ParameterSet& set, const std::vector<double>& gap) {
  const double a = set.element_length;
  Scene scene = scene_of_text(
      fmt::format("format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n[rope]\ntubes = 1\nlength_nm = {}\n"
                  "tube_length_nm = {}\nstagger = \"none\"\n[run]\nduration_ps = 1\n",
                  set.path, 20 * a, 10 * a),
      "");
  scene.sets = {set};
  Prepared p = prepare(scene);
  const auto upper = static_cast<std::size_t>(p.topology.tube_begin.at(1));
  std::vector<double> energies;
  for (const double g : gap) {
    const double move = p.state.position.z[upper - 1] + a + g - p.state.position.z[upper];
    for (std::size_t i = upper; i < p.state.size(); ++i) p.state.position.z[i] += move;
    Forces forces(p.state.size());
    compute_reference(p.topology, p.interaction, p.state, forces);
    energies.push_back(forces.energy.vdw + forces.energy.terms);
  }
  return energies;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    if (!tube.set.law<LineParameters>()) throw NotApplicable("the set has no contact law of line");
    const ReferenceTable table = reference(
        context, tube.set, "coaxial-ends", 0.001, [&] { return make_reference(context, tube.set); }, result);
    const std::vector<double> gap = table.column("gap_nm"), atoms = table.column("energy_eV"),
                              model = of_model(tube.model, gap);
    const LineWell of_atoms = lowest_of(gap, atoms, fit_reach), well = lowest_of(gap, model, fit_reach);
    result.check_absolute(tube.name + ": gap of lowest energy", well.distance, of_atoms.distance, gap_tolerance,
                          "nm", "between the ends; the last atoms are one row farther apart");
    result.check_relative(tube.name + ": energy there", well.energy, of_atoms.energy, energy_tolerance, "eV",
                          "mean over the turns of the tubes about their axis");
    double farthest = 0;
    for (std::size_t k = 0; k < gap.size(); ++k)
      if (gap[k] > of_atoms.distance - 0.02) farthest = std::max(farthest, std::fabs(model[k] - atoms[k]));
    result.check_absolute(tube.name + ": largest difference over the depth", farthest / std::fabs(of_atoms.energy),
                          0, energy_tolerance, "1");
    ChartLine points{"atoms (LAMMPS)", gap, atoms, 0};
    points.points = true;
    result.figure(fmt::format("Energy of two {} tubes in line", tube.name), {"gap between the ends", "nm"},
                  {"energy", "eV"}, "Averaged over the turns of the tubes about their axis.",
                  {{"model", gap, model, 1}, points});
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "coaxial-ends";
  c.order = 57;
  c.sets = {"cnt-10-10-tersoff", "cnt-5-5-tersoff", "cnt-15-15-tersoff"};
  c.tables = {"coaxial-ends"};
  c.lammps_seconds = [](const ParameterSet& set) { return 0.02 * set.atoms_per_length; };
  c.run = run;
  c.turns_red = {wrong_contact(1.1)};
  c.stays_green = {wrong_EA(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::coaxial_ends
