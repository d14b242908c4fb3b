#include "sim/contact/shared/neighbour_spans.hpp"

namespace ropewalk {

void ElementSpans::build(const NeighbourList& list, double reach) {
  const Vec3Array& x = list.reference();
  const auto n = static_cast<int>(x.size());
  const double far = reach + list.skin, far2 = far * far;
  begin_.assign(x.size() + 1, 0);
  spans_.clear();
  for (int i = 0; i < n; ++i) {
    const Vector3 x_i = x[static_cast<std::size_t>(i)];
    list.for_neighbours(i, [&](int j) {
      if (!((x[static_cast<std::size_t>(j)] - x_i).squaredNorm() < far2)) return;
      const bool any = spans_.size() > begin_[static_cast<std::size_t>(i)];
      if (any && spans_.back().end == j && j - spans_.back().begin < longest) {
        ++spans_.back().end;
      } else {
        spans_.push_back({j, j + 1});
      }
    });
    begin_[static_cast<std::size_t>(i) + 1] = spans_.size();
  }
}

}  // namespace ropewalk
