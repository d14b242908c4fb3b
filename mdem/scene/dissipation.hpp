// Damping of elements of another length.
//
// The constants belong to a pair of elements and to a bond, the dissipation to a length of tube: elements of
// another length need other constants for the same dissipation in the tubes and between them. For two parallel
// tubes whose elements lie side by side, at the distance `inner` of the contact viscosity,
//
//   eta sum_k w(hypot(inner, k a))/a   and   lambda a^2   stay the same.
//
// Where elements of two tubes lie at any offset the mean of the first is eta/a^2.
#pragma once

#include "model/damping.hpp"

namespace ropewalk {

// The viscosity (eV ps/nm^2) of a pair of elements of a scene that gives none: 20 for the published set. Others get
// the same per length of contact, eta/a^2 times the distance of the axes of two tubes, 2 r and the gap of graphite.
double default_contact_viscosity(double element_length, double radius);

// Lengths in nm. The reach of the viscosity must be set where there is one.
Damping same_dissipation(Damping damping, double from, double to);

}  // namespace ropewalk
