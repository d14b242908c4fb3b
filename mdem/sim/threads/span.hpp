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

// Numbers sorted into the rows of a compressed array, rising in each row.
class Rows {
 public:
  // row_of(k): the row of the number k < count; -1: it is in none.
  template <class RowOf>
  void sort_in(std::size_t rows, std::size_t count, const RowOf& row_of) {
    begin_.assign(rows + 1, 0);
    for (std::size_t k = 0; k < count; ++k)
      if (const int row = row_of(k); row >= 0) ++begin_[static_cast<std::size_t>(row) + 1];
    for (std::size_t row = 1; row < begin_.size(); ++row) begin_[row] += begin_[row - 1];
    numbers_.resize(static_cast<std::size_t>(begin_.back()));
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t k = 0; k < count; ++k)
      if (const int row = row_of(k); row >= 0)
        numbers_[static_cast<std::size_t>(next[static_cast<std::size_t>(row)]++)] = static_cast<int>(k);
  }
  Span<int> of(int row) const { return entries_of(row, begin_, numbers_); }

 private:
  std::vector<int> begin_, numbers_;
};

}  // namespace ropewalk
