// Two crossed tubes: energy and torque against the angle and the distance of the axes.
//
// Atoms: frozen finite tubes, so long that no end is within reach of the crossing, averaged over 48 registries; the
// torque is the sum of r x F of LAMMPS over one tube about the line through both centres. Model: two rows of
// elements with the `line` law, whose energy is E90/sin(angle) without an angular factor of its own.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "cases/common/tube_curve.hpp"
#include "cases/common/tube_pair.hpp"

namespace ropewalk::validate::crossed_tubes {
namespace {

// Fixed beforehand.
constexpr double energy_tolerance = 0.03, torque_tolerance = 0.05, spacing_tolerance = 0.005;
constexpr double tube_length = 12;  // nm
constexpr int registry_count = 48;
constexpr double angles[] = {30, 45, 60, 75, 90};                                        // degrees
constexpr double offsets[] = {-0.04, -0.02, 0, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6};  // nm beyond rest at 90 degrees
constexpr double fit_reach = 0.04;
constexpr double angle_step = 2;  // degrees: torque by differences
constexpr int sides = 3;

// Tube two before its displacement along x: turned from the axis z towards y.
std::vector<Vector3> crossing_tube(const std::vector<Vector3>& atoms, double angle) {
  const Eigen::AngleAxisd rotation(-angle, Vector3::UnitX());
  std::vector<Vector3> turned;
  for (const Vector3& atom : atoms) turned.push_back(rotation * atom);
  return turned;
}

// One registry at one angle: the distances at angle - step, angle and angle + step.
std::string crossing_input(const MdSession& session, const std::string& data, double rest) {
  std::string input = pair_commands(session, "s s s", data);
  // r x F about the line of both centres: of the x component only y and z count.
  input +=
      "variable lever atom y*fz-z*fy\ncompute torque two reduce sum v_lever\n"
      "thermo_style custom step pe c_torque\nthermo_modify norm no lost error\n";
  double last = 0;
  for (int side = 0; side < sides; ++side) {
    if (side > 0) input += fmt::format("displace_atoms two rotate 0 0 0 1 0 0 {:.12g} units box\n", -angle_step);
    for (const double offset : offsets) {
      input += move_two({rest + offset - last, 0, 0}) + print_values("crossed", "$(pe:%.15g) $(c_torque:%.15g)");
      last = rest + offset;
    }
  }
  return input;
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const Chirality c = set.chirality;
  const TubeShape shape = session.rest_shape();
  const long hexagons = hexagons_in(c, shape, tube_length);
  const double length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  const Shell shell{shape.radius, 2 / (2 * units::pi * shape.radius * shape.length_per_hexagon)};
  const double rest = calibrate::crossed_well(session.atom_law(), shell, shell, units::pi / 2).distance;
  std::string input = "# frozen crossed tubes at several angles and distances, for several registries\n";
  int number = 0;
  for (const double angle : angles)
    for (const Registry& r : registries(registry_count)) {
      const std::string data = fmt::format("crossed-{}.data", number++);
      const std::vector<Vector3> two = crossing_tube(centred_tube(c, shape, hexagons, r.turn_j, r.shift_j),
                                                     (angle - angle_step) * units::degree);
      session.write(data, data_file({centred_tube(c, shape, hexagons, r.turn_i, r.shift_i), two}, 0.5 * length + 2,
                                    -0.5 * length - 1, 0.5 * length + 1, session.potential().honeycomb));
      input += crossing_input(session, data, rest);
    }
  const std::size_t count = std::size(offsets), all = std::size(angles);
  const auto results = session.run("crossed", input, all * registry_count * sides * count, 2);
  ReferenceTable t = session.table(fmt::format("Energy and torque of two frozen crossed {} tubes", tube_name(set)),
                                   "crossed-tubes", true,
                                   {"angle_deg", "distance_nm", "energy_eV", "registry_deviation_eV",
                                    "torque_eV_per_rad", "torque_of_forces_eV_per_rad", "length_nm"});
  t.add("registries", fmt::format("{}, averaged at each angle and distance", registry_count));
  t.add("torque", fmt::format("energy at {0} degrees more less that at {0} degrees less", angle_step));
  for (std::size_t a = 0; a < all; ++a)
    for (std::size_t k = 0; k < count; ++k) {
      const auto value = [&](std::size_t r, std::size_t side, std::size_t column) {
        return results[((a * registry_count + r) * sides + side) * count + k][column];
      };
      const auto over = [&](const std::function<double(std::size_t)>& v) { return spread_over(registry_count, v); };
      const Spread energy = over([&](std::size_t r) { return value(r, 1, 0); });
      const double slope = over([&](std::size_t r) { return value(r, 2, 0) - value(r, 0, 0); }).mean;
      t.rows.push_back({angles[a], rest + offsets[k], energy.mean, energy.deviation,
                        slope / (2 * angle_step * units::degree),
                        over([&](std::size_t r) { return value(r, 1, 1); }).mean, length});
    }
  return t;
}

// Rows of elements in the place of the atoms.
struct CrossedRows {
  LineContact contact;
  int elements = 1;

