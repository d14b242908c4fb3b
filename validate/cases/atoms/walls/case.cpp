// Energies of a tube of several walls, all held or the outer one held.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "atomistic/walled_tube.hpp"
#include "cases/common/tube_curve.hpp"
#include "core/checks.hpp"

namespace ropewalk::validate::walls {
namespace {

using calibrate::affine_bend_variables, calibrate::Holding, calibrate::WalledTube, calibrate::WallShape;

// Fixed beforehand.
constexpr double tolerance = 0.005;
constexpr double short_length = 4, long_length = 7;  // nm
constexpr double strain = 0.006, shear = 0.008, bend = 0.006;
constexpr double cutoff = 1.2;  // nm, between walls

struct State {
  double strain = 0, shear = 0, bend = 0;  // 1; times the outer radius
};
const State states[] = {{}, {strain, 0, 0}, {-strain, 0, 0}, {0, shear, 0}, {0, -shear, 0}, {0, 0, bend}};

std::string input_of(const WalledTube& tube, const std::string& head, double radius, const std::string& name) {
  std::string text = head + affine_bend_variables() +
                     "variable e equal 0.0\nvariable t equal 0.0\n"
                     "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n"
                     "variable turn atom v_t*v_zc*v_led\n"
                     "variable to_x atom f_ref[1]*cos(v_turn)-f_ref[2]*sin(v_turn)\n"
                     "variable to_y atom f_ref[1]*sin(v_turn)+f_ref[2]*cos(v_turn)\n"
                     "variable to_z atom f_ref[3]+v_e*v_zc*v_led\n";
  for (const State& s : states) {
    text += fmt::format(
        "variable e delete\nvariable e equal {:.12g}\nvariable t delete\nvariable t equal {:.12g}\n"
        "variable k delete\nvariable k equal {:.12g}\n",
        s.strain, s.shear / radius * angstrom, s.bend / radius * angstrom);
    text += s.bend != 0 ? "set group all x v_bent_x y f_ref[2] z v_bent_z\n" : "set group all x v_to_x y v_to_y z v_to_z\n";
    text += "minimize 0.0 1e-3 3000 30000\n" + tube.report(name);
  }
  return text;
}

// Energy per length of each state, eV/nm: the difference of both specimens, wall by wall.
std::vector<double> energies(MdSession& session, const ParameterSet& set, Holding holding) {
  std::vector<WallShape> shapes;
  for (const Wall& wall : set.walls) {
    TubeShape shape = rolled_shape(wall.chirality);
    shape.radius = wall.radius;
    shape.length_per_hexagon = 2 / wall.atoms_per_length;
    shapes.push_back({wall.chirality, shape});
  }
  const LennardJones law{session.atom_law().epsilon, session.atom_law().sigma, cutoff};
  std::vector<double> out(std::size(states));
  for (const bool longer : {true, false}) {
    std::vector<long> free;
    for (const auto& [c, shape] : shapes)
      free.push_back(hexagons_in(c, shape, short_length) +
                     (longer ? hexagons_in(c, shape, long_length - short_length) : 0));
    const WalledTube tube(shapes, free, held_band(session.potential()));
    const std::string name =
        fmt::format("{}-{}", holding == Holding::all ? "all" : "outer", longer ? "long" : "short");
    session.write(name + ".data", tube.data());
    std::string input = input_of(
        tube, tube.commands(session.potential(), law, name + ".data", holding), set.radius, name);
    const auto rows = session.run(name, input, std::size(states), shapes.size() + 2);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        const double step = static_cast<double>(hexagons_in(shapes[k].c, shapes[k].shape, long_length - short_length)) *
                            shapes[k].shape.length_per_hexagon;
        out[i] += (longer ? 1 : -1) * (rows[i][k] - rows[0][k]) / step;
      }
  }
  return out;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const std::vector<double> all = energies(session, set, Holding::all), outer = energies(session, set, Holding::outer);
  ReferenceTable t = session.table(fmt::format("Energy per length of {} by what is held", tube_name(set)), "walls", false,
                                   {"strain", "shear", "bend", "all_eV_per_nm", "outer_eV_per_nm"});
  t.add("between walls", fmt::format("Lennard-Jones of the set, cutoff {} nm, shifted", cutoff));
  for (std::size_t i = 0; i < std::size(states); ++i)
    t.rows.push_back({states[i].strain, states[i].shear, states[i].bend, all[i], outer[i]});
  return t;
}

double held(const ParameterSet& set, const char* way, const char* key) {
  return find_quantity(set, fmt::format("held.{}.{}", way, key))->value * units::nN_nm;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (const CaseTube& tube : context.tubes()) {
    if (tube.set.walls.empty()) throw NotApplicable("the set is that of one wall");
    const ReferenceTable table = reference(
        context, tube.set, "walls", 0.01, [&] { return make_reference(context, tube.set); }, result);
    const double r = tube.set.radius;
    const auto compare = [&](const char* way, const char* words, const std::vector<double>& atoms) {
      // A fault of the model's bond is one of both ways.
      const BondStiffness &wrong = tube.model.bond, &right = tube.set.bond;
      const double EA = held(tube.set, way, "EA") * wrong.stretch / right.stretch,
                   GJ = held(tube.set, way, "GJ") * wrong.twist / right.twist,
                   EI = held(tube.set, way, "EI") * wrong.bend / right.bend;
      const auto check = [&](const char* what, double model, double of_atoms) {
        result.check_relative(fmt::format("{}: {}, {}", tube.name, what, words), model, of_atoms, tolerance, "eV/nm");
      };
      check("stretch", 0.5 * EA * strain * strain, 0.5 * (atoms[1] + atoms[2]));
      check("twist", 0.5 * GJ * shear * shear / (r * r), 0.5 * (atoms[3] + atoms[4]));
      check("bend", 0.5 * EI * bend * bend / (r * r), atoms[5]);
    };
    compare("all", "all walls held", table.column("all_eV_per_nm"));
    compare("outer", "the outer wall held", table.column("outer_eV_per_nm"));
    std::vector<double> at(std::size(states)), all = table.column("all_eV_per_nm"),
                                               outer = table.column("outer_eV_per_nm");
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<double>(i);
    result.figure(fmt::format("Energy per length of {}", tube.name),
                  {"straight, +0.6 %, -0.6 % of strain, shear of ±0.8 %, bent", ""}, {"energy per length", "eV/nm"},
                  "Differences of two specimens.",
                  {model_points("all walls held", at, all), model_points("the outer wall held", at, outer)});
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "walls";
  c.order = 25;
  c.sets = {"cnt-5-5@10-10-tersoff", "cnt-10-10@15-15-tersoff"};
  c.several_walls = true;
  c.law = Case::Law::none;
  c.tables = {"walls"};
  c.lammps_seconds = [](const ParameterSet& set) {
    return lammps_seconds(set, short_length + long_length, 2 * std::size(states));
  };
  c.run = run;
  c.turns_red = {{wrong_EA(1.02), {"stretch"}}, {wrong_GJ(0.98), {"twist"}}, {wrong_EI(1.02), {"bend"}}};
  c.stays_green = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::walls
