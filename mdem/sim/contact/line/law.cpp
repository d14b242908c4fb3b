#include "sim/contact/line/law.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/segments.hpp"

namespace ropewalk {

LineLaw::LineLaw(std::vector<LineContact> all, std::vector<LineWell> wells)
    : pairs(std::move(all)),
      types_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(pairs.size()))))),
      wells_(std::move(wells)) {
  if (pairs.empty() || static_cast<std::size_t>(types_) * static_cast<std::size_t>(types_) != pairs.size())
    throw std::invalid_argument("the line law takes one contact for each pair of tube types");
  if (wells_.empty())
    for (const LineContact& pair : pairs) wells_.push_back(line_parallel_well(pair.density));
}

double LineLaw::cutoff() const {
  double reach = 0;
  for (const LineContact& pair : pairs) reach = std::max(reach, pair.cutoff());
  return reach;
}

double LineLaw::lever() const {
  double longest = 0;
  for (const LineContact& pair : pairs) longest = std::max(longest, 0.5 * pair.length_i);
  return longest;
}

bool LineLaw::reaches(TypePair types, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const {
  const LineContact& law = of(types);
  const double reach = law.density.cutoff() + 1e-6;  // the cutoff and a margin for the rounding of the distance, nm
  return squared_segment_distance(separation, n_i, n_j, 0.5 * law.length_i, 0.5 * law.length_j) < reach * reach;
}

double LineLaw::crossed_distance(TypePair types, double) const {
  return line_crossed_well(of(types).density, 0.5 * units::pi).distance;
}

}  // namespace ropewalk
