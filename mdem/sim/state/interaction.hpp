// What acts between the elements of a scene, resolved from scene and parameter set.
#pragma once

#include <optional>
#include <vector>

#include "model/contact/line.hpp"
#include "model/contact/paper.hpp"
#include "model/damping.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct Interaction {
  std::optional<PaperContact> paper;  // at most one of `paper` and `line`; neither: no contact
  std::vector<LineContact> line;      // of tube types i, j at i * types + j
  bool legacy_torque = false;
  // Displacements between nodes (line law) and all that belongs to a pair (paper law) in single precision, or all
  // in double.
  enum class Precision { mixed, full };
  Precision precision = Precision::full;
  int exclude_along_tube = 20;  // pairs of one tube up to this many elements apart do not interact
  Damping damping;

  bool has_contact() const { return paper.has_value() || !line.empty(); }
  // Of element centres.
  double cutoff() const {
    double reach = paper ? paper->cutoff() : 0.0;
    for (const LineContact& pair : line) reach = std::max(reach, pair.cutoff());
    return reach;
  }
  // How far from its centre an element has points that interact.
  double lever() const {
    double longest = 0;
    for (const LineContact& pair : line) longest = std::max(longest, 0.5 * pair.length_i);
    return longest;
  }
  bool damped_contact() const { return damping.contact.eta > 0; }
  // Of two tubes in `line`.
  std::size_t line_index(const Topology& topology, int tube_i, int tube_j) const {
    return static_cast<std::size_t>(topology.tube_type[tube_i]) * topology.types.size() +
           static_cast<std::size_t>(topology.tube_type[tube_j]);
  }
};

// The law between two elements, i < j, whichever it is.
template <class F>
auto with_law(const Topology& topology, const Interaction& in, int i, int j, F f) {
  if (in.paper) return f(*in.paper);
  const int tube_i = topology.tube_of(i), tube_j = topology.tube_of(j);
  return f(in.line[in.line_index(topology, tube_i, tube_j)]);
}

struct Energies {
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0;  // eV
  double bonds() const { return stretch + shear + bend + twist; }
  double potential() const { return bonds() + vdw; }
};

}  // namespace ropewalk
