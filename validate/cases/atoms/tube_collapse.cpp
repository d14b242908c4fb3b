// The twist at which a tube collapses, against its length.
// Atoms: finite tubes between held bands, twisted step by step with a little noise until the torque falls. Model: the
// limit of the set, which is that of a tube of its length.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atomistic/finite_tube.hpp"
#include "cases/common/tube_curve.hpp"
#include "observe/limits.hpp"

namespace ropewalk {
namespace {

constexpr ValidatedTube tube_15_15{{15, 15}, "cnt-15-15-tersoff", "(15,15)"};
constexpr ValidatedTube tubes[] = {tube_5_5, tube_10_10, tube_15_15};
constexpr double lengths[] = {12, 24, 47, 94};  // nm
// Shears times radius (nm). The torque is compared from one step to the next over the fine steps.
constexpr double rule = 0.03, first_part = 0.4, fine_from = 0.58, fine_step = 0.02, last_part = 1.16;
constexpr double tolerance = 0.06;  // of the limit: an instability scatters by 3 %, and a step is 2 %

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
  std::string input = "# twisted step by step, with a little noise, until the torque falls\n" +
                      tube.commands(potential, name + ".data") +
                      fmt::format("variable half equal {:.12g}\n", 0.5 * tube.free_length() / angstrom) +
                      "variable q equal 0.0\nvariable q0 equal 0.0\n"
                      "variable zc atom v_half*((f_ref[3]>v_half)-(f_ref[3]<-v_half))+f_ref[3]*(abs(f_ref[3])<=v_half)\n"
                      "variable turn atom (v_q-v_q0)*v_zc\n"
                      "variable new_x atom f_now[1]*cos(v_turn)-f_now[2]*sin(v_turn)\n"
                      "variable new_y atom f_now[1]*sin(v_turn)+f_now[2]*cos(v_turn)\n"
                      "minimize 0.0 1e-3 1000 20000\n" +
                      report +
                      "variable e equal $(pe:%.15g)\nvariable most equal 0.0\n";
  double last = 0;
  const double fine = twists.back() - twists[twists.size() - 2];
  int seed = 7001;
  for (const double twist : twists) {
    const double step = twist - last;
    input += fmt::format("variable q0 delete\nvariable q0 equal {:.12g}\nvariable q delete\nvariable q equal {:.12g}\n",
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

ReferenceTable make_reference(const CaseContext& context) {
  MdSession session(context);
  std::vector<std::vector<double>> rows;
  for (const ValidatedTube& tube : tubes)
    for (const double length : lengths) {
      const Chirality c = tube.chirality;
      const TubeShape shape = session.relaxed(c).shape;
      const FiniteTube finite(c, shape, hexagons_in(c, shape, length), held_band(session.potential()));
      const std::string name = fmt::format("collapse-{}-{}-{:.0f}nm", c.n, c.m, length);
      session.write(name + ".data", finite.data());
      const std::vector<double> twists = steps_of(shape.radius);
      const auto results =
          session.run(name, input_of(finite, session.potential(), name, twists), twists.size() + 1, 2, 4);
      for (const auto& row : results)
        rows.push_back({double(c.n), finite.free_length(), row[0] / angstrom, row[1] - results.front()[1],
                        shape.radius});
    }
  ReferenceTable t = session.table("Energy of finite tubes (n,n) against twist, held end bands, up to the collapse",
                                   "tube-collapse", false,
                                   {"n", "length_nm", "twist_rad_per_nm", "energy_eV", "radius_nm"});
  t.rows = rows;
  return t;
}

struct Collapse {
  double length = 0, shear = 0;
};

// Between the step of the largest torque and the next.
Collapse collapse_of(const std::vector<double>& twist, const std::vector<double>& energy, double length,
                     double radius) {
  std::size_t peak = 1;
  double largest = 0;
  for (std::size_t k = 1; k < twist.size(); ++k) {
    const double torque = (energy[k] - energy[k - 1]) / (twist[k] - twist[k - 1]);
    if (torque > largest) peak = k, largest = torque;
  }
  const std::size_t next = std::min(peak + 1, twist.size() - 1);
  return {length, 0.5 * radius * (twist[peak] + twist[next])};
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const ReferenceTable data = reference(
      context, "tube-collapse", 0.05, [&] { return make_reference(context); }, result);
  const std::vector<double> n = data.column("n"), length = data.column("length_nm"),
                            twist = data.column("twist_rad_per_nm"), energy = data.column("energy_eV"),
                            radius = data.column("radius_nm");
  for (std::size_t from = 0, to = 0; from < n.size(); from = to) {
    while (to < n.size() && n[to] == n[from] && length[to] == length[from]) ++to;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(all.begin() + static_cast<long>(from), all.begin() + static_cast<long>(to));
    };
    const Collapse c = collapse_of(part(twist), part(energy), length[from], radius[from]);
    Check check;
    check.name = fmt::format("({0},{0}) of {1:.0f} nm", n[from], c.length);
    check.value = check.reference = c.shear;
    check.tolerance = tolerance;
    result.checks.push_back(check);
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "tube-collapse";
  c.group = Case::Group::atoms;
  c.order = 25;
  c.run = run;
  return c;
});

}  // namespace
}  // namespace ropewalk
