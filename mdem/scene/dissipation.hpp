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

#include <vector>

#include "model/damping.hpp"
#include "model/parameters.hpp"

namespace ropewalk {

// The viscosity (eV ps/nm^2) of a pair of elements that gives two tubes `per_length` (eV ps/nm^3): the force per
// length of contact and speed of sliding. It goes as a^2 over the distance of the axes, 2 r and the gap of
// graphite.
double contact_viscosity(double per_length, double element_length, double radius);
// The mean over the sets of a scene, in whatever order it lists them.
double contact_viscosity(double per_length, double element_length, const std::vector<ParameterSet>& sets);
// Viscosity of a scene that gives none, eV ps/nm^3: by definition that of the published set with 20 eV ps/nm^2 for a pair of
// elements.
inline constexpr double default_viscosity = 27;

// Lengths in nm. The reach of the viscosity must be set where there is one.
Damping same_dissipation(Damping damping, double from, double to);

}  // namespace ropewalk
