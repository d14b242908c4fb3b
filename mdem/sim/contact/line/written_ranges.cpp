#include "sim/contact/line/written_ranges.hpp"

#include <algorithm>

namespace ropewalk {
namespace {

// Calls `what` with the elements that a chunk acts on, part by part of the tubes.
template <class What>
void for_written(const TubeParts& parts, const LineChunk& chunk, const What& what) {
  for (const WrittenRange& range : chunk.ranges)
    for (int k = parts.part_of(range.begin, range.tube);
         k < parts.begin(range.tube + 1) && parts[k].begin < range.end; ++k)
      what(k, BufferRange{std::max(parts[k].begin, range.begin), std::min(parts[k].end, range.end),
                          range.element_shift});
}

}  // namespace

void WrittenRanges::list(const TubeParts& parts, const std::vector<LineChunk>& chunks) {
  begin_.assign(static_cast<std::size_t>(parts.count()) + 1, 0);
  blocks_.assign(chunks.size(), {});
  chunks_on_.assign(static_cast<std::size_t>(parts.blocks()), 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    std::vector<int>& blocks = blocks_[c];
    for_written(parts, chunks[c], [&](int k, const BufferRange&) {
      ++begin_[static_cast<std::size_t>(k) + 1];
      const int block = parts.block_of(k);
      if (blocks.empty() || blocks.back() < block) blocks.push_back(block);
    });
    for (int block : blocks) ++chunks_on_[static_cast<std::size_t>(block)];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  written_.resize(static_cast<std::size_t>(begin_.back()));
  for (std::size_t c = 0; c < chunks.size(); ++c)
    for_written(parts, chunks[c], [&](int k, const BufferRange& on) {
      written_[static_cast<std::size_t>(next[static_cast<std::size_t>(k)]++)] = {static_cast<int>(c), on};
    });
}

std::size_t WrittenRanges::bytes() const {
  std::size_t total =
      written_.capacity() * sizeof(Written) + (begin_.capacity() + chunks_on_.capacity()) * sizeof(int);
  for (const std::vector<int>& on : blocks_) total += sizeof on + on.capacity() * sizeof(int);
  return total;
}

}  // namespace ropewalk
