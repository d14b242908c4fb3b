// How links share the load where two tubes overlap.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/checks.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "sim/forces/terms/links.hpp"

namespace ropewalk::validate::link_shear_lag {
namespace {

constexpr int overlap = 30, beyond = 10;  // elements
constexpr int length = overlap + beyond;

// Two tubes side by side, the second drawn out by `beyond` elements, that can only move along their axis. A link
// joins each two elements that face each other. The first tube is held at its lower end, the second one pulled at
// its upper.
struct Joint {
  Scene scene;
  Prepared p;
  Joint(const ParameterSet& set, const LinkLaw& law, double force)
      : scene(scene_of_text(
            fmt::format(
                "format = \"ropewalk-scene-1\"\nparameters = \"{}\"\n[rope]\ntubes = 2\npacking = \"round\"\n"
                "length_nm = {}\n[bond]\nlaw = \"harmonic\"\n[[load]]\nkind = \"fix\"\nelements = \"all\"\naxes = "
                "\"xy\"\n[[load]]\nkind = \"fix\"\ntubes = [0]\nelements = [0]\n{}[run]\nmode = \"relax\"\n",
                set.path, length * set.element_length,
                force > 0 ? fmt::format("[[load]]\nkind = \"force\"\ntubes = [1]\nelements = [-1]\nforce_nN = "
                                        "[0, 0, {}]\n",
                                        force * units::eV_in_nN_nm)
                          : ""),
            "")) {
    scene.sets = {set};
    p = prepare(scene);
    for (int e = length; e < 2 * length; ++e)
      p.state.position.z[static_cast<std::size_t>(e)] += beyond * set.element_length;
    std::vector<std::pair<int, int>> pairs;
    for (int k = 0; k < overlap; ++k) pairs.emplace_back(beyond + k, length + k);
    add_term(link_term(law, placed_links(law, p.topology, p.state, pairs), p.topology), p.interaction);
  }

  Simulation relaxed() const {
    Simulation s = start(scene, p);
    if (!s.relax(1e-6, 400000, [](long) { return true; }))
      throw std::runtime_error("the joint does not come to rest");
    return s;
  }
  // Links that break on the way to rest, or until the tubes have parted.
  long broken() const {
    Simulation s = start(scene, p);
    s.relax(1e-6, 20000, [](long) { return true; });
    return std::lround(s.term_accounts().front().events);
  }
};

// Displacements of the second tube against the first, nm, at each link.
std::vector<double> shears(const State& s) {
  std::vector<double> out;
  for (int k = 0; k < overlap; ++k)
    out.push_back(s.position.z[static_cast<std::size_t>(length + k)] -
                  s.position.z[static_cast<std::size_t>(beyond + k)]);
  return out;
}

// Forces of the links, eV/nm, less those that the ends of the tubes make without a load.
std::vector<double> link_forces(const ParameterSet& set, double k, double force) {
  LinkLaw law;
  law.stretch = law.shear = k;
  const std::vector<double> idle = shears(Joint(set, law, 0).relaxed().state()),
                            loaded = shears(Joint(set, law, force).relaxed().state());
  std::vector<double> out;
  for (std::size_t i = 0; i < idle.size(); ++i) out.push_back(k * (loaded[i] - idle[i]));
  return out;
}

CaseResult run(const CaseContext& context) {
  CaseResult result;
  const ParameterSet model = context.model(), oracle = context.set();
  const double a = oracle.element_length, l = overlap * a, force = 0.01 * oracle.bond.stretch;
  std::vector<ChartLine> curves;
  for (const double half : {0.5, 1.0, 2.3}) {  // l/2 lambda
    const double lambda = l / (2 * half), k = oracle.bond.stretch * a / (2 * lambda * lambda);
    const std::vector<double> p = link_forces(model, k, force);
    double sum = 0;
    for (const double x : p) sum += x;
    const std::string of = fmt::format("l = {:.3g} lambda", 2 * half);
    // Theory for the whole length that the last link stands for.
    const double ratio = 0.5 * overlap * (1 - std::sinh(half * (1 - 2.0 / overlap)) / std::sinh(half));
    result.check_relative("largest over mean link force, " + of,
                          *std::max_element(p.begin(), p.end()) * overlap / sum, ratio, 5e-3, "",
                          "links at the ends stand half an element inside of the overlap");
    result.check_relative("sum of the link forces, " + of, sum * units::eV_in_nN_nm, force * units::eV_in_nN_nm,
                          1e-3, "nN", "balance");
    std::vector<double> places, forces;
    for (int i = 0; i < overlap; ++i) {
      places.push_back((i + 0.5) * a);
      forces.push_back(p[static_cast<std::size_t>(i)] * overlap / force);
    }
    curves.push_back(theory_curve("theory, " + of, 0, l, [=](double x) {
      return half * std::cosh((x - 0.5 * l) / lambda) / std::sinh(half);
    }));
    curves.push_back(model_points("links, " + of, places, forces));
    if (half < 2) continue;
    // The load under which the first link breaks.
    LinkLaw weak;
    weak.stretch = weak.shear = k;
    weak.strength = force * ratio / overlap;
    const auto broken = [&](double part) { return static_cast<double>(Joint(model, weak, part * force).broken()); };
    result.check_absolute("broken links at 0.96 of the theory's load", broken(0.96), 0, 0.5, "",
                          "below the first break");
    const double all = broken(1.04);
    result.check_absolute("broken links at 1.04 of it, of all", all / overlap, 1, 1e-6, "",
                          "the first break overloads its neighbours, and the joint opens from its ends");
  }
  result.figure("Forces of links along an overlap", {"place", "nm"}, {"force over the mean", ""},
                "Both ends bear most. Fewer or softer links share the load evenly.", std::move(curves));
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "link-shear-lag";
  c.order = 175;
  c.law = Case::Law::line;
  c.run = run;
  c.turns_red = {{wrong_EA(1.1), {"l = 4.6 lambda"}}};
  c.stays_green = {wrong_EI(1.1), wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::link_shear_lag
