#include "sim/neighbours.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "sim/motion.hpp"

namespace ropewalk {
namespace {

// Elements sorted by the cell that they lie in. Cells are half as wide as the reach: of their neighbours up to two
// away, six in ten elements fewer have to be looked at than of cells as wide.
struct CellGrid {
  static constexpr int away = 2;
  std::array<double, 3> origin{};
  std::array<int, 3> cells{1, 1, 1};
  double width = 1;
  std::vector<int> first;  // of each cell in `members`
  std::vector<int> members;
  Vec3Array place;  // of the members

  std::array<int, 3> cell_of(double x, double y, double z) const {
    const auto along = [&](double value, int axis) {
      const double c = (value - origin[static_cast<std::size_t>(axis)]) / width;
      const int most = cells[static_cast<std::size_t>(axis)] - 1;
      return c > 0 ? std::min(static_cast<int>(std::min(c, 1e9)), most) : 0;  // NaN goes to cell 0
    };
    return {along(x, 0), along(y, 1), along(z, 2)};
  }
  std::size_t flat(int x, int y, int z) const {
    return (static_cast<std::size_t>(x) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cells[2]) +
           static_cast<std::size_t>(z);
  }
};

CellGrid make_grid(const Vec3Array& p, double reach) {
  CellGrid grid;
  const std::size_t n = p.size();
  std::array<const std::vector<double>*, 3> components{&p.x, &p.y, &p.z};
  std::array<double, 3> extent{};
  for (std::size_t a = 0; a < 3; ++a) {
    double low = 0, high = 0;
    bool any = false;
    for (double value : *components[a]) {
      if (!std::isfinite(value)) continue;
      low = any ? std::min(low, value) : value;
      high = any ? std::max(high, value) : value;
      any = true;
    }
    grid.origin[a] = low;
    extent[a] = high - low;
  }
  // No more cells than a few per element however sparse the scene.
  grid.width = reach / CellGrid::away;
  const double most = 4.0 * static_cast<double>(n) + 64.0;
  const auto count = [&](double width) {
    double product = 1;
    for (double e : extent) product *= std::floor(e / width) + 1;
    return product;
  };
  while (count(grid.width) > most) grid.width *= 1.26;
  for (std::size_t a = 0; a < 3; ++a) grid.cells[a] = static_cast<int>(extent[a] / grid.width) + 1;

  std::vector<std::size_t> cell(n);
  grid.first.assign(grid.flat(grid.cells[0] - 1, grid.cells[1] - 1, grid.cells[2] - 1) + 2, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto c = grid.cell_of(p.x[i], p.y[i], p.z[i]);
    cell[i] = grid.flat(c[0], c[1], c[2]);
    ++grid.first[cell[i] + 1];
  }
  for (std::size_t c = 1; c < grid.first.size(); ++c) grid.first[c] += grid.first[c - 1];
  std::vector<int> next(grid.first.begin(), grid.first.end() - 1);
  grid.members.resize(n);
  grid.place.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(next[cell[i]]++);
    grid.members[at] = static_cast<int>(i);
    grid.place.x[at] = p.x[i], grid.place.y[at] = p.y[i], grid.place.z[at] = p.z[i];
  }
  return grid;
}

// Those after element `after` that are closer than the root of reach2 to a place: their number, and they are the
// first ones of `found`, which grows where it has to. Without branches: a guess whether one is near is wrong too
// often.
std::size_t find_near(const CellGrid& grid, double x, double y, double z, int after, double reach2,
                      std::vector<int>& found) {
  std::size_t count = 0;
  const auto middle = grid.cell_of(x, y, z);
  const auto low = [&](std::size_t a) { return std::max(middle[a] - CellGrid::away, 0); };
  const auto high = [&](std::size_t a) { return std::min(middle[a] + CellGrid::away, grid.cells[a] - 1); };
  for (int cx = low(0); cx <= high(0); ++cx)
    for (int cy = low(1); cy <= high(1); ++cy) {
      // Cells along z are consecutive in memory: one run.
      const auto begin = static_cast<std::size_t>(grid.first[grid.flat(cx, cy, low(2))]),
                 end = static_cast<std::size_t>(grid.first[grid.flat(cx, cy, high(2)) + 1]);
      if (found.size() < count + (end - begin)) found.resize(2 * (count + (end - begin)));
      for (std::size_t k = begin; k < end; ++k) {
        const double dx = grid.place.x[k] - x, dy = grid.place.y[k] - y, dz = grid.place.z[k] - z;
        const int j = grid.members[k];
        found[count] = j;
        count += static_cast<std::size_t>((j > after) & (dx * dx + dy * dy + dz * dz < reach2));
      }
    }
  return count;
}

}  // namespace

