// Sizes of scratch vectors, which are reused while their sizes change a little. Their contents may be lost.
#pragma once

#include <cstddef>
#include <vector>

namespace ropewalk {

// Reserves n entries and at most an eighth more. std::vector would double its size when it is a little short, and
// keep it.
template <class T>
void reserve_tightly(std::vector<T>& v, std::size_t n) {
  constexpr std::size_t few = 64;
  if (n <= v.capacity() && v.capacity() <= n + n / 8 + few) return;
  std::vector<T>().swap(v);  // frees it first
  v.reserve(n);
}

// n entries of any value.
template <class T>
void set_size(std::vector<T>& v, std::size_t n) {
  reserve_tightly(v, n);
  v.resize(n);
}

}  // namespace ropewalk
