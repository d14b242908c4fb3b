#include "plan/rope_section.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk {

RopeSection::RopeSection(const Prepared& p) {
  // At the lower end: the middle of a rope that begins bent aside is not its axis.
  const auto end_of = [&](int tube) -> Eigen::Vector2d {
    return Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[static_cast<std::size_t>(tube)])])
        .head<2>();
  };
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  double sum = 0;
  std::vector<int> strands;
  for (int t = 0; t < p.topology.tubes(); ++t)
    if (p.topology.begins_strand(t)) {
      strands.push_back(t);
      axis += end_of(t);
    }
  axis /= static_cast<double>(strands.size());
  bool first = true;
  for (const int t : strands) {
    const double rho2 = (end_of(t) - axis).squaredNorm(), stretch = p.topology.type_of(t).bond.stretch;
    mean_ += stretch * rho2;
    mean_square_ += stretch * rho2 * rho2;
    sum += stretch;
    least_ = first ? rho2 : std::min(least_, rho2);
    most_ = std::max(most_, rho2);
    first = false;
  }
  mean_ /= sum;
  mean_square_ /= sum;
}

double RopeSection::winding_under(double moment, const BondStiffness& bond, bool relaxes_spins, Tubes tubes,
                                  double from) const {
  const double held = tubes == Tubes::cling_at_kept_length ? 0 : mean_ * mean_, twist = relaxes_spins ? 0 : bond.twist,
               stretch = tubes == Tubes::slide ? 0 : 0.5 * bond.stretch * std::max(0.0, mean_square_ - held),
               bend = 2 * bond.bend * mean_;
  const auto force = [&](double w) {
    return moment - (twist + stretch * (w * w - from * from) + bend * w * w) * w;
  };
  const double way = force(from);
  if (way == 0 || (twist == 0 && bend == 0)) return from;
  // Beyond this the force has turned back, and none has a root there.
  const double most = std::max(std::fabs(from), twist > 0 ? std::fabs(moment) / twist
                                                           : std::cbrt(std::fabs(moment) / bend));
  const double side = std::copysign(1.0, way);
  constexpr int parts = 64;
  double low = from, high = side * most;
  for (int k = 1; k <= parts; ++k) {
    const double w = from + (side * most - from) * k / parts;
    if (side * force(w) > 0) {
      low = w;
      continue;
    }
    high = w;
    break;
  }
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (side * force(middle) > 0 ? low : high) = middle;
  }
  return low;
}

double RopeSection::strain(double rho2, double winding, double from) const {
  const double w2 = winding * winding, from2 = from * from, along2 = std::max(0.0, 1 + mean_ * (from2 - w2));
  return std::sqrt((along2 + rho2 * w2) / (1 + rho2 * from2)) - 1;
}

}  // namespace ropewalk
