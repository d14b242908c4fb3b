// Vectors and quaternions of many elements, as columns of one component each in one block of memory: column k
// begins k strides behind the first. So loops run along columns, and other programs (numpy) see an array of
// vectors.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "model/contract.hpp"

namespace ropewalk {

// A part of a ColumnBlock.
class Column {
 public:
  std::size_t size() const { return size_; }
  double* data() { return data_; }
  const double* data() const { return data_; }
  double& operator[](std::size_t i) {
    ROPEWALK_EXPECTS(i < size_);
    return data_[i];
  }
  double operator[](std::size_t i) const {
    ROPEWALK_EXPECTS(i < size_);
    return data_[i];
  }
  double* begin() { return data_; }
  const double* begin() const { return data_; }
  double* end() { return data_ + size_; }
  const double* end() const { return data_ + size_; }
  friend bool operator==(const Column& a, const Column& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  friend bool operator!=(const Column& a, const Column& b) { return !(a == b); }

 private:
  template <std::size_t>
  friend class ColumnBlock;
  double* data_ = nullptr;
  std::size_t size_ = 0;
};

// The memory of N columns, which belong to whoever inherits from it.
template <std::size_t N>
class ColumnBlock {
 public:
  std::size_t stride() const { return stride_; }  // numbers from column to column

 protected:
  using Columns = std::array<Column*, N>;

  // The columns keep their numbers; new numbers are 0. Memory moves only where there is too little.
  void resize(const Columns& columns, std::size_t n) {
    if (n > stride_) {
      const std::size_t stride = (n + 3) & ~std::size_t{1};  // as apart as the heap would put them
      std::vector<double> numbers(N * stride, 0.0);
      for (std::size_t k = 0; k < N; ++k) {
        std::copy(columns[k]->begin(), columns[k]->end(), numbers.data() + k * stride);
        columns[k]->data_ = numbers.data() + k * stride;
      }
      numbers_ = std::move(numbers);
      stride_ = stride;
    }
    for (Column* column : columns) {
      const std::size_t before = std::exchange(column->size_, n);
      if (n > before) std::fill(column->begin() + before, column->end(), 0.0);
    }
  }
  void copy(const Columns& columns, const std::array<const Column*, N>& from) {
    for (const Column* column : from) ROPEWALK_EXPECTS(column->size() == from[0]->size());
    resize(columns, from[0]->size());
    for (std::size_t k = 0; k < N; ++k) std::copy(from[k]->begin(), from[k]->end(), columns[k]->begin());
  }
  void swap(const Columns& columns, ColumnBlock& other, const Columns& others) noexcept {
    numbers_.swap(other.numbers_);
    std::swap(stride_, other.stride_);
    for (std::size_t k = 0; k < N; ++k) std::swap(*columns[k], *others[k]);
  }

 private:
  std::vector<double> numbers_;
  std::size_t stride_ = 0;
};

}  // namespace ropewalk
