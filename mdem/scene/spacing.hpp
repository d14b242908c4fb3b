// Distances at which the tubes of a scene bind best.
#pragma once

namespace ropewalk {

class ContactLaw;
struct TypePair;
struct Scene;

inline constexpr double graphite_gap = 0.335;  // nm, between the walls of tubes for which there is no law

double largest_radius(const Scene& scene);      // largest radius of the tube types, nm
double own_element_length(const Scene& scene);  // nm, that of the sets, the mean of several

// The distances of two parallel and of two crossed tubes (nm) at which their energy is lowest; without a law, that
// of their walls in graphite. Of several tube types, the largest.
double parallel_spacing(const Scene& scene, const ContactLaw* law);
// The distance of two parallel tubes of these types at which they bind best.
double pair_spacing(const Scene& scene, const ContactLaw* law, TypePair types);
double crossed_spacing(const Scene& scene);
// The gap (nm) between the ends of two tubes in line at which these do not push each other; the largest of all
// pairs of types. Of a law without a contact of ends, which knows axes alone, it is four times that of atoms.
double coaxial_gap(const Scene& scene);

}  // namespace ropewalk
