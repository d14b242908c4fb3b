#include "sim/dynamics/free_and_driven.hpp"

namespace ropewalk {
namespace {

// Element i of this type, behind those of the ranges from `first` on.
void append(std::ptrdiff_t i, int type, std::size_t first, std::vector<ElementRange>& ranges) {
  if (ranges.size() > first && ranges.back().end == i && ranges.back().type == type)
    ++ranges.back().end;
  else
    ranges.push_back({i, i + 1, type});
}

}  // namespace

FreeAndDriven::FreeAndDriven(const Topology& topology, const std::vector<int>& driven) {
  const TubeParts parts(topology);
  auto next = driven.begin();
  for (int block = 0; block < parts.blocks(); ++block) {
    first_free_.push_back(free_.size());
    first_driven_.push_back(driven_.size());
    for (int k = parts.block_begin(block); k < parts.block_begin(block + 1); ++k)
      for (int i = parts[k].begin; i < parts[k].end; ++i) {
        const int type = topology.tube_type[static_cast<std::size_t>(parts[k].tube)];
        if (next != driven.end() && *next == i) {
          append(i, type, first_driven_.back(), driven_);
          ++next;
        } else {
          append(i, type, first_free_.back(), free_);
        }
      }
  }
  first_free_.push_back(free_.size());
  first_driven_.push_back(driven_.size());
}

}  // namespace ropewalk