  PairForce at(double angle, double distance) const {
    ElementRow i, j;
    i.elements = j.elements = elements;
    j.centre = {distance, 0, 0};
    j.axis = {0, std::sin(angle), std::cos(angle)};
    return row_contact(contact, i, j);
  }
};

struct Crossing {
  double angle = 0;  // degrees
  std::vector<double> distance, energy, deviation, torque, torque_of_forces;
};

std::vector<Crossing> crossings(const ReferenceTable& data) {
  std::vector<Crossing> list;
  for (const std::vector<double>& row : data.rows) {
    if (list.empty() || list.back().angle != row[0]) list.push_back({row[0], {}, {}, {}, {}, {}});
    list.back().distance.push_back(row[1]);
    list.back().energy.push_back(row[2]);
    list.back().deviation.push_back(row[3]);
    list.back().torque.push_back(row[4]);
    list.back().torque_of_forces.push_back(row[5]);
  }
  return list;
}

constexpr std::size_t at_rest = 2;  // index of the offset at rest

void add_checks(const Crossing& c, const CrossedRows& rows, CaseResult& result) {
  const double angle = c.angle * units::degree, distance = c.distance[at_rest];
  const LineWell atoms = lowest_of(c.distance, c.energy, fit_reach);
  const LineWell model = detail::lowest_point([&](double d) { return rows.at(angle, d).energy; },
                                              c.distance.front(), c.distance.front() + 0.15);
  const std::string name = fmt::format("{:.0f} degrees: ", c.angle);
  result.check_relative(name + "least energy", model.energy, atoms.energy, energy_tolerance, "eV",
                        fmt::format("minimum over the distance; the standard deviation over registries is {:.1f} %",
                                    100 * c.deviation[at_rest] / std::abs(atoms.energy)));
  result.check_relative(name + "distance of rest", model.distance, atoms.distance, spacing_tolerance, "nm");
  // At 90 degrees the torque vanishes by symmetry.
  if (c.angle > 80) return;
  result.check_relative(name + "torque towards parallel", rows.at(angle, distance).torque_j.x(), c.torque[at_rest],
                        torque_tolerance, "eV/rad", fmt::format("at {:.3f} nm", distance));
  result.show_relative(name + "torque by the atoms' forces over that by their energy",
                       c.torque_of_forces[at_rest] / c.torque[at_rest], 1, torque_tolerance, "1",
                       "the forces of LAMMPS leave out the step of the truncated law at its cutoff");
}

CaseFigure angle_figure(const std::vector<Crossing>& list, const CrossedRows& rows, bool torque) {
  ChartLine atoms{"atoms (LAMMPS)", {}, {}, 0};
  atoms.points = true;
  ChartLine model{"model", {}, {}, 1};
  const double distance = list.front().distance[at_rest];
  for (const Crossing& c : list) {
    atoms.x.push_back(c.angle);
    atoms.y.push_back(torque ? c.torque[at_rest] : c.energy[at_rest]);
  }
  for (double angle = 30; angle <= 90; angle += 2) {
    const PairForce f = rows.at(angle * units::degree, distance);
    model.x.push_back(angle);
    model.y.push_back(torque ? f.torque_j.x() : f.energy);
  }
  return case_figure(
      torque ? "Torque of two crossed tubes against angle" : "Energy of two crossed tubes against angle",
      {"crossing angle", "degrees"},
      torque ? ChartAxis{"torque towards parallel", "eV/rad"} : ChartAxis{"energy", "eV"},
      torque ? "The torque turns crossed tubes towards parallel."
             : fmt::format("At {:.3f} nm, the distance of the energy minimum at 90 degrees.", distance),
      {model, atoms});
}

CaseFigure distance_figure(const std::vector<Crossing>& list, const CrossedRows& rows) {
  CaseFigure figure = case_figure("Energy of two crossed tubes against distance", {"distance of the axes", "nm"},
                                  {"energy", "eV"}, "The distance of the minimum does not depend on the angle.");
  int colour = 0;
  for (const Crossing& c : list) {
    ChartLine model{fmt::format("{:.0f} degrees, model", c.angle), {}, {}, colour};
    ChartLine atoms{fmt::format("{:.0f} degrees, atoms", c.angle), c.distance, c.energy, colour++};
    atoms.points = true;
    for (double d = c.distance.front(); d < c.distance.back(); d += 0.02) {
      model.x.push_back(d);
      model.y.push_back(rows.at(c.angle * units::degree, d).energy);
    }
    figure.chart.lines.push_back(model);
    figure.chart.lines.push_back(atoms);
  }
  return figure;
}

CaseFigure residual_figure(const std::vector<Crossing>& list, const CrossedRows& rows) {
  CaseFigure figure =
      case_figure("Residual of the energy of two crossed tubes", {"distance of the axes", "nm"},
                  {"model minus atoms, over the well", "%"}, "In percent of the lowest energy at each angle.");
  figure.chart.height = 220;
  int colour = 0;
  for (const Crossing& c : list) {
    ChartLine line{fmt::format("{:.0f} degrees", c.angle), {}, {}, colour++};
    const double well = std::abs(*std::min_element(c.energy.begin(), c.energy.end()));
    for (std::size_t k = 0; k < c.distance.size(); ++k) {
      line.x.push_back(c.distance[k]);
      line.y.push_back(100 * (rows.at(c.angle * units::degree, c.distance[k]).energy - c.energy[k]) / well);
    }
    figure.chart.lines.push_back(line);
  }
  return figure;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const CaseTube tube = context.tube();
  const ReferenceTable data = reference(
      context, tube.set, "crossed-tubes", 0.001, [&] { return make_reference(context, tube.set); }, result);
  const ParameterSet& set = tube.model;
  const double length = data.column("length_nm").front();
  CrossedRows rows;
  rows.elements = static_cast<int>(std::lround(length / set.element_length));
  rows.contact = contact_of(set, set, length / rows.elements);
  const std::vector<Crossing> list = crossings(data);
  for (const Crossing& c : list) add_checks(c, rows, result);
  result.figures.push_back(angle_figure(list, rows, false));
  result.figures.push_back(angle_figure(list, rows, true));
  result.figures.push_back(distance_figure(list, rows));
  result.figures.push_back(residual_figure(list, rows));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "crossed-tubes";
  c.order = 60;
  c.tables = {"crossed-tubes"};
  c.lammps_seconds = [](const ParameterSet& set) { return 0.6 * set.atoms_per_length; };
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  c.stays_green = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::crossed_tubes
