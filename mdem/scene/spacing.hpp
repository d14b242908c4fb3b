// Distances at which the tubes of a scene bind best.
#pragma once

namespace ropewalk {

class ContactLaw;
struct Scene;

inline constexpr double graphite_gap = 0.335;  // nm, between the walls of tubes for which there is no law

double largest_radius(const Scene& scene);  // nm, of the tube types

// The distances of two parallel and of two crossed tubes (nm) at which their energy is lowest; without a law, that
// of their walls in graphite. Of several tube types, the largest.
double parallel_spacing(const Scene& scene, const ContactLaw* law);
double crossed_spacing(const Scene& scene);
// The gap (nm) between the walls of two tubes in line at which their ends do not push each other. By the line law,
// which knows axes and no ends, it is four times that of atoms, and the energy of the joint is near zero as theirs is.
double coaxial_gap(const Scene& scene);

}  // namespace ropewalk
