// The rope that the cases of other codes share: seven parallel tubes between two grips. Each case puts the physics
// of another code into this one scene, so that what differs in the end is that physics alone.
//
// A grip is the two outermost elements of every tube, position and orientation. What deforms is the length between
// the inner ones, a whole number of bonds. The grips keep their distance along the axis.
#pragma once

#include <vector>

#include "cases/common/chains_contact.hpp"
#include "scene/scene.hpp"

namespace ropewalk {

struct GrippedRope {
  static constexpr int tubes = 7, held = 2;  // elements of a grip in each tube

  Topology topology;
  Interaction interaction;
  LoadsAndConstraints loads;  // nothing yet
  State state;
  std::vector<int> lower, upper;  // elements of the grips
  int bonds = 0;                  // between the grips, of each tube
  double spacing = 0;             // nm, of two long parallel rows at rest

  GrippedRope(const ParameterSet& set, int bonds, ContactOptions::Law law);
  double length() const { return bonds * topology.types[0].element_length; }
  int elements_of_tube() const { return bonds + 2 * held - 1; }
  // 0 in the lower grip, 1 in the upper one, even between them.
  double place(int element) const;
  double turn_of(int element, double angle) const { return (place(element) - 0.5) * angle; }
  void hold_grips();
  // The upper grip by +angle/2, the lower one by -angle/2, all between them evenly.
  void turn(double angle);
};

// Moment (eV) about the axis of the rope with which these forces resist a turn of the grip.
double resisting_moment(const std::vector<int>& grip, const Vec3Array& position, const Vec3Array& force,
                        const Vec3Array& torque);

// Torsion of seven tubes that the grips carry around each other by `angle`: a helix of angle beta closes its turn
// with the twist angle cos(beta) of its own, the rest is writhe.
//   E = GJ angle^2 (1 + 6 cos^2 beta)/2L,   tan(beta) = spacing angle/L
double torsion_energy(const BondStiffness& bond, double spacing, double length, double angle);

// Integral of values at even distances by Simpson's rule; an odd number of values.
double simpson_sum(const std::vector<double>& values, double distance);

}  // namespace ropewalk
