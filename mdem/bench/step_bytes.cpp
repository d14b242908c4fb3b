#include "bench/step_bytes.hpp"

namespace ropewalk {

double step_bytes(const Simulation& simulation) {
  constexpr int state = 3 + 4 + 3 + 3, axis = 3, force = 3 + 3;  // numbers of an element
  const Interaction& in = simulation.interaction();
  const auto elements = static_cast<double>(simulation.state().size());
  // Terms that act in the kick need the total force, which is then stored.
  const bool stored = simulation.engine().terms().act_in_kick();
  double sum = 2.0 * (state + (stored ? force : 0)) * sizeof(double) * elements;
  if (!in.has_contact()) return sum;
  sum += 2 * axis * sizeof(double) * elements;
  const std::size_t number = in.precision == Interaction::Precision::mixed ? sizeof(float) : sizeof(double);
  return sum + simulation.engine().contact()->step_bytes(simulation.list(), number) +
         static_cast<double>(simulation.engine().terms().bytes());
}

}  // namespace ropewalk
