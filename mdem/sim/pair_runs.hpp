// Runs of a Verlet list as the paper law's kernel takes them: no longer than it has room for, and without what lies
// beyond its own reach, where another one's is longer. Made anew at every build of the list.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/neighbours.hpp"

namespace ropewalk {

class PairRuns {
 public:
  static constexpr int longest = 64;  // longer ones are cut
  // The pairs of the list that can come closer than `reach` (nm) before it is built again.
  void build(const NeighbourList& list, double reach);

  const PairRun* begin(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i)]; }
  const PairRun* end(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i) + 1]; }
  std::size_t runs() const { return run_.size(); }
  std::size_t bytes() const { return run_.capacity() * sizeof(PairRun) + begin_.capacity() * sizeof(std::size_t); }

 private:
  std::vector<std::size_t> begin_;
  std::vector<PairRun> run_;
};

}  // namespace ropewalk
