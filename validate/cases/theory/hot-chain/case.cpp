// A free tube in a bath: heat in every mode, and the persistence length.
#include <fmt/format.h>

#include <cmath>

#include "cases/common/chain.hpp"
#include "cases/common/scene_of_case.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::hot_chain {
namespace {

constexpr double kelvin = 300;
constexpr int elements = 60;
constexpr double begin = 300, duration = 6000, every = 2;  // ps; the scene lasts for both

CaseResult run(const CaseContext& context) {
  const CaseTube tube = context.tube();
  Scene scene = scene_of_case("hot-chain", tube.model, {});
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  s.steps(std::lround(begin / p.time_step));
  const long between = std::max(1L, std::lround(every / p.time_step));
  const double a = tube.set.element_length, kt = units::boltzmann * kelvin;
  const int bonds = elements - 1;
  std::vector<double> position, bent(static_cast<std::size_t>(bonds));
  double bend2 = 0, twist2 = 0, stretch2 = 0, kinetic = 0;
  long samples = 0;
  for (double t = 0; t < duration; t += static_cast<double>(between) * p.time_step, ++samples) {
    s.steps(between);
    const State& state = s.state();
    for (int e = 0; e < bonds; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Frame f = frame_of(state.orientation[i]), g = frame_of(state.orientation[i + 1]);
      bend2 += (g.t - f.t).squaredNorm();
      bent[i] += (g.t - f.t).squaredNorm();
      twist2 += std::pow(bond_twist_angle(f, g), 2);
      stretch2 += std::pow((state.position[i + 1] - state.position[i]).norm() / a - 1, 2);
    }
    kinetic += kinetic_energy(p.topology, state);
  }
  const double n = static_cast<double>(samples) * bonds;
  CaseResult result;
  const char* why = "the statistical error is about 1 %, and the time step makes positions up to 2 % too hot";
  // <t_i . t_(i+1)> = 1 - a/l for a bond much shorter than the persistence length l.
  result.check_relative("persistence length", 1e-3 * a / (0.5 * bend2 / n), 1e-3 * tube.set.bond.bend / kt, 5e-2,
                        "µm", why);
  result.check_relative("energy of bending in a bond, of kT", 0.5 * tube.set.bond.bend / a * bend2 / n / kt, 1,
                        4e-2, "", why);
  result.check_relative("energy of torsion in a bond, of kT/2", tube.set.bond.twist / a * twist2 / n / kt, 1, 4e-2,
                        "", why);
  result.check_relative("energy of stretching in a bond, of kT/2", tube.set.bond.stretch * a * stretch2 / n / kt, 1,
                        4e-2, "", why);
  result.check_relative("kinetic energy of an element, of 3 kT",
                        kinetic / static_cast<double>(samples) / elements / (3 * kt), 1, 2e-2, "",
                        "half of it in each of translation and rotation");
  for (double& b : bent) {
    position.push_back(a * (static_cast<double>(position.size()) + 1));
    b *= 0.5 * tube.set.bond.bend / a / static_cast<double>(samples) / kt;
  }
  result.figure("Heat of bending along the tube", {"position", "nm"}, {"energy of a bond, of kT", ""},
                "The mean over the run of each bond.",
                {theory_curve("kT/2 in either plane", a, a * bonds, [](double) { return 1.0; }),
                 model_points("bonds", position, bent)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "hot-chain";
  c.order = 190;
  c.tier = Case::Tier::full;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {{wrong_stiffnesses(1.1), {"persistence length", "torsion", "stretching"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::hot_chain
