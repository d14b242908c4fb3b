// The force that draws one tube out of a rope.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "cases/common/scene_of_case.hpp"
#include "cases/common/torsion_machine.hpp"
#include "core/checks.hpp"
#include "model/contact/line_parameters.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::pull_out {
namespace {

constexpr int elements = 24;

struct Drawn {
  double energy = 0, force = 0;  // eV, eV/nm
};

// One tube of seven drawn out by `by` elements, at rest: its upper end and the lower ends of the others in
// clamps.
Drawn drawn(const ParameterSet& set, int tube, int by) {
  std::string others;
  for (int t = 0; t < 7; ++t)
    if (t != tube) others += (others.empty() ? "" : ", ") + std::to_string(t);
  Scene scene = scene_of_case("pull-out", set,
                              {{"rope.length_nm", fmt::to_string(elements * set.element_length)},
                               {"grip.0.tubes", "[" + others + "]"},
                               {"grip.1.tubes", fmt::format("[{}]", tube)}});
  Prepared p = prepare(scene);
  for (int e = p.topology.tube_begin[tube]; e < p.topology.tube_begin[tube + 1]; ++e)
    p.state.position.z[static_cast<std::size_t>(e)] += by * set.element_length;
  Simulation s = start(scene, p);
  if (!s.relax(1e-6, 400000, [](long) { return true; })) throw std::runtime_error("the rope does not come to rest");
  return {s.forces().energy.potential(), s.read_gauges()[upper_end].force.z()};
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  for (std::size_t k = 0; k < context.sets.size(); ++k) {
    const CaseTube tube = context.tube(k);
    const bool paper = !tube.set.law<LineParameters>();
    const RopeInMachine rope(tube.set, 2, elements);  // for the oracle
    const double per_contact = 2 * rope.cohesion[0];  // each of the two tubes has half of it
    for (const auto& [name, which, contacts] : {std::tuple{"centre tube", 0, 6}, std::tuple{"outer tube", 1, 3}}) {
      const Drawn a = drawn(tube.model, which, 3), b = drawn(tube.model, which, 9);
      const double force = (b.energy - a.energy) / (6 * tube.set.element_length);
      const std::string of = std::string(name) + (paper ? " (published set)" : ", " + tube.name);
      result.check_relative("force on the " + of, force * units::eV_in_nN_nm,
                            contacts * per_contact * units::eV_in_nN_nm, 2e-2, "nN",
                            "from the energy over six elements of the way");
      result.check_relative("reading of the clamp, " + of, b.force * units::eV_in_nN_nm,
                            contacts * per_contact * units::eV_in_nN_nm, 4e-2, "nN",
                            paper ? "at one place: the energy of the published law varies along the elements"
                                  : "at one place: a little variation along the elements is left");
      result.checks.back().informative = paper;
    }
    if (k > 0) continue;
    std::vector<double> ways, energies;
    for (const int by : {1, 3, 5, 7, 9}) {
      ways.push_back(by * tube.set.element_length);
      energies.push_back(drawn(tube.model, 0, by).energy);
    }
    const double first = energies.front();
    for (double& e : energies) e -= first;
    const double from = ways.front();
    result.figure("Energy of the rope against the way of its centre tube", {"way", "nm"}, {"energy", "eV"},
                  "Above that after one element of the way.",
                  {theory_curve("six contacts", from, ways.back(),
                                [&](double way) { return 6 * per_contact * (way - from); }),
                   model_points(tube.name, ways, energies)});
  }
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "pull-out";
  c.order = 170;
  c.tier = Case::Tier::full;
  c.law = Case::Law::none;
  c.sets = {"cnt-10-10-tersoff", "cnt-10-10-paper"};
  c.run = run;
  c.turns_red = {wrong_contact(1.1)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::pull_out
