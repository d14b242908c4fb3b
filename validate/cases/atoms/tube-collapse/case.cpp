// The twist at which a tube collapses, against its length.
// Atoms: finite tubes between held bands, twisted step by step with a little noise until the torque falls. Model:
// the limit of the set, which is that of a tube of its length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "atomistic/finite_tube.hpp"
#include "cases/common/tube_curve.hpp"

namespace ropewalk::validate::tube_collapse {
namespace {

constexpr double lengths[] = {12, 24, 47, 94};  // nm
// Shears times radius (nm). The torque is compared from one step to the next over the fine steps.
constexpr double rule = 0.03, first_part = 0.4, fine_from = 0.58, fine_step = 0.02, last_part = 1.16;
constexpr double energy_tolerance = 0.03;
// Wide tubes: their limit follows from that of 12 nm, and long ones collapse earlier than the law says.
constexpr double wide_tolerance = 0.20;
constexpr double tolerance = 0.10;  // of the limit: an instability scatters by 5 %, and a step is 2 %

std::vector<double> steps_of(double radius) {
  std::vector<double> parts = {first_part, 0.5};
  for (double part = fine_from; part < last_part + 1e-9; part += fine_step) parts.push_back(part);
  for (double& part : parts) part *= rule / (radius * radius);
  return parts;
}

// Ends after the second of two steps over which the torque fell.
std::string input_of(const FiniteTube& tube, const Potential& potential, const std::string& name,
                     const std::vector<double>& twists) {
  const std::string report = fmt::format("print \"$(v_q:%.12g) $(pe:%.15g)\" append {}.dat screen no\n", name);
  std::string input =
      "# twisted step by step, with a little noise, until the torque falls\n" +
      tube.commands(potential, name + ".data") +
      fmt::format("variable half equal {:.12g}\n", 0.5 * tube.free_length() / angstrom) +
      "variable q equal 0.0\nvariable q0 equal 0.0\n"
      "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n"
      "variable turn atom (v_q-v_q0)*v_zc\n"
      "variable new_x atom f_now[1]*cos(v_turn)-f_now[2]*sin(v_turn)\n"
      "variable new_y atom f_now[1]*sin(v_turn)+f_now[2]*cos(v_turn)\n"
      "minimize 0.0 1e-3 1000 20000\n" +
      report + "variable e equal $(pe:%.15g)\nvariable most equal 0.0\n";
  double last = 0;
  const double fine = twists.back() - twists[twists.size() - 2];
  int seed = 7001;
  for (const double twist : twists) {
    const double step = twist - last;
    input +=
        fmt::format("variable q0 delete\nvariable q0 equal {:.12g}\nvariable q delete\nvariable q equal {:.12g}\n",
                    last * angstrom, twist * angstrom);
    input += "fix now all store/state 0 x y z\nset group all x v_new_x y v_new_y\nunfix now\n";
    input += fmt::format("displace_atoms free random 0.002 0.002 0.002 {} units box\n", seed++);
    input += "minimize 0.0 3e-3 1500 20000\n" + report;
    // The work is compared over steps of equal length.
    if (std::abs(step - fine) < 0.01 * fine)
      input +=
          "variable work equal $(pe-v_e:%.15g)\n"
          "if \"${work} < $(0.9*v_most:%.15g)\" then \"jump SELF gave_way\"\n"
          "if \"${work} > ${most}\" then \"variable most delete\" \"variable most equal ${work}\"\n"
          "variable work delete\n";
    input += "variable e delete\nvariable e equal $(pe:%.15g)\n";
    last = twist;
  }
  return input + "label gave_way\n";
}

ReferenceTable make_reference(const CaseContext& context, const ParameterSet& set) {
  MdSession session(context, set);
  const TubeShape shape = session.rest_shape();
  std::vector<std::vector<double>> rows;
  for (const double length : lengths) {
    const FiniteTube finite(set.chirality, shape, hexagons_in(set.chirality, shape, length),
                            held_band(session.potential()));
    const std::string name = fmt::format("collapse-{:.0f}nm", length);
    session.write(name + ".data", finite.data(session.potential().honeycomb));
    const std::vector<double> twists = steps_of(shape.radius);
    const auto results =
        session.run(name, input_of(finite, session.potential(), name, twists), twists.size() + 1, 2, 4);
    for (const auto& row : results)
      rows.push_back({finite.free_length(), row[0] / angstrom, row[1] - results.front()[1], shape.radius});
  }
  ReferenceTable t = session.table(
      fmt::format("Energy of finite {} tubes against twist, held end bands, up to the collapse", tube_name(set)),
      "tube-collapse", false, {"length_nm", "twist_rad_per_nm", "energy_eV", "radius_nm"});
  t.rows = std::move(rows);
  return t;
}

// The energy (eV) of the last step before the torque falls.
Check energy_check(const CaseTube& tube, const ParameterSet& set, double length, const std::vector<double>& twist,
                   const std::vector<double>& energy) {
  const std::size_t last = points_before_collapse(twist, energy) - 1;
  Check check;
  check.name = fmt::format("{} of {:.0f} nm: energy before the collapse", tube.name, length);
  check.value = length * chain_energy(set.anharmonic_bond(length), set.element_length, 0, twist[last], 0);
  check.reference = energy[last];
  check.tolerance = energy_tolerance;
  check.unit = "eV";
  check.note =
      "where the limit of the set is lower than the collapse of these atoms, the torque is already constant";
  return check;
}

// Shear between the step of the largest torque and the next; NaN for a tube that holds to the end.
double collapse_of(const std::vector<double>& twist, const std::vector<double>& energy, double radius) {
  const std::size_t steps = points_before_collapse(twist, energy);
  return steps < twist.size() ? 0.5 * radius * (twist[steps - 1] + twist[steps]) : std::nan("");
}

CaseFigure limits_figure(const std::vector<ChartLine>& lines) {
  return case_figure("Collapse against length", {"length between held ends", "nm"}, {"radius times twist", "1"},
                     "Points: atoms. Lines: the limit of the sets.", lines);
}

// Torque between two steps, at their middle.
ChartLine torque_line(const std::string& name, int colour, double radius, const std::vector<double>& twist,
                      const std::vector<double>& energy) {
  ChartLine line{name, {}, {}, colour};
  for (std::size_t k = 1; k < twist.size(); ++k) {
    line.x.push_back(0.5 * radius * (twist[k] + twist[k - 1]));
    line.y.push_back((energy[k] - energy[k - 1]) / (twist[k] - twist[k - 1]));
  }
  return line;
}

CaseFigure torque_figure(std::vector<ChartLine> lines) {
  return case_figure(
      "Torque up to the collapse", {"radius times twist", "1"},
      {"energy of a step over its twist per length", "eV nm"},
      "The last point of each line is the step over which the wall collapses. The energy is that of the whole "
      "tube, so that the torque of long ones is drawn higher.",
      std::move(lines));
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  std::vector<ChartLine> lines, torques;
  int colour = 0;
  for (const CaseTube& tube : context.tubes()) {
    const ReferenceTable data = reference(
        context, tube.set, "tube-collapse", 0.05, [&] { return make_reference(context, tube.set); }, result);
    const ParameterSet& set = tube.model;
    ChartLine atoms{fmt::format("atoms, {}", tube.name), {}, {}, colour}, model{tube.name, {}, {}, colour};
    atoms.points = true;
    ++colour;
    std::map<double, std::pair<std::vector<double>, std::vector<double>>> specimens;  // twists, energies by length
    for (const std::vector<double>& row : data.rows) {
      specimens[row[0]].first.push_back(row[1]);
      specimens[row[0]].second.push_back(row[2]);
    }
    for (const auto& [length, curve] : specimens) {
      const auto& [twist, energy] = curve;
      if (torques.size() < specimens.size())
        torques.push_back(torque_line(fmt::format("{} of {:.0f} nm", tube.name, length),
                                      static_cast<int>(torques.size()), set.radius, twist, energy));
      result.checks.push_back(energy_check(tube, set, length, twist, energy));
      Check check;
      check.name = fmt::format("{} of {:.0f} nm collapses at", tube.name, length);
      check.value = set.validity.collapse_at(set.radius, length);
      check.reference = collapse_of(twist, energy, set.radius);
      check.tolerance = set.validity.endless_collapse > 0 ? tolerance : wide_tolerance;
      check.unit = "radius times twist";
      if (!std::isfinite(check.reference)) {
        result.remarks.push_back(
            fmt::format("{} of {:.0f} nm holds up to the last step, {:.4f}; the set says {:.4f}.", tube.name,
                        length, set.radius * twist.back(), check.value));
        continue;
      }
      result.checks.push_back(check);
      atoms.x.push_back(length), atoms.y.push_back(check.reference);
    }
    for (double length = 10; length <= 100; length += 2)
      model.x.push_back(length), model.y.push_back(set.validity.collapse_at(set.radius, length));
    lines.push_back(model);
    lines.push_back(atoms);
  }
  result.figures.push_back(limits_figure(lines));
  result.figures.push_back(torque_figure(torques));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "tube-collapse";
  c.order = 25;
  c.tier = Case::Tier::full;
  c.law = Case::Law::none;
  c.sets = {"cnt-10-10-tersoff", "cnt-5-5-tersoff", "cnt-15-15-tersoff"};
  c.only_these = "it compares with stored atoms of (5,5), (10,10) and (15,15), half an hour of LAMMPS";
  c.run = run;
  c.turns_red = {wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::tube_collapse
