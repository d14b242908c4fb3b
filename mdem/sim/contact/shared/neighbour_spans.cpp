#include "sim/contact/shared/neighbour_spans.hpp"

namespace ropewalk {

void PairRuns::build(const NeighbourList& list, double reach) {
  const Vec3Array& x = list.reference();
  const auto n = static_cast<int>(x.size());
  const double far = reach + list.skin, far2 = far * far;
  begin_.assign(x.size() + 1, 0);
  run_.clear();
  for (int i = 0; i < n; ++i) {
    const Vector3 x_i = x[static_cast<std::size_t>(i)];
    list.for_neighbours(i, [&](int j) {
      if (!((x[static_cast<std::size_t>(j)] - x_i).squaredNorm() < far2)) return;
      const bool any = run_.size() > begin_[static_cast<std::size_t>(i)];
      if (any && run_.back().end == j && j - run_.back().begin < longest) {
        ++run_.back().end;
      } else {
        run_.push_back({j, j + 1});
      }
    });
    begin_[static_cast<std::size_t>(i) + 1] = run_.size();
  }
}

}  // namespace ropewalk
