// The twisted rope of elements: grips, increments and measured values.
#include <algorithm>
#include <cmath>

#include "cases/common/gripped_rope.hpp"
#include "cases/common/twisted_rope.hpp"
#include "model/contact/line_parameters.hpp"
#include "scene/lattice.hpp"
#include "scene/loads/fix.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk::validate {
namespace {

constexpr double force_tolerance = 5e-3;  // eV/nm
constexpr double pull_tolerance = 0.2;    // eV/nm of the whole grip: worth less than 1e-5 eV

// Chains from one clamp to the other and, beyond the clamps, elements in place of the bands of atoms.
GrippedRope clamped_rope(const TwistedRope& rope, const ParameterSet& set) {
  const double length = clamped_length(rope, set), a = length / rope.bonds;
  ParameterSet divided = set;
  divided.element_length = a;
  // A grip ends half an element beyond its last centre. Beyond the clamped length a band is longer by half of
  // its excess over the free rows.
  const double band = rope.band_rows * row_distance(set) - 0.5 * (length - rope.free_rows * row_distance(set));
  const int beyond = std::max(1, static_cast<int>(std::lround(band / a - 0.5)));
  GrippedRope out(divided, rope.bonds, line_law({line_contact_of(divided)}),
                  set.law<LineParameters>()->pair_spacing, beyond + 1);
  out.topology.types.front().bond = set.anharmonic_bond(length);
  return out;
}

// Along the axis, on the upper grip.
double grip_force(const GrippedRope& rope) {
  double sum = 0;
  for (const int e : rope.upper) sum += rope.forces.force.z[static_cast<std::size_t>(e)];
  return sum;
}

// Moves the upper grip along the axis until no force acts on it; returns by how much. Newton steps with the
// stiffness of straight tubes; that of a twisted rope is close to it and not larger.
double release(GrippedRope& rope, double axial_stiffness) {
  double rise = 0;
  for (int k = 0; k < 8 && std::fabs(grip_force(rope)) > pull_tolerance; ++k) {
    const double lift = grip_force(rope) / axial_stiffness;
    for (int e = 0; e < rope.topology.elements(); ++e)
      rope.state.position.z[static_cast<std::size_t>(e)] += lift * rope.fraction_at(e);
    rise += lift;
    rope.relax(force_tolerance);
  }
  return rise;
}

}  // namespace

std::vector<TwistedState> twist_elements(const TwistedRope& twisted, const ParameterSet& set,
                                         const std::vector<double>& angles, bool axial_free) {
  GrippedRope rope = clamped_rope(twisted, set);
  const double stiffness = GrippedRope::tubes * set.bond.stretch / clamped_length(twisted, set);
  double rise = 0;
  std::vector<TwistedState> states;
  for (const double angle : angles) {
    if (!states.empty()) rope.turn(angle - states.back().angle);
    rope.relax(force_tolerance);
    if (axial_free) rise += release(rope, stiffness);
    const Energies& energy = rope.forces.energy;
    states.push_back({angle, energy.potential(), energy.bonds(), energy.vdw, rope.moment(), -grip_force(rope), rise,
                      energy.bend + energy.shear});
  }
  return states;
}

}  // namespace ropewalk::validate
