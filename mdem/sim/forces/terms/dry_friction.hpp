// Friction of parallel tubes in contact, per length: an elastic slip up to a strength, then sliding at it, or a
// corrugation with this strength; and a drag.
//
// An element a of one tube has a contact with the element b of another tube that lies opposite. Positions and
// orientations of both give two slips, lengths by which the surfaces have moved past each other:
//
//   along the axis   s = (u_b +- u_a)/2 . (x_a - x_b)
//   against spin     g = r_a alpha_a +- r_b alpha_b
//
// alpha is the angle by which a tube has turned about its own axis u against the line to the other one; the signs
// are minus for tubes in opposite directions. The contact remembers the elastic parts (z, y) of the slips (s, g):
//
//   U = K_s z^2/2 + K_g y^2/2   for z^2 + y^2 <= delta^2
//
// Forces and torques are minus the derivatives of U. A step that leads beyond delta cuts (z, y) back to delta in
// the same direction: the work of sliding under the strength is lost.
//
// Or nothing is lost, and the strength is the largest force of a corrugation of the period 2 pi delta:
//
//   U = K_s delta^2 (1 - cos(z/delta)) + K_g delta^2 (1 - cos(y/delta))
//
// with z = s and y = g from where the contact began. The laws agree for small slips. Smooth tubes that are led past
// each other have the corrugation: their force comes back in each period, and its mean is the drag.
//
//   K_s = (F_s l + n F_end)/delta,   K_g = F_g l/delta
//
// l is the length of a, n counts those of a and b that end a tube. The drag adds -eta l ds/dt and -eta l dg/dt. U
// depends on distances and angles within the pair alone, so that momentum and angular momentum are kept, and a rope
// that moves as a whole feels nothing. A contact begins where the axes come nearer than r_a + r_b + 0.42 nm. It
// ends beyond 0.47 nm, at angles above 66 degrees, and where a passes the end of the tube. It is a law for tubes
// side by side: crossed ones have a contact or none, by chance.
//
// Source: springs that remember contacts, P. A. Cundall, O. D. L. Strack, Geotechnique 29, 47 (1979),
// DOI 10.1680/geot.1979.29.1.47. Slips that are measured on the bodies, in place of sums of velocities, are ours.
// Units nm, ps, eV.
#pragma once

#include <memory>

#include "sim/forces/force_term.hpp"
#include "sim/forces/terms/type_pairs.hpp"

namespace ropewalk {

struct DryFriction {
  double axial = 0;         // F_s, eV/nm^2: force per length of contact
  double spin = 0;          // F_g, eV/nm^2: force on the surface per length; the torque per length is r F_g
  double end = 0;           // F_end, eV/nm: force along the axis that each end of a tube adds to its contact
  double elastic_slip = 0;  // delta, nm
  double drag = 0;          // eta, eV ps/nm^3
  bool corrugated = false;  // the second potential
  TypePairs types;          // types of tubes between which it acts
};

// `scene`: all elements.
std::shared_ptr<const ForceTerm> dry_friction_term(const DryFriction& law, const Topology& scene);

}  // namespace ropewalk
