// The parts of the tubes that each chunk of the line law's list acts on.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/contact/line/list.hpp"
#include "sim/state/tiles.hpp"
#include "sim/threads/span.hpp"

namespace ropewalk {

class WrittenRanges {
 public:
  struct Written {
    int chunk = 0;
    BufferRange on;  // elements of the part, by their entries in the buffers of the chunk
  };

  void list(const TubeParts& parts, const std::vector<LineChunk>& chunks);

  // The ranges written in a part, in the order of the chunks.
  Span<Written> on(int part) const { return entries_of(part, begin_, written_); }
  // The blocks of parts that a chunk acts on, and how many chunks act on each.
  const std::vector<int>& blocks(std::size_t chunk) const { return blocks_[chunk]; }
  const std::vector<int>& chunks_on() const { return chunks_on_; }
  std::size_t bytes() const;

 private:
  std::vector<Written> written_;
  std::vector<int> begin_;
  std::vector<std::vector<int>> blocks_;
  std::vector<int> chunks_on_;
};

}  // namespace ropewalk
