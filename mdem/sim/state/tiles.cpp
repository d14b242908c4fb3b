#include "sim/state/tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "model/contract.hpp"

namespace ropewalk {
namespace {

// Elements of a piece, which is never cut. Shorter pieces would make tiles more compact, but would spread a tube
// over more tiles, which costs more than it gains.
constexpr int piece_length = 48;

struct Piece {
  Segment of;
  double cost = 0;
  std::array<double, 3> centre{};
};
using Pieces = std::vector<Piece>::iterator;

// The first piece of a tube has one more element: the first element stands alone, the others are in pairs, which no
// cut divides.
int end_of_piece(int begin, const Segment& tube) {
  const int end = begin + piece_length + (begin == tube.begin ? 1 : 0);
  return tube.end - end < piece_length / 2 ? tube.end : end;
}

std::vector<Segment> own_segments(const Topology& topology, int tube) {
  const int first = topology.tube_begin[tube], last = topology.tube_begin[tube + 1];
  if (!topology.part) return {{tube, first, last}};
  std::vector<Segment> own;
  for (int from = first, to; from < last; from = to) {
    to = topology.change_of_owner(from, last);
    if (topology.owns(from)) own.push_back({tube, from, to});
  }
  return own;
}

std::vector<Piece> pieces_of(const Topology& topology, const Vec3Array& position, const std::vector<double>& cost) {
  std::vector<Piece> pieces;
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0.0; };
  for (int t = 0; t < topology.tubes(); ++t) {
    for (const Segment& tube : own_segments(topology, t))
      for (int from = tube.begin; from < tube.end;) {
        Piece piece;
        piece.of = {t, from, end_of_piece(from, tube)};
        for (int i = from; i < piece.of.end; ++i) piece.cost += cost[static_cast<std::size_t>(i)];
        const auto middle = static_cast<std::size_t>((from + piece.of.end) / 2);
        piece.centre = {finite(position.x[middle]), finite(position.y[middle]), finite(position.z[middle])};
        pieces.push_back(piece);
        from = piece.of.end;
      }
  }
  return pieces;
}

std::size_t longest_side(Pieces first, Pieces last) {
  std::size_t longest = 0;
  double length = -1;
  for (std::size_t a = 0; a < 3; ++a) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (Pieces p = first; p != last; ++p) low = std::min(low, p->centre[a]), high = std::max(high, p->centre[a]);
    if (high - low > length) longest = a, length = high - low;
  }
  return longest;
}

std::vector<Segment> joined(Pieces first, Pieces last) {
  std::sort(first, last, [](const Piece& a, const Piece& b) { return a.of.begin < b.of.begin; });
  std::vector<Segment> out;
  for (Pieces p = first; p != last; ++p) {
    if (!out.empty() && out.back().tube == p->of.tube && out.back().end == p->of.begin)
      out.back().end = p->of.end;
    else
      out.push_back(p->of);
  }
  return out;
}

void sort_across(std::size_t side, Pieces first, Pieces last) {
  std::sort(first, last, [&](const Piece& a, const Piece& b) {
    return std::tie(a.centre[side], a.of.begin) < std::tie(b.centre[side], b.of.begin);
  });
}

// The cut in the sorted pieces that leaves a fraction `share` of the cost before it.
Pieces cut_at(double share, Pieces first, Pieces last) {
  double total = 0, sum = 0;
  for (Pieces p = first; p != last; ++p) total += p->cost;
  Pieces cut = first;
  for (; cut != last && sum + 0.5 * cut->cost < share * total; ++cut) sum += cut->cost;
  return cut;
}

void bisect(CutBy by, Pieces first, Pieces last, int count, std::vector<std::vector<Segment>>& tiles) {
  if (count == 1) {
    tiles.push_back(joined(first, last));
    return;
  }
  if (by == CutBy::position) sort_across(longest_side(first, last), first, last);
  const int left = count / 2;
  const Pieces cut = cut_at(static_cast<double>(left) / count, first, last);
  bisect(CutBy::position, first, cut, left, tiles);
  bisect(CutBy::position, cut, last, count - left, tiles);
}

}  // namespace

void TubeParts::cut(const Topology& topology) {
  parts_.clear();
  begin_.clear();
  block_begin_.clear();
  block_of_.clear();
  for (int t = 0; t < topology.tubes(); ++t) {
    begin_.push_back(count());
    for (int first = topology.tube_begin[t], end = topology.tube_begin[t + 1], last; first < end; first = last) {
      last = topology.part ? topology.change_of_owner(first, end) : end;
      const int elements = last - first, parts = (elements + most - 1) / most;
      for (int k = 0; k < parts; ++k)
        parts_.push_back({t, first + static_cast<int>(static_cast<std::int64_t>(elements) * k / parts),
                          first + static_cast<int>(static_cast<std::int64_t>(elements) * (k + 1) / parts)});
    }
  }
  begin_.push_back(count());
  for (int k = 0, first = 0; k < count(); ++k) {
    if (k == 0 || (*this)[k].end - first > max_block) {
      block_begin_.push_back(k);
      first = (*this)[k].begin;
    }
    block_of_.push_back(static_cast<int>(block_begin_.size()) - 1);
  }
  block_begin_.push_back(count());
  ROPEWALK_ENSURES(parts_.empty() || parts_.back().end == topology.elements());
}

int TubeParts::part_of(int element, int tube) const {
  ROPEWALK_EXPECTS(tube >= 0 && tube + 1 < static_cast<int>(begin_.size()));
  const auto part = std::upper_bound(parts_.begin() + begin(tube), parts_.begin() + begin(tube + 1), element,
                                     [](int e, const Segment& s) { return e < s.end; });
  return static_cast<int>(part - parts_.begin());
}

std::vector<std::vector<Segment>> cut_into_tiles(const Topology& topology, const Vec3Array& position,
                                                 const std::vector<double>& cost, int count, CutBy first) {
  ROPEWALK_EXPECTS(count > 0 && cost.size() == position.size());
  std::vector<Piece> pieces = pieces_of(topology, position, cost);
  std::vector<std::vector<Segment>> tiles;
  tiles.reserve(static_cast<std::size_t>(count));
  bisect(first, pieces.begin(), pieces.end(), count, tiles);
  ROPEWALK_ENSURES(static_cast<int>(tiles.size()) == count);
  return tiles;
}

}  // namespace ropewalk
