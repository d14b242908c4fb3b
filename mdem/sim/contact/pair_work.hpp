// Work on pairs of elements beside the contact, in the loop of a contact engine and into its buffers: friction and
// viscosity of contacts (sim/forces/force_term.hpp). The engine that has a pair of elements at hand also has the
// memory at hand where forces on both are summed, without threads in each other's way.
#pragma once

#include <cstddef>
#include <functional>

#include "sim/contact/shared/buffer.hpp"

namespace ropewalk {

// Consecutive elements begin .. end - 1 of one tube that a chunk acts on; element j is entry j + shift of its
// buffer.
struct BufferRange {
  int begin = 0, end = 0, shift = 0;
};

// Element i and the elements from .. to - 1 of one tube that may come within reach of it. `own` has i, and i and
// the elements behind it are the chunk's up to `own_end`; `partners` has from .. to - 1.
struct NearElements {
  int i = 0;
  BufferRange own;
  int own_end = 0;
  int from = 0, to = 0;
  BufferRange partners;
};

// The pairs of a chunk, each once in all chunks, element by element in rising order.
class ChunkPairs {
 public:
  virtual ~ChunkPairs() = default;
  virtual int entries() const = 0;  // size of the chunk's buffer
  virtual void each(const std::function<void(const NearElements&)>& visit) const = 0;
};

// The buffer of a chunk, in single or in double precision.
struct PairBuffer {
  ContactBuffer<float>* floats = nullptr;
  ContactBuffer<double>* doubles = nullptr;

  PairBuffer(ContactBuffer<float>& buffer) : floats(&buffer) {}
  PairBuffer(ContactBuffer<double>& buffer) : doubles(&buffer) {}
  // Force in eV/nm, torque in eV about the element's centre.
  void add(int entry, const Vector3& force, const Vector3& torque) const {
    const ElementSum sum{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z(), 0};
    if (floats)
      sum.add_to(*floats, entry);
    else
      sum.add_to(*doubles, entry);
  }
};

// The work of an engine for all terms on pairs.
class PairWork {
 public:
  virtual ~PairWork() = default;
  virtual double reach() const = 0;  // distance of element centres, nm
  // After each build of the list: the number of chunks, then the pairs of each chunk that has any, by any thread.
  virtual void start(std::size_t chunks) = 0;
  virtual void list(std::size_t chunk, const ChunkPairs& pairs) = 0;
  // Adds the forces on the pairs of a chunk to its buffer; by any thread, once for each chunk.
  virtual void add(std::size_t chunk, const PairBuffer& buffer) = 0;
};

}  // namespace ropewalk
