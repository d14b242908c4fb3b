// Stiffnesses of a tube of several walls, by both ways of holding it.
//
// Atoms: finite specimens of two lengths between held bands, differenced wall by wall. Model: a chain with the bonds
// of [held.all] or of [held.outer].
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atomistic/walled_tube.hpp"
#include "cases/common/strained_specimen.hpp"
#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::walls {
namespace {

using calibrate::Holding, calibrate::WalledTube, calibrate::WallShape;

constexpr double tolerance = 0.005;        // fixed beforehand
constexpr double fresh_tolerance = 1e-3;   // of the range of each column: what the minimiser leaves
constexpr double force = 2e-3;             // eV/Angstrom, norm over all atoms
// Other lengths (in outer diameters) and other strains than those of the calibration.
constexpr double short_length = 3.5, long_length = 5.5;
constexpr Amplitudes most{0.006, 0.008, 0.006};

struct Way {
  Holding holding;
  int number;
  const char *in_set, *words;
};
constexpr std::array<Way, 2> ways = {
    {{Holding::all, 0, "all", "all walls held"}, {Holding::outer, 1, "outer", "the outer wall held"}}};

// The walls where the set has them, for each in whole hexagons.
struct Specimen {
  std::vector<WallShape> shapes;
  std::vector<long> short_part, extra;
  std::vector<double> difference;  // longer minus shorter specimen, nm

  explicit Specimen(const ParameterSet& set) : shapes(wall_shapes(set)) {
    for (const auto& [c, shape] : shapes) {
      short_part.push_back(hexagons_in(c, shape, 2 * set.radius * short_length));
      extra.push_back(hexagons_in(c, shape, 2 * set.radius * (long_length - short_length)));
      difference.push_back(static_cast<double>(extra.back()) * shape.length_per_hexagon);
    }
  }
  WalledTube tube(bool longer, double band) const {
    std::vector<long> free = short_part;
    for (std::size_t k = 0; longer && k < free.size(); ++k) free[k] += extra[k];
    return {shapes, free, band};
  }
};

std::vector<double> planes_of(const ParameterSet& set) {
  std::vector<double> out;
  for (const Wall& wall : set.walls)
    if (const std::vector<double> own = bending_planes(wall.chirality); own.size() > out.size()) out = own;
  return out;
}

// Energies of all walls in all states, as the mean over the planes.
std::vector<std::vector<double>> energies_of(MdSession& session, const WalledTube& tube, const Way& way,
                                             const std::vector<SpecimenState>& states,
                                             const std::vector<double>& planes, std::size_t walls,
                                             const std::string& name) {
  const LennardJones law{session.atom_law().epsilon, session.atom_law().sigma,
                         std::min(session.atom_law().cutoff, between_walls_cutoff)};
  session.write(name + ".data", tube.data());
  std::string input = "# a specimen in one state after the other, each from rest\n";
  for (const double plane : planes)
    input += tube.commands(session.potential(), law, name + ".data", way.holding, plane) +
             specimen_commands(states, force, tube.report(name));
  const auto rows = session.run(name, input, planes.size() * states.size(), walls + 2);
  std::vector<std::vector<double>> out(states.size(), std::vector<double>(walls));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < walls; ++k)
      out[i % states.size()][k] += rows[i][k] / static_cast<double>(planes.size());
  return out;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Specimen specimen(set);
  const double band = held_band(session.potential());
  const std::vector<SpecimenState> states = specimen_states(most, set.radius);
  const std::vector<double> planes = planes_of(set);
  std::array<SpecimenEnergies, ways.size()> found;
  for (const Way& way : ways) {
    std::array<std::vector<std::vector<double>>, 2> both;
    for (const bool longer : {false, true})
      both[longer ? 1 : 0] =
          energies_of(session, specimen.tube(longer, band), way, states, planes, set.walls.size(),
                      fmt::format("walls-{}-{}", way.in_set, longer ? "long" : "short"));
    SpecimenEnergies& e = found[static_cast<std::size_t>(way.number)];
    e.states = states;
    for (std::size_t i = 0; i < states.size(); ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < set.walls.size(); ++k)
        sum += (both[1][i][k] - both[1][0][k] - both[0][i][k] + both[0][0][k]) / specimen.difference[k];
      e.energy.push_back(sum);
    }
  }
  ReferenceTable t = session.table(
      fmt::format("Energy of {} strained, twisted and bent: finite specimens, free between their bands over {:.2f} and "
                  "{:.2f} nm, differenced; way 0: all walls held, 1: the outer wall",
                  tube_name(set), specimen.tube(false, band).free_length(), specimen.tube(true, band).free_length()),
      "walls", false, specimen_columns());
  t.add("between_walls", between_walls(set));
  for (const Way& way : ways) add_specimen_rows(t, way.number, found[static_cast<std::size_t>(way.number)]);
  return t;
}

// The bonds of a tube that is held this way, with the fault of the model.
BondStiffness bond_of(const CaseTube& tube, const Way& way) {
  const auto held = [&](const char* key) {
    return find_quantity(tube.set, fmt::format("held.{}.{}", way.in_set, key))->value * units::nN_nm;
  };
  const BondStiffness &model = tube.model.bond, &set = tube.set.bond;
  BondStiffness bond = model;
  bond.stretch = held("EA") * model.stretch / set.stretch;
  bond.twist = held("GJ") * model.twist / set.twist;
  bond.bend = held("EI") * model.bend / set.bend;
  return bond;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    const ReferenceTable table = reference(
        context, tube.set, "walls", fresh_tolerance, [&] { return make_reference(context, tube.set); }, result);
    for (const Way& way : ways)
      compare_stiffnesses(fmt::format("{}, {}", tube.name, way.words), specimen_rows(table, way.number),
                          bond_of(tube, way), tube.set.element_length, tolerance, result);
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "walls";
  c.order = 35;
  c.law = Case::Law::line;
  c.sets = {"cnt-5-5@10-10-tersoff"};
  c.tables = {"walls"};
  c.lammps_seconds = [](const ParameterSet& set) {
    const double states = static_cast<double>(ways.size() * specimen_states(most, set.radius).size());
    return lammps_seconds(set, 2 * set.radius * (short_length + long_length), states);
  };
  c.run = run;
  c.turns_red = {{wrong_EA(1.1), {"all walls held: EA", "the outer wall held: EA"}},
                 {wrong_GJ(0.9), {"all walls held: GJ", "the outer wall held: GJ"}},
                 {wrong_EI(1.1), {"all walls held: EI", "the outer wall held: EI"}}};
  c.stays_green = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::walls
