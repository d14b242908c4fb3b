// The engine of any law that has none of its own: the plain form of every pair in the neighbour list. It costs one
// virtual call for each pair.
#pragma once

#include "sim/contact/shared/buffered_engine.hpp"

namespace ropewalk {

class PairEngine : public BufferedEngine {
 public:
  std::unique_ptr<ContactEngine> copy() const override { return std::make_unique<PairEngine>(*this); }

 protected:
  void add_chunk(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) override;
};

}  // namespace ropewalk
