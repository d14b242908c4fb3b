// The ends of tubes that follow one another in a strand (TubeGroups::strand_begin): their van der Waals contact,
// end against end.
//
//   U = V(s) W(q),   d = (x_j - a_j t_j/2) - (x_i + a_i t_i/2),   n = (t_i + t_j)/|t_i + t_j|,
//   s = d . n,   q = |d - s n|^2/(r_i + r_j)^2
//
// i is the last element of one tube and j the first one of the next; V, W: model/contact/tube_ends.hpp. Forces and
// torques are minus the derivatives of U, by the axes too. The contact law of endless tubes leaves out elements of
// two tubes of a strand that are within the exclusion along a tube (TubeGroups::ends_meet). Units nm, eV.
#pragma once

#include <memory>
#include <vector>

#include "model/contact/tube_ends.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

// `contacts`: of the type of the lower tube and that of the upper one, i, j at i * types + j. `scene`: all
// elements.
std::shared_ptr<const ForceTerm> tube_ends_term(std::vector<EndContact> contacts, const Topology& scene);

}  // namespace ropewalk
