// Work stealing: pieces of work of uneven cost for a team of threads. Each thread begins with a share of
// consecutive pieces, the same ones in every step, so that data of the last step are still in its cache. A thread
// whose share is done takes pieces from the end of the largest remaining share.
#pragma once

#include <omp.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "model/contract.hpp"

namespace ropewalk {

class WorkShares {
 public:
  // A copy is empty: shares are valid only for the work that they were dealt for.
  WorkShares() = default;
  WorkShares(const WorkShares&) {}
  WorkShares& operator=(const WorkShares&) { return *this; }

  // Call it before the team starts.
  void deal(int pieces, int threads) {
    ROPEWALK_EXPECTS(pieces >= 0 && threads > 0);
    if (static_cast<int>(shares_.size()) != threads)
      shares_ = std::vector<Share>(static_cast<std::size_t>(threads));
    for (int t = 0; t < threads; ++t)
      shares_[static_cast<std::size_t>(t)].left = pack(pieces * t / threads, pieces * (t + 1) / threads);
  }
  // The next piece for this thread; -1 if none is left.
  int take(int thread) {
    ROPEWALK_EXPECTS(thread >= 0 && static_cast<std::size_t>(thread) < shares_.size());
    const int own = take_first(shares_[static_cast<std::size_t>(thread)]);
    if (own >= 0) return own;
    for (;;) {
      Share* largest = nullptr;
      int most = 0;
      for (Share& s : shares_) {
        const std::uint64_t left = s.left.load(std::memory_order_relaxed);
        if (end_of(left) - begin_of(left) > most) most = end_of(left) - begin_of(left), largest = &s;
      }
      if (!largest) return -1;
      const int piece = take_last(*largest);
      if (piece >= 0) return piece;
    }
  }

 private:
  // Begin and end of a share in one word, so that both change at once. Each share has its own cache line.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> left{0};
  };
  static std::uint64_t pack(int begin, int end) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(begin)) << 32 | static_cast<std::uint32_t>(end);
  }
  static int begin_of(std::uint64_t left) { return static_cast<int>(left >> 32); }
  static int end_of(std::uint64_t left) { return static_cast<int>(left & 0xffffffffu); }

  static int take_first(Share& s) {
    std::uint64_t left = s.left.load(std::memory_order_relaxed);
    while (begin_of(left) < end_of(left))
      if (s.left.compare_exchange_weak(left, pack(begin_of(left) + 1, end_of(left)), std::memory_order_relaxed))
        return begin_of(left);
    return -1;
  }
  static int take_last(Share& s) {
    std::uint64_t left = s.left.load(std::memory_order_relaxed);
    while (begin_of(left) < end_of(left))
      if (s.left.compare_exchange_weak(left, pack(begin_of(left), end_of(left) - 1), std::memory_order_relaxed))
        return end_of(left) - 1;
    return -1;
  }

  std::vector<Share> shares_;
};

// Per block, the number of pieces of work that still contribute. The thread that counts a block down to zero sees
// everything that other threads wrote before they counted.
class Countdowns {
 public:
  // A copy is empty, as above.
  Countdowns() = default;
  Countdowns(const Countdowns&) {}
  Countdowns& operator=(const Countdowns&) { return *this; }

  // Call it before the team starts, with the number of pieces of each block.
  void start(const std::vector<int>& pieces) {
    if (left_.size() != pieces.size()) left_ = std::vector<std::atomic<int>>(pieces.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) left_[k].store(pieces[k], std::memory_order_relaxed);
  }
  // Counts block k down. Returns whether this was its last piece.
  bool last(int k) {
    ROPEWALK_EXPECTS(k >= 0 && static_cast<std::size_t>(k) < left_.size());
    const int before = left_[static_cast<std::size_t>(k)].fetch_sub(1, std::memory_order_acq_rel);
    ROPEWALK_ENSURES(before > 0);
    return before == 1;
  }

 private:
  std::vector<std::atomic<int>> left_;
};

}  // namespace ropewalk