bool NeighbourList::update(const Topology& topology, const State& state) {
  Change all;
  const auto n = static_cast<std::ptrdiff_t>(state.size());
  for (std::ptrdiff_t i = 0; i < n; i += block) all = both(all, change(state, i, std::min(i + block, n)));
  if (!worn(all)) return false;
  build(topology, state);
  return true;
}

// The distance of two points that the twist alone moves changes by no more than what it turns one against the
// other.
bool NeighbourList::worn(const Change& change) {
  const double against = 1.01 * std::fabs(twist_.slope) * (cutoff + skin + 2 * lever);
  displacement_ = change.moved + 0.5 * against * (farthest_ + lever);
  turn_ = change.turned + 0.5 * against;
  if (!std::isfinite(displacement_)) return true;
  follow(change);
  return displacement_ > 0.5 * skin;
}

// The twist that the next change is measured against: the best fit to this one.
void NeighbourList::follow(const Change& change) {
  const double determinant = arms2_[0] * arms2_[2] - arms2_[1] * arms2_[1];
  constexpr double fewest = 0.01;  // nm^2, of an element: a single tube along z has no place to turn about
  if (!(arms2_[0] > fewest * static_cast<double>(reference_.size())) ||
      !(determinant > 1e-6 * arms2_[0] * arms2_[2]))
    return;
  twist_.sine = (change.spin * arms2_[2] - change.spin_z * arms2_[1]) / determinant;
  twist_.slope = (change.spin_z * arms2_[0] - change.spin * arms2_[1]) / determinant;
}

Change NeighbourList::change(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Change c;
  if (reference_.size() == state.size())
    c = largest_change(state, reference_, reference_axis_, lever, twist_, begin, end);
  if (reference_.size() != state.size() || !std::isfinite(c.sum)) c.moved = c.turned = infinity;
  return c;
}

// About the middle of all places, which has to be no point in particular.
void NeighbourList::start_twist() {
  const Vec3Array& p = reference_;
  twist_ = {};
  farthest_ = 0;
  for (double& sum : arms2_) sum = 0;
  const double n = static_cast<double>(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    twist_.x += p.x[i] / n;
    twist_.y += p.y[i] / n;
    twist_.middle += p.z[i] / n;
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double x = p.x[i] - twist_.x, y = p.y[i] - twist_.y, z = p.z[i] - twist_.middle, arm2 = x * x + y * y;
    farthest_ = std::max(farthest_, std::sqrt(arm2));
    arms2_[0] += arm2;
    arms2_[1] += z * arm2;
    arms2_[2] += z * z * arm2;
  }
}

void NeighbourList::build(const Topology& topology, const State& state) {
  Vec3Array axis(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) axis.set(i, axis_of(state.orientation[i]));
  build(topology, state.position, std::move(axis));
}

