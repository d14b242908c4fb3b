// Runs of a Verlet list as the paper law's kernel takes them: no longer than it has room for, and without what lies
// beyond its reach, as the list may reach farther than this law does. Made anew at every build of the list.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/neighbours/neighbours.hpp"

namespace ropewalk {

class PairRuns {
 public:
  static constexpr int longest = 64;  // longer ones are cut
  // The pairs of the list that can come closer than `reach` (nm) before it is built again.
  void build(const NeighbourList& list, double reach);

  Span<PairRun> runs(int i) const { return entries_of(i, begin_, run_); }
  std::size_t count() const { return run_.size(); }
  std::size_t bytes() const { return run_.capacity() * sizeof(PairRun) + begin_.capacity() * sizeof(std::size_t); }

 private:
  std::vector<std::size_t> begin_;
  std::vector<PairRun> run_;
};

}  // namespace ropewalk
