// Numbers that are not finite, and kicks and couples that lead to them.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cases/common/stability_limit.hpp"
#include "model/error.hpp"

namespace ropewalk::validate::nan {
namespace {

constexpr int bonds = 10;
constexpr std::size_t hit = 6;

// Step and element at which a run ends; none where it continues.
struct End {
  bool stopped = false;
  long step = 0;
  int element = -1;
};

End run_of(const Chain& c, long steps) {
  try {
    Simulation s = c.make();
    s.steps(steps);
  } catch (const NumericalError& e) {
    return {true, e.step(), e.element()};
  }
  return {};
}

double step_of(const ParameterSet& set) { return Chain(set, bonds).make().time_step(); }

// 1 if the run stops in its first step and names the element with the injected number; otherwise 0.
double found_at_once(const ParameterSet& set, const std::function<void(State&)>& inject) {
  Chain c(set, bonds);
  inject(c.state);
  const End e = run_of(c, 3);
  return e.stopped && e.step <= 1 && e.element == static_cast<int>(hit) ? 1 : 0;
}

// The same for a load that is not finite, in dynamics and in a relaxation.
double load_found_at_once(const ParameterSet& set, double force, bool relax) {
  Chain c(set, bonds);
  c.loads.add(ForceLoad({static_cast<int>(hit)}, Vector3(0, force, 0)));
  End e;
  if (relax) {
    try {
      c.make().relax(1e-4, 100, [](long) { return true; });
    } catch (const NumericalError& error) {
      e = {true, error.step(), error.element()};
    }
  } else {
    e = run_of(c, 3);
  }
  return e.stopped && e.step <= 1 && e.element == static_cast<int>(hit) ? 1 : 0;
}

// Sudden couple (eV) at which a run of two elements, one of them held, is stopped.
double sudden_couple(const ParameterSet& set, double about) {
  const auto fails = [&](double couple) {
    Chain c(set, 1);
    c.loads.add(FixLoad({0}));
    c.loads.add(TorqueLoad({1}, Vector3(0, 0, couple)));
    return run_of(c, 400).stopped;
  };
  return limit_between(fails, 0.3 * about, 3 * about);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  CaseResult result;
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<const char*, std::function<void(State&)>>> injections = {
      {"velocity NaN", [&](State& s) { s.velocity.y[hit] = nan; }},
      {"velocity infinite", [&](State& s) { s.velocity.y[hit] = inf; }},
      {"spin NaN", [&](State& s) { s.angular_velocity.z[hit] = nan; }},
      {"place NaN", [&](State& s) { s.position.x[hit] = nan; }},
      {"place infinite", [&](State& s) { s.position.z[hit] = -inf; }},
      {"orientation NaN", [&](State& s) { s.orientation.w[hit] = nan; }}};
  for (const auto& [name, inject] : injections)
    result.check_absolute(fmt::format("{}: stopped in the first step, with its element (1: yes)", name),
                          found_at_once(model, inject), 1, 0, "", "element 6 of 11");

  for (const bool relax : {false, true})
    result.check_absolute(
        fmt::format("force NaN{}: stopped in the first step, with its element (1: yes)", relax ? ", relaxing" : ""),
        load_found_at_once(model, nan, relax), 1, 0, "", "element 6 of 11");

  const double oracle_dt = step_of(oracle);
  const auto kicked = [&](double speed) {
    Chain c(model, bonds);
    c.state.velocity.y[hit] = speed;
    return run_of(c, 100).stopped;
  };
  const auto spun = [&](double spin) {
    Chain c(model, bonds);
    c.state.angular_velocity.x[hit] = spin;
    return run_of(c, 100).stopped;
  };
  const double speed =
                   limit_between(kicked, 0.3 * oracle.radius / 4 / oracle_dt, 3 * oracle.radius / 4 / oracle_dt),
               speed_theory = oracle.radius / 4 / oracle_dt;
  const double spin = limit_between(spun, 0.15 / oracle_dt, 1.5 / oracle_dt), spin_theory = 0.5 / oracle_dt;
  const double torque_theory = 2 * oracle.bond.twist / (units::pi * oracle.element_length);
  const double torque = sudden_couple(model, torque_theory);
  result.check_relative("kick that ends a run", speed, speed_theory, 0.05, "km/s", "one element of a tube at rest");
  result.check_relative("spin that ends a run", spin, spin_theory, 0.05, "rad/ps", "one element of a tube at rest");
  result.check_relative("sudden couple at which a bond slips", torque / units::nN_nm, torque_theory / units::nN_nm,
                        0.05, "nN nm", "two elements, undamped, so that the twist overshoots");
  result.limits.push_back(
      {"kick of an element", speed, speed_theory, "km/s", Limit::Guard::stopped,
       "a move of more than a quarter of the radius in a step, or one that is not finite; names the element"});
  result.limits.push_back(
      {"spin of an element", spin, spin_theory, "rad/ps", Limit::Guard::stopped,
       "a turn of more than half a radian in a step, or one that is not finite; names the element"});
  result.limits.push_back({"couple put on at once", torque / units::nN_nm, torque_theory / units::nN_nm, "nN nm",
                           Limit::Guard::stopped, "a bond twisted by 90 degrees; names its element"});

  std::vector<double> couple, largest;
  for (double part = 0.2; part < 0.99; part += 0.1) {
    Chain c(model, 1);
    c.loads.add(FixLoad({0}));
    c.loads.add(TorqueLoad({1}, Vector3(0, 0, part * torque_theory)));
    Simulation s = c.make(0.2);
    double twist = 0;
    for (int k = 0; k < 400; ++k) {
      s.step();
      twist =
          std::max(twist, bond_twist_angle(frame_of(s.state().orientation[0]), frame_of(s.state().orientation[1])));
    }
    couple.push_back(part * torque_theory / units::nN_nm);
    largest.push_back(twist / units::degree);
  }
  // M phi = GJ/a (1 - cos phi), drawn as phi over M.
  const double stiffness = oracle.bond.twist / oracle.element_length / units::nN_nm;
  ChartLine theory;
  theory.name = "M phi = GJ/a (1 - cos phi)";
  for (double degrees = 1; degrees <= 90; ++degrees) {
    const double phi = degrees * units::degree;
    theory.x.push_back(stiffness * (1 - std::cos(phi)) / phi);
    theory.y.push_back(degrees);
  }
  result.figure("Twist under a sudden couple", {"couple", "nN nm"}, {"largest twist", "degrees"},
                "A sudden couple twists a bond about twice as far as it does at rest. A bond slips under `2/pi` of "
                "the largest moment that it bears at rest.",
                {theory, model_points("largest twist of the bond", couple, largest)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-nan";
  c.order = 100;
  c.run = run;
  c.turns_red = {wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::nan
