// Several processes that share the elements of a scene.
#pragma once

#include <cstddef>
#include <vector>

namespace ropewalk {

// All processes must call each of these at once.
class Processes {
 public:
  virtual ~Processes() = default;
  // Replaces values by their sums over all processes, the same bits on each of them.
  virtual void sum(double* values, std::size_t count) const = 0;
  // The lists of all processes behind one another.
  virtual std::vector<int> join(const std::vector<int>& own) const = 0;
};

}  // namespace ropewalk
