#include "cases/common/peeled_pair.hpp"

#include <cmath>

namespace ropewalk::validate {
namespace {

constexpr int peeled_elements = 50;

// Start: the shape of a cantilever clamped at the crack tip.
void open_arm(double opening, double crack, double side, const ParameterSet& set, std::size_t first, State& state) {
  for (int e = 0; e < peeled_elements; ++e) {
    const double s = e * set.element_length / crack;
    if (s >= 1) return;
    const auto i = first + static_cast<std::size_t>(e);
    state.position.x[i] += side * opening * (1 - 1.5 * s + 0.5 * s * s * s);
    const double slope = side * opening / crack * (1.5 * s * s - 1.5);
    state.orientation.set(i, turn_about(Vector3::UnitY(), std::atan(slope)));
  }
}

}  // namespace

Peel peel(const ParameterSet& set, double opening, double crack) {
  Bundle b = line_bundle(set, 1, peeled_elements);
  b.place(set, peeled_elements, {{-0.5 * b.spacing, 0}, {0.5 * b.spacing, 0}});
  LoadsAndConstraints loads;
  for (int t = 0; t < 2; ++t) {
    const double side = t == 0 ? -1 : 1;
    const auto first = static_cast<std::size_t>(t * peeled_elements);
    for (int e = 0; e < peeled_elements; ++e)
      b.state.position.set(first + static_cast<std::size_t>(e),
                           {0.5 * side * b.spacing, 0, e * set.element_length});
    open_arm(opening, crack, side, set, first, b.state);
    loads.add(FixLoad({t * peeled_elements}, true, true, false, false));
    loads.add(FixLoad({(t + 1) * peeled_elements - 1}, false, true, true, false));
  }
  const double step = default_step_fraction * time_step_limit(b.topology, b.interaction, b.spacing).limit;
  const Simulation s = at_rest(Simulation(b.topology, b.interaction, loads, b.state, step), 1e-5, 400000);
  Peel out;
  out.opening = opening;
  for (const std::size_t end : {std::size_t{0}, static_cast<std::size_t>(peeled_elements)}) {
    const double force = std::fabs(s.forces().force.x[end]);
    out.force += 0.5 * force;
    out.release += force * std::fabs(axis_of(s.state().orientation[end]).x());
  }
  return out;
}

}  // namespace ropewalk::validate
