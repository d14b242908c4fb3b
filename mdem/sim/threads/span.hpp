// Consecutive entries of an array. A span does not own them.
#pragma once

#include <cstddef>
#include <vector>

#include "model/contract.hpp"

namespace ropewalk {

template <class T>
struct Span {
  const T *first, *last;
  const T* begin() const { return first; }
  const T* end() const { return last; }
};

// Row k of a compressed array: `begin[k]` is the first entry of row k, and the last entry of `begin` is the total
// number of entries.
template <class T, class Index>
Span<T> entries_of(int k, const std::vector<Index>& begin, const std::vector<T>& all) {
  ROPEWALK_EXPECTS(k >= 0 && static_cast<std::size_t>(k) + 1 < begin.size());
  const auto at = static_cast<std::size_t>(k);
  ROPEWALK_EXPECTS(begin[at] <= begin[at + 1] && static_cast<std::size_t>(begin[at + 1]) <= all.size());
  return {all.data() + begin[at], all.data() + begin[at + 1]};
}

}  // namespace ropewalk
