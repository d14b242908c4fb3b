// The pairs of types of tubes between which a force term acts.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace ropewalk {

struct TypePairs {
  std::vector<int> named;                    // two types; none: all pairs
  std::vector<std::pair<int, int>> without;  // pairs that another term has

  static bool same(int a, int b, int x, int y) { return (a == x && b == y) || (a == y && b == x); }
  bool have(int type, int other) const {
    if (!named.empty()) return same(type, other, named[0], named[1]);
    return std::none_of(without.begin(), without.end(),
                        [&](const auto& pair) { return same(type, other, pair.first, pair.second); });
  }
};

}  // namespace ropewalk