void NeighbourList::build(const Topology& topology, Vec3Array position, Vec3Array axis) {
  static std::atomic<long> stamps{0};
  stamp_ = ++stamps;
  displacement_ = turn_ = 0;
  reference_ = std::move(position);
  reference_axis_ = std::move(axis);
  start_twist();
  const Vec3Array& p = reference_;
  const int n = static_cast<int>(p.size());
  const double reach = cutoff + skin;
  const double reach2 = reach * reach;
  ++builds_;
  begin_.assign(static_cast<std::size_t>(n) + 1, 0);
  index_.clear();
  if (cutoff > 0) {
    const CellGrid grid = make_grid(p, reach);
    std::vector<int> last(static_cast<std::size_t>(n));  // element of its tube that is too near to count
    for (int t = 0; t < topology.tubes(); ++t)
      for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i)
        last[static_cast<std::size_t>(i)] = std::min(i + exclude_along_tube, topology.tube_begin[t + 1] - 1);

    constexpr int parts = 64;
    std::vector<std::vector<int>> found(parts);
#pragma omp parallel for schedule(dynamic, 1) if (p.size() > parallel_from)
    for (int part = 0; part < parts; ++part) {
      const int from = static_cast<int>(static_cast<std::int64_t>(n) * part / parts);
      const int to = static_cast<int>(static_cast<std::int64_t>(n) * (part + 1) / parts);
      auto& list = found[static_cast<std::size_t>(part)];
      std::vector<int> near;
      for (int i = from; i < to; ++i) {
        const auto si = static_cast<std::size_t>(i);
        const std::size_t count = find_near(grid, p.x[si], p.y[si], p.z[si], last[si], reach2, near);
        const auto end = near.begin() + static_cast<std::ptrdiff_t>(count);
        std::sort(near.begin(), end);
        list.insert(list.end(), near.begin(), end);
        begin_[si + 1] = count;
      }
    }
    std::size_t total = 0;
    for (const auto& list : found) total += list.size();
    index_.reserve(total);
    for (const auto& list : found) index_.insert(index_.end(), list.begin(), list.end());
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  }
  cut_into_chunks(n);
}

double NeighbourList::coordinate_unit() const {
  double largest = 1;
  for (const auto* v : {&reference_.x, &reference_.y, &reference_.z})
    for (double x : *v)
      if (std::isfinite(x)) largest = std::max(largest, std::fabs(x));
  return std::exp2(std::ceil(std::log2(largest + 64)) - 28);
}

// Whatever the threads: the cut belongs to the list. Where the chunks would touch too much in common, as they do
// where tubes with far numbers cross, fewer are made: clearing and adding up their buffers would cost as much as
// the contact itself.
void NeighbourList::cut_into_chunks(int n) {
  constexpr int fewest = 16;         // enough for as many threads
  constexpr double most_common = 3;  // buffers for each element
  for (int count = chunk_count(n, whole_ranges);; count = std::max(fewest, count / 2)) {
    cut_into_chunks(n, count);
    if (!whole_ranges) return;
    double touched = 0;
    for (const Chunk& c : chunks_) touched += c.touched_end - c.touched_begin;
    if (count <= fewest || touched <= most_common * n) return;
  }
}

// Equal numbers of pairs.
void NeighbourList::cut_into_chunks(int n, int count) {
  chunks_.assign(static_cast<std::size_t>(count), Chunk{});
  int from = 0;
  for (int k = 0; k < count; ++k) {
    Chunk& chunk = chunks_[static_cast<std::size_t>(k)];
    const std::size_t target = pairs() * static_cast<std::size_t>(k + 1) / static_cast<std::size_t>(count);
    int to = from;
    if (k + 1 == count) {
      to = n;
    } else {
      while (to < n && begin(to) < target) ++to;
    }
    chunk.begin = from;
    chunk.end = to;
    chunk.touched_begin = from;
    chunk.touched_end = to;
    for (std::size_t k2 = begin(from); k2 < begin(to); ++k2)
      chunk.touched_end = std::max(chunk.touched_end, index_[k2] + 1);
    from = to;
  }
}

}  // namespace ropewalk
