#include "sim/neighbours/cell_grid.hpp"

#include <algorithm>
#include <cmath>

#undef VEC_SOURCE
#define VEC_SOURCE "sim/neighbours/cell_grid.cpp"
#include "sim/vectors/each_set-inl.hpp"
//
#include "sim/vectors/operations-inl.hpp"

#ifndef ROPEWALK_CELL_SEARCH
#define ROPEWALK_CELL_SEARCH
namespace ropewalk {

// Members begin .. end - 1; memory behind them may be read.
struct MemberRange {
  int begin, end;
};

struct CellSearch {
  const float *x, *y, *z;  // coordinates of the members
  const int* member;
  float at_x, at_y, at_z, reach2;
  int after;
};

}  // namespace ropewalk
#endif

VEC_BEFORE_NAMESPACE();
namespace ropewalk::VEC_SET {
namespace ops = vec::VEC_SET;

// Without branches on distances, which are mispredicted too often. Writes up to a vector beyond the found members.
std::size_t FindNear(const CellSearch& s, const MemberRange* first, const MemberRange* last, int* found) {
  const ops::ScalableTag<float> d;
  const ops::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(ops::Lanes(d));
  const auto x = ops::Set(d, s.at_x), y = ops::Set(d, s.at_y), z = ops::Set(d, s.at_z),
             reach2 = ops::Set(d, s.reach2);
  const auto after = ops::Set(di, s.after);
  std::size_t count = 0;
  for (const MemberRange* r = first; r != last; ++r)
    for (int k = r->begin; k < r->end; k += lanes) {
      const auto dx = ops::Sub(ops::Load(d, s.x + k), x), dy = ops::Sub(ops::Load(d, s.y + k), y),
                 dz = ops::Sub(ops::Load(d, s.z + k), z);
      const auto member = ops::Load(di, s.member + k);
      const auto near = ops::Lt(ops::MulAdd(dx, dx, ops::MulAdd(dy, dy, ops::Mul(dz, dz))), reach2);
      const auto met =
          ops::And(ops::And(ops::RebindMask(di, near), ops::Gt(member, after)), ops::FirstN(di, r->end - k));
      count += ops::CompressStore(member, met, di, found + count);
    }
  return count;
}

}  // namespace ropewalk::VEC_SET
VEC_AFTER_NAMESPACE();

#if VEC_ONCE
namespace ropewalk {

VEC_EXPORT(FindNear);

namespace {

constexpr std::size_t behind = 16;  // members that may be read, and found ones that may be written, behind the last

std::size_t longest_side(const std::array<double, 3>& extent) {
  return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
}

}  // namespace

CellGrid::CellGrid(const Vec3Array& position, double reach)
    : place_{position.x.data(), position.y.data(), position.z.data()}, count_(position.size()), reach_(reach) {
  make_cells();
  sort_into_cells();
}

void CellGrid::make_cells() {
  for (std::size_t a = 0; a < 3; ++a) {
    double low = 0, high = 0;
    bool any = false;
    for (std::size_t i = 0; i < count_; ++i) {
      const double value = place_[a][i];
      if (!std::isfinite(value)) continue;
      low = any ? std::min(low, value) : value;
      high = any ? std::max(high, value) : value;
      any = true;
    }
    origin_[a] = low;
    extent_[a] = high - low;
  }
  const std::size_t longest = longest_side(extent_);
  std::swap(place_[longest], place_[2]), std::swap(origin_[longest], origin_[2]);
  std::swap(extent_[longest], extent_[2]);
  // Places are rounded to some 1e-7 of the longest side.
  const double search = reach_ + 1e-6 * extent_[2];
  search2_ = static_cast<float>(1.00001 * search * search);
  // No more cells than a few per element however sparse the scene.
  width_ = reach_ / away;
  const double most = 4.0 * static_cast<double>(count_) + 64.0;
  const auto cells = [&](double width) {
    double product = 1;
    for (double e : extent_) product *= std::floor(e / width) + 1;
    return product;
  };
  while (cells(width_) > most) width_ *= 1.26;
  for (std::size_t a = 0; a < 3; ++a) cells_[a] = static_cast<int>(extent_[a] / width_) + 1;
}

CellGrid::Cell CellGrid::cell_of(std::size_t i) const {
  const auto along = [&](std::size_t a) {
    const double c = (place_[a][i] - origin_[a]) / width_;
    return c > 0 ? std::min(static_cast<int>(std::min(c, 1e9)), cells_[a] - 1) : 0;  // NaN goes to cell 0
  };
  return {along(0), along(1), along(2)};
}

void CellGrid::sort_into_cells() {
  std::vector<std::size_t> cell(count_);
  first_.assign(flat(cells_[0] - 1, cells_[1] - 1, cells_[2] - 1) + 2, 0);
  for (std::size_t i = 0; i < count_; ++i) {
    const Cell c = cell_of(i);
    cell[i] = flat(c[0], c[1], c[2]);
    ++first_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  member_.resize(count_ + behind);
  for (auto* v : {&x_, &y_, &z_}) v->resize(count_ + behind);
  for (std::size_t i = 0; i < count_; ++i) {
    const auto at = static_cast<std::size_t>(next[cell[i]]++);
    member_[at] = static_cast<int>(i);
    x_[at] = static_cast<float>(place_[0][i] - origin_[0]);
    y_[at] = static_cast<float>(place_[1][i] - origin_[1]);
    z_[at] = static_cast<float>(place_[2][i] - origin_[2]);
  }
}

std::size_t CellGrid::find(int i, int after, std::vector<int>& found) const {
  const auto own = static_cast<std::size_t>(i);
  const Cell middle = cell_of(own);
  const auto low = [&](std::size_t a) { return std::max(middle[a] - away, 0); };
  const auto high = [&](std::size_t a) { return std::min(middle[a] + away, cells_[a] - 1); };
  MemberRange ranges[side * side];
  MemberRange* end = ranges;
  std::size_t candidates = 0;
  for (int a = low(0); a <= high(0); ++a)
    for (int b = low(1); b <= high(1); ++b) {
      *end = {first_[flat(a, b, low(2))], first_[flat(a, b, high(2)) + 1]};
      candidates += static_cast<std::size_t>(end->end - end->begin);
      if (end->begin < end->end) ++end;
    }
  if (found.size() < candidates + behind) found.resize(2 * (candidates + behind));
  const auto from_origin = [&](std::size_t a) { return static_cast<float>(place_[a][own] - origin_[a]); };
  const CellSearch search{x_.data(),      y_.data(),      z_.data(), member_.data(), from_origin(0),
                          from_origin(1), from_origin(2), search2_,  after};
  int* const last = found.data() + VEC_IN_USE(FindNear)(search, ranges, end, found.data());
  const auto too_far = [&](int j) {
    const auto other = static_cast<std::size_t>(j);
    double distance2 = 0;
    for (const double* c : place_) distance2 += (c[other] - c[own]) * (c[other] - c[own]);
    return !(distance2 < reach_ * reach_);
  };
  return static_cast<std::size_t>(std::remove_if(found.data(), last, too_far) - found.data());
}

}  // namespace ropewalk
#endif  // VEC_ONCE
