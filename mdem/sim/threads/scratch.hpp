// Room in vectors that are used over and over while their sizes change a little, without what they held.
#pragma once

#include <cstddef>
#include <vector>

namespace ropewalk {

// Room for n entries and no more than an eighth to spare: a vector that is a little short would grow to twice its
// size, and keep that. What it holds may be lost.
template <class T>
void make_room(std::vector<T>& v, std::size_t n) {
  constexpr std::size_t few = 64;
  if (n <= v.capacity() && v.capacity() <= n + n / 8 + few) return;
  std::vector<T>().swap(v);  // frees it first
  v.reserve(n);
}

// n entries, whatever they are.
template <class T>
void set_size(std::vector<T>& v, std::size_t n) {
  make_room(v, n);
  v.resize(n);
}

}  // namespace ropewalk
