// Consecutive entries of an array that belongs to someone else.
#pragma once

#include <cstddef>
#include <vector>

namespace ropewalk {

template <class T>
struct Span {
  const T *first, *last;
  const T* begin() const { return first; }
  const T* end() const { return last; }
};

// Those of number k, where `begin` has the first one of each number and, in the end, how many there are in all.
template <class T, class Index>
Span<T> entries_of(int k, const std::vector<Index>& begin, const std::vector<T>& all) {
  const auto at = static_cast<std::size_t>(k);
  return {all.data() + begin[at], all.data() + begin[at + 1]};
}

}  // namespace ropewalk
