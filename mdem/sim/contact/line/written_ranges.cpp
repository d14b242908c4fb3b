#include "sim/contact/line/written_ranges.hpp"

#include <algorithm>

namespace ropewalk {
namespace {

// What a chunk acts on, part by part of the tubes.
template <class What>
void for_touches(const TubeParts& parts, const LineChunk& chunk, const What& what) {
  for (const TouchedPart& touched : chunk.parts)
    for (int k = parts.part_of(touched.begin, touched.tube);
         k < parts.begin(touched.tube + 1) && parts[k].begin < touched.end; ++k)
      what(k,
           TouchedRange{std::max(parts[k].begin, touched.begin), std::min(parts[k].end, touched.end),
                        touched.element_shift},
           touched.beyond);
}

}  // namespace

void LineTouches::list(const TubeParts& parts, const std::vector<LineChunk>& chunks) {
  begin_.assign(static_cast<std::size_t>(parts.count()) + 1, 0);
  blocks_.assign(chunks.size(), {});
  chunks_on_.assign(static_cast<std::size_t>(parts.blocks()), 0);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    std::vector<int>& blocks = blocks_[c];
    for_touches(parts, chunks[c], [&](int k, const TouchedRange&, float) {
      ++begin_[static_cast<std::size_t>(k) + 1];
      const int block = parts.block_of(k);
      if (blocks.empty() || blocks.back() < block) blocks.push_back(block);
    });
    for (int block : blocks) ++chunks_on_[static_cast<std::size_t>(block)];
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  touch_.resize(static_cast<std::size_t>(begin_.back()));
  for (std::size_t c = 0; c < chunks.size(); ++c)
    for_touches(parts, chunks[c], [&](int k, const TouchedRange& on, float beyond) {
      touch_[static_cast<std::size_t>(next[static_cast<std::size_t>(k)]++)] = {static_cast<int>(c), on, beyond};
    });
}

std::size_t LineTouches::bytes() const {
  std::size_t total = touch_.capacity() * sizeof(Touch) + (begin_.capacity() + chunks_on_.capacity()) * sizeof(int);
  for (const std::vector<int>& on : blocks_) total += sizeof on + on.capacity() * sizeof(int);
  return total;
}

}  // namespace ropewalk
