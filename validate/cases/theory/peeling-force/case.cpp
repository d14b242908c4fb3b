// Two adhering tubes that are pulled apart at one end.
#include <cmath>

#include "cases/common/bundle.hpp"

namespace ropewalk::validate::peeling_force {
namespace {

constexpr int elements = 50;

struct Peel {
  double opening = 0;  // of each end from rest, nm
  double force = 0;    // on each end, eV/nm
  double release = 0;  // force times sine of the slope, both tubes, eV/nm
};

// Start: the shape of a cantilever clamped at the crack tip.
void open_arm(double opening, double crack, double side, const ParameterSet& set, std::size_t first, State& state) {
  for (int e = 0; e < elements; ++e) {
    const double s = e * set.element_length / crack;
    if (s >= 1) return;
    const auto i = first + static_cast<std::size_t>(e);
    state.position.x[i] += side * opening * (1 - 1.5 * s + 0.5 * s * s * s);
    const double slope = side * opening / crack * (1.5 * s * s - 1.5);
    state.orientation.set(i, turn_about(Vector3::UnitY(), std::atan(slope)));
  }
}

Peel peel(const ParameterSet& set, double opening, double crack) {
  Bundle b = line_bundle(set, 1, elements);
  b.topology.add_tube(elements);
  b.state = State(static_cast<std::size_t>(2 * elements));
  LoadsAndConstraints loads;
  for (int t = 0; t < 2; ++t) {
    const double side = t == 0 ? -1 : 1;
    const auto first = static_cast<std::size_t>(t * elements);
    for (int e = 0; e < elements; ++e)
      b.state.position.set(first + static_cast<std::size_t>(e),
                           {0.5 * side * b.spacing, 0, e * set.element_length});
    open_arm(opening, crack, side, set, first, b.state);
    loads.add(FixLoad({t * elements}, true, true, false, false));
    loads.add(FixLoad({(t + 1) * elements - 1}, false, true, true, false));
  }
  const double step = default_step_fraction * time_step_limit(b.topology, b.interaction, b.spacing).limit;
  const Simulation s = at_rest(Simulation(b.topology, b.interaction, loads, b.state, step), 1e-5, 400000);
  Peel out;
  out.opening = opening;
  for (const std::size_t end : {std::size_t{0}, static_cast<std::size_t>(elements)}) {
    const double force = std::fabs(s.forces().force.x[end]);
    out.force += 0.5 * force;
    out.release += force * std::fabs(axis_of(s.state().orientation[end]).x());
  }
  return out;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double adhesion = -pair_well(oracle).energy;
  // Cantilevers in balance with the adhesion, G = 9 EI w^2/c^4.
  const auto crack = [&](double w) { return std::pow(9 * oracle.bond.bend * w * w / adhesion, 0.25); };
  const auto force = [&](double w) { return 3 * oracle.bond.bend * w / std::pow(crack(w), 3); };
  CaseResult result;
  std::vector<double> openings, releases, forces;
  for (const double w : {1.0, 2.0, 3.0, 4.0}) {
    const Peel p = peel(model, w, crack(w));
    openings.push_back(w);
    releases.push_back(p.release);
    forces.push_back(p.force);
    const std::string at = " opened by " + std::to_string(static_cast<int>(w)) + " nm each";
    result.check_relative("2 F sin(slope)," + at, p.release, adhesion, 1e-2, "eV/nm",
                          "exact for any shape; contact fitted to 1.4e-3");
    if (w == 4.0)
      result.show_relative("force," + at, p.force, force(w), 0.1, "eV/nm",
                           "a beam clamped at the crack tip; the contact yields a little");
  }
  result.figure("Energy released by peeling, per length", {"opening of each end", "nm"},
                {"energy per length", "eV/nm"},
                "The work of the end forces per length of contact lost, from force and slope at the ends.",
                {theory_curve("adhesion of parallel tubes", 0.5, 4.5, [&](double) { return adhesion; }),
                 model_points("2 F sin(slope) of the chains", openings, releases)});
  result.figure(
      "Peeling force against opening", {"opening of each end", "nm"}, {"force", "eV/nm"},
      "The softness of the contact beyond the crack tip lowers the force of short cracks.",
      {theory_curve("beams clamped at the crack tip", 0.5, 4.5, force), model_points("chains", openings, forces)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "peeling-force";
  c.order = 80;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::peeling_force
