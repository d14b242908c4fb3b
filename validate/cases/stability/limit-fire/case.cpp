// Relaxations that take a saddle for a minimum, or that run out of steps.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cases/common/stability_limit.hpp"

namespace ropewalk::validate::fire {
namespace {

constexpr int bonds = 12;
constexpr double bent = 0.5;  // nm at the tip: no longer straight

// A column held at its foot, its tip pressed down by `load` (eV/nm).
struct Column {
  Chain chain;
  explicit Column(const ParameterSet& set, double load) : chain(set, bonds) {
    chain.loads.add(FixLoad({0}));
    chain.loads.add(ForceLoad({chain.last}, Vector3(0, 0, -load)));
    const double shortened = set.element_length * (1 - load / set.bond.stretch);
    for (int i = 0; i <= bonds; ++i) chain.state.position.set(static_cast<std::size_t>(i), {0, 0, i * shortened});
  }
};

struct Rest {
  bool said = false;  // that it is at rest
  double tip = 0;     // nm beside the axis
  long steps = 0;
};

Rest relaxed(const Column& c, double tolerance, long most) {
  Simulation s = c.chain.make();
  Rest r;
  r.said = s.relax(tolerance, most, [](long) { return true; });
  r.tip = std::hypot(s.state().position.x[bonds], s.state().position.y[bonds]);
  r.steps = static_cast<long>(s.state().step);
  return r;
}

// pi^2 EI/(4 L^2), lowered by shear (Engesser).
double buckling_load(const ParameterSet& set) {
  const double length = bonds * set.element_length;
  const double euler = units::pi * units::pi * set.bond.bend / (4 * length * length);
  return set.bond.shear > 0 ? euler / (1 + euler / set.bond.shear) : euler;
}

// The softest motion of the compressed column: displacements along x and turns about y, and its stiffness.
struct Mode {
  double stiffness = 0;       // negative beyond the buckling load
  Eigen::VectorXd amplitude;  // tip moves by 1 nm
};

Mode softest_mode(const ParameterSet& set, const State& state) {
  std::vector<int> freedoms;
  for (int i = 1; i <= bonds; ++i) {
    freedoms.push_back(6 * i);
    freedoms.push_back(6 * i + 4);
  }
  const Eigen::MatrixXd k = tangent_stiffness(set.bond, set.element_length, state, freedoms);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (k + k.transpose()));
  Mode m;
  m.stiffness = solver.eigenvalues()[0];
  m.amplitude = solver.eigenvectors().col(0);
  m.amplitude /= m.amplitude[2 * (bonds - 1)];
  return m;
}

void displace(State& state, const Mode& mode, double by) {
  for (int i = 1; i <= bonds; ++i) {
    const auto at = static_cast<std::size_t>(i);
    state.position.add(at, {by * mode.amplitude[2 * (i - 1)], 0, 0});
    state.orientation.set(
        at, turn_about(Vector3::UnitY(), by * mode.amplitude[2 * (i - 1) + 1]) * state.orientation[at]);
  }
}

// The buckling load (eV/nm) of a column that starts a picometre off its axis.
double load_found(const ParameterSet& model, const ParameterSet& oracle) {
  const double about = buckling_load(oracle);
  const auto fails = [&](double load) {
    Column c(model, load);
    displace(c.chain.state, softest_mode(model, c.chain.state), 1e-3);
    return relaxed(c, 1e-7, 60000).tip > bent;
  };
  return limit_between(fails, 0.7 * about, 1.5 * about, 5e-3);
}

// The smallest initial bow (nm at the tip) from which a relaxation to `tolerance` leaves the straight line.
double smallest_bow(const ParameterSet& model, double load, double tolerance) {
  const Column straight(model, load);
  const Mode mode = softest_mode(model, straight.chain.state);
  const auto leaves = [&](double bow) {
    Column c = straight;
    displace(c.chain.state, mode, bow);
    return relaxed(c, tolerance, 60000).tip > bent;
  };
  return limit_between(leaves, 1e-7, 0.1, 1e-3);
}

// The bow whose largest force along the softest mode of the oracle's bonds equals the tolerance.
double bow_in_theory(const ParameterSet& oracle, double load, double tolerance) {
  const Mode mode = softest_mode(oracle, Column(oracle, load).chain.state);
  double largest = 0;
  for (Eigen::Index k = 0; k < mode.amplitude.size(); ++k)
    largest = std::max(largest, std::fabs(mode.amplitude[k]) / (k % 2 ? oracle.radius : 1));
  return tolerance / (std::fabs(mode.stiffness) * largest);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double theory = buckling_load(oracle), found = load_found(model, oracle);
  CaseResult result;
  result.check_relative("load at which a relaxed column gives way", found, theory, 0.05, "eV/nm",
                        "from a bow of 1 pm");
  result.limits.push_back({"load at which relaxation leaves a column", found, theory, "eV/nm", Limit::Guard::none,
                           "not needed: this is the physics of the column"});

  const double load = 1.2 * theory, tolerance = 1e-4;
  const Rest straight = relaxed(Column(model, load), tolerance, 20000);
  result.check_absolute("straight, 20 % above that load: bow at which the relaxation ends", straight.tip, 0, 1e-9,
                        "nm", straight.said ? "says that it is relaxed" : "says nothing");
  const double bow = smallest_bow(model, load, tolerance), bow_theory = bow_in_theory(oracle, load, tolerance);
  result.check_relative("smallest bow that leaves the saddle", 1e3 * bow, 1e3 * bow_theory, 0.05, "pm",
                        "20 % above the load, tolerance 1e-4 eV/nm");
  result.limits.push_back({"bow below which a saddle is taken for rest", 1e3 * bow, 1e3 * bow_theory, "pm",
                           Limit::Guard::told, "the largest force and the tolerance; start with perturbation_nm"});

  // Near the load the softest motion becomes slow, and its forces small.
  std::vector<double> part, steps, left, allowed;
  for (const double p : {0.0, 0.3, 0.6, 0.8, 0.9, 0.95, 0.98}) {
    Column c(model, p * theory);
    displace(c.chain.state, softest_mode(model, c.chain.state), 0.1);
    const Rest r = relaxed(c, 1e-6, 200000);
    part.push_back(p);
    steps.push_back(static_cast<double>(r.steps));
    left.push_back(1e3 * r.tip);
    allowed.push_back(1e3 * bow_in_theory(oracle, p * theory, 1e-6));
  }
  Column slow(model, 0.98 * theory);
  displace(slow.chain.state, softest_mode(model, slow.chain.state), 0.1);
  const long few = std::lround(0.5 * steps.back());
  const Rest cut = relaxed(slow, 1e-6, few);
  result.check_absolute("steps run out: reported as relaxed (1: yes)", cut.said ? 1 : 0, 0, 0, "",
                        "2 % below the load, with half of the steps that it needs");
  result.figure(
      "Steps of a relaxation near the buckling load", {"load over that of buckling", ""}, {"steps", ""},
      "At first the number of steps grows with the period of the softest motion. Close to the load the forces of "
      "this motion are so small that they fall below the tolerance before the column is straight: the relaxation "
      "ends too early.",
      {theory_curve("first point times (1 - P/Pc)^-1/2", 0, 0.98,
                    [&](double x) { return steps.front() / std::sqrt(1 - x); }),
       model_points("until 1e-6 eV/nm", part, steps)});
  result.figure(
      "Bow that is left when the relaxation ends", {"load over that of buckling", ""}, {"bow", "pm", false, true},
      "A tolerance of the force allows a bow that grows as `1/(1 - P/P_c)`. The motion does not stall; the "
      "criterion is met too early.",
      {{"tolerance over the softest stiffness", part, allowed, 0}, model_points("at 1e-6 eV/nm", part, left)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-fire";
  c.order = 90;
  c.run = run;
  c.turns_red = {wrong_EI(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::fire
