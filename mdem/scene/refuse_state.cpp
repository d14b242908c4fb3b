#include "scene/refuse_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/segments.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

void refuse_overlaps(const Topology& topology, const Interaction& interaction, const State& state,
                     const InputError::Place& place, bool may_part) {
  if (!interaction.has_contact()) return;
  std::string overlap, remedy;  // the first
  NeighbourList list(interaction, default_skin(interaction));
  list.build(topology, state);
  for (int i = 0; i < topology.elements(); ++i)
    list.for_neighbours(i, [&](int j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const TubeType &ti = topology.type_of_element(i), &tj = topology.type_of_element(j);
      const Vector3 d = state.position[b] - state.position[a], n_i = axis_of(state.orientation[a]),
                    n_j = axis_of(state.orientation[b]);
      const double half_i = 0.5 * ti.element_length, half_j = 0.5 * tj.element_length;
      const double apart = std::sqrt(squared_segment_distance(d, n_i, n_j, half_i, half_j));
      const int tube_i = topology.tube_of(i), tube_j = topology.tube_of(j);
      const bool beside = std::fabs(d.dot(n_i)) < 0.6 * (half_i + half_j) && std::fabs(n_i.dot(n_j)) > 0.9;
      if (tube_i != tube_j && beside && apart < 0.5 * std::max(ti.radius, tj.radius))
        throw InputError(
            place,
            fmt::format("tubes {} and {} lie inside of one another: at elements {} and {} their axes are {:.3g} nm "
                        "apart",
                        tube_i, tube_j, a, b, apart),
            "walls of multi-walled tubes are not supported, since contact is that between the outsides of tubes; "
            "keep one of the walls");
      if (!overlap.empty() || apart >= ti.radius + tj.radius) return;
      overlap = fmt::format(
          "elements {} and {} overlap: their axes are {:.3g} nm apart, and their radii are {:.3g} nm together", a,
          b, apart, ti.radius + tj.radius);
      remedy = "move them apart, or relax the state first with mode = \"relax\"";
      // The last element of a tube and the first one of the next, one behind the other.
      if (tube_j == tube_i + 1 && j == i + 1 && d.dot(n_i) > half_i + half_j)
        remedy += fmt::format(
            "; if the ends of tubes {} and {} are to meet, say that they are one strand, below the header: \"# "
            "strands_begin_with_tubes: 0\" with the first tube of each strand",
            tube_i, tube_j);
    });
  if (!overlap.empty() && !may_part) throw InputError(place, overlap, remedy);
}

void refuse_forces(const Forces& forces, const InputError::Place& place) {
  if (forces.slipping_bond >= 0)
    throw InputError(place,
                     fmt::format("the bond after element {} is twisted by 90 degrees or more, where it slips",
                                 forces.slipping_bond),
                     "turn its elements nearer to each other about the tube");
  const char* remedy = "two elements lie in one place, or much too close: move them apart";
  for (std::size_t i = 0; i < forces.force.size(); ++i)
    if (!Vector3(forces.force[i]).allFinite() || !Vector3(forces.torque[i]).allFinite())
      throw InputError(place, fmt::format("the force on element {} is no finite number", i), remedy);
  if (!std::isfinite(forces.energy.potential())) throw InputError(place, "the energy is no finite number", remedy);
}

}  // namespace ropewalk
