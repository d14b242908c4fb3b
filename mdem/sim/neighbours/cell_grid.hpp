// Places sorted by cells, to find those near a place.
#pragma once

#include <array>
#include <vector>

#include "sim/state/state.hpp"

namespace ropewalk {

// Cells are half as wide as the reach: of their neighbours up to two away, six in ten elements fewer have to be
// looked at than of cells as wide. Along the longest side of the scene cells are consecutive in memory.
class CellGrid {
 public:
  // Both nm. `position` has to outlive this and may hold what is not finite: nothing is near it.
  CellGrid(const Vec3Array& position, double reach);
  // The elements after number `after` that are closer than the reach to element i: how many; they are the first
  // ones of `found`, which grows where it has to, in no order.
  std::size_t find(int i, int after, std::vector<int>& found) const;

 private:
  static constexpr int away = 2;
  static constexpr int side = 2 * away + 1;
  using Cell = std::array<int, 3>;

  void make_cells();
  void sort_into_cells();
  Cell cell_of(std::size_t i) const;
  std::size_t flat(int a, int b, int c) const {
    return (static_cast<std::size_t>(a) * static_cast<std::size_t>(cells_[1]) + static_cast<std::size_t>(b)) *
               static_cast<std::size_t>(cells_[2]) +
           static_cast<std::size_t>(c);
  }

  std::array<const double*, 3> place_;  // components, the last one along the longest side
  std::size_t count_;
  double reach_, width_ = 1;
  float search2_ = 0;  // nm^2: within this of each other in single precision is whatever is within reach
  std::array<double, 3> origin_{}, extent_{};
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<int> first_;        // of each cell in the members
  std::vector<int> member_;       // elements
  std::vector<float> x_, y_, z_;  // their places, from the origin
};

}  // namespace ropewalk
