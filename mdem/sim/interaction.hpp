// What acts between the elements of a scene, resolved from scene and parameter set.
#pragma once

#include <optional>
#include <vector>

#include "model/contact_line.hpp"
#include "model/contact_paper.hpp"
#include "model/damping.hpp"
#include "sim/state.hpp"

namespace ropewalk {

struct Interaction {
  std::optional<PaperContact> paper;  // at most one of `paper` and `line`; neither: no contact
  std::vector<LineContact> line;      // of tube types i, j at i * types + j
  bool legacy_torque = false;
  int exclude_along_tube = 20;  // pairs of one tube up to this many elements apart do not interact
  Damping damping;

  bool has_contact() const { return paper.has_value() || !line.empty(); }
  // Of element centres.
  double cutoff() const {
    double reach = paper ? paper->cutoff() : 0.0;
    for (const LineContact& pair : line) reach = std::max(reach, pair.cutoff());
    return reach;
  }
  bool damped_contact() const { return damping.contact.eta > 0; }
};

// The law between elements of two tubes, whichever it is.
template <class F>
auto with_law(const Topology& topology, const Interaction& in, int tube_i, int tube_j, F f) {
  if (in.paper) return f(*in.paper);
  return f(in.line[static_cast<std::size_t>(topology.tube_type[tube_i]) * topology.types.size() +
                   static_cast<std::size_t>(topology.tube_type[tube_j])]);
}

struct Energies {
  double stretch = 0, shear = 0, bend = 0, twist = 0, vdw = 0;  // eV
  double bonds() const { return stretch + shear + bend + twist; }
  double potential() const { return bonds() + vdw; }
};

}  // namespace ropewalk
