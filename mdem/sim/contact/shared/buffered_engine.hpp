// The common part of engines that work through the chunks of the neighbour list and give each chunk a buffer of its
// own: work on pairs beside the contact, parallel work, and the sum of the buffers in the order of the chunks.
#pragma once

#include <vector>

#include "sim/contact/contact_engine.hpp"
#include "sim/contact/shared/buffer.hpp"

namespace ropewalk {

struct ContactInput {
  const Topology& topology;
  const Interaction& interaction;
  const NeighbourList& list;
  const State& state;
  const Vec3Array& axis;
};

class BufferedEngine : public ContactEngine {
 public:
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) override;
  void add_to(int part, const ForceRows& sums) const override;
  double energy() const override;
  std::size_t bytes() const override;
  double step_bytes(const NeighbourList& list, std::size_t number) const override;

 protected:
  // After every build of the list, and before every sum; by one thread.
  virtual void update_list(const ContactInput&) {}
  virtual void prepare(const ContactInput&) {}
  // Adds the pairs of a chunk to its buffer, whose first element is chunk.written_begin; always with their
  // energies.
  virtual void add_chunk(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) = 0;

 private:
  void list_pairs(const ContactInput& in, PairWork& pairs) const;

  const NeighbourList* list_ = nullptr;  // of the last sum, with its parts
  const TubeParts* parts_ = nullptr;
  std::vector<ContactBuffer<double>> buffers_;  // one buffer for each chunk
  long stamp_ = 0;
};

}  // namespace ropewalk
