// A rope of parallel tubes that winds about its axis: how far under a couple, and how far that strains its tubes.
//
// With the twist w per length, the distance rho of a tube from the axis, means over the tubes weighted by their
// stretching stiffness EA, and the twist w0 at which no tube is strained, a rope whose tubes do not slide has
//
//   strain of a tube  ((s^2 + rho^2 w^2) / (1 + rho^2 w0^2))^1/2 - 1,  about (rho^2 - <rho^2>) (w^2 - w0^2)/2
//   couple on each    M = GJ w + EA Var(rho^2) (w^2 - w0^2) w/2 + 2 EI <rho^2> w^3
//
// where its length is free: s^2 = 1 + <rho^2> (w0^2 - w^2) leaves it without a force. Where the length is kept,
// <rho^4> stands for the variance. Tubes that slide on one another lose that term, tubes whose spins are
// relaxed the one with GJ. The last term is the bending of helices, whose curvature is rho w^2 for a w per
// length of tube. 19 and 7 tubes with relaxed spins under 12 nN nm come to 138 and 196 degrees in runs, and to
// 142 and 205 by this equation.
#pragma once

#include <cmath>

#include "scene/prepare.hpp"

namespace ropewalk {

class RopeSection {
 public:
  enum class Tubes { cling, cling_at_kept_length, slide };

  RopeSection() = default;
  explicit RopeSection(const Prepared& prepared);

  double radius() const { return std::sqrt(most_); }  // distance of the outermost tube from the axis, nm
  // rad/nm: the first twist without a force on the way from `from`, where no tube is strained.
  double winding_under(double moment, const BondStiffness& bond, bool relaxes_spins, Tubes tubes,
                       double from = 0) const;
  // Strains of the outermost and of the innermost tube of a rope whose length is free.
  double outer_strain(double winding, double from) const { return strain(most_, winding, from); }
  double inner_strain(double winding, double from) const { return strain(least_, winding, from); }

 private:
  double strain(double rho2, double winding, double from) const;

  double mean_ = 0, mean_square_ = 0, least_ = 0, most_ = 0;  // rho^2 (nm^2), mean_square_: rho^4 (nm^4)
};

}  // namespace ropewalk
