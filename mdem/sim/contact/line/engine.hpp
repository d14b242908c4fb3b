// Contact by the line law: tables, buffers and parallel work around the kernel (kernel.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/contact/contact_engine.hpp"
#include "sim/contact/line/list.hpp"
#include "sim/contact/line/nodes.hpp"
#include "sim/contact/line/radial_table.hpp"
#include "sim/contact/line/written_ranges.hpp"
#include "sim/contact/shared/buffer.hpp"
#include "sim/threads/vector_unit.hpp"
#include "sim/threads/work_shares.hpp"

namespace ropewalk {

// The vectors of nodes that one element meets: each at `first` among the nodes of the chunk; its separations from
// the centre of the element, their squares, and twice their parts along its axis, in units of the list.
template <class T>
struct NodeVectors {
  static constexpr int arrays = 5;
  std::vector<int> first;
  int count = 0;

  // Makes room for `vectors` vectors of the widest kind.
  void reserve(int vectors) {
    set_size(first, static_cast<std::size_t>(vectors * node_padding));
    set_size(data_, static_cast<std::size_t>((vectors + 1) * node_padding * arrays));
    const auto address = reinterpret_cast<std::uintptr_t>(data_.data());
    begin_ = data_.data() + (alignment - address % alignment) % alignment / sizeof(T);
  }
  T* add(int node, int lanes) {
    first[static_cast<std::size_t>(count)] = node;
    return begin_ + arrays * lanes * count++;
  }
  const T* at(int vector, int lanes) const { return begin_ + arrays * lanes * vector; }
  std::size_t bytes() const { return data_.capacity() * sizeof(T) + first.capacity() * sizeof(int); }

 private:
  static constexpr std::size_t alignment = 64;
  std::vector<T> data_;
  T* begin_ = nullptr;
};

// The work space of one thread.
template <class T>
struct LineWork {
  NodeForces<T> forces;
  NodeVectors<T> found;
};

// Tables of the kernel for a pair of tube types, in units of the list.
template <class Table>
struct PairTables {
  using T = typename Table::Value;
  Table table;
  std::vector<T> s;                 // places of the nodes of i, from its centre
  T half = 0;                       // place of the last one
  T weight = 0, energy_weight = 0;  // weights of two nodes: times du/dy and a separation, eV/nm; times u, eV
  T far2 = static_cast<T>(1e30);    // a squared separation out of reach of all nodes

  PairTables(const LineContact& law, double unit) : table(law.density, unit) {
    energy_weight = static_cast<T>(law.length_i / law.nodes_i * law.length_j / law.nodes_j);
    weight = table.force * energy_weight;
    for (int k = 0; k < law.nodes_i; ++k)
      s.push_back(static_cast<T>(line_node(k, law.nodes_i, law.length_i) / unit));
    half = s.back();
  }
};

template <class Table_, class C>
struct LineKernelInput {
  using Table = Table_;
  using Coordinate = C;
  const Topology* topology;
  const State* state;
  const Vec3Array* axis;
  const LineList* list;
  const NodePositions<C>* nodes;
  const PairTables<Table>* pairs;  // tables of tube types i, j at i * types + j
  double unit, per_unit;           // nm, and its inverse
  double moved;                    // upper bound (nm) on how much any distance has shrunk since the list was built
  bool energies;                   // whether they are wanted
};

template <class Table_, class C_>
struct LineBuffers {
  using Table = Table_;
  using C = C_;
  using T = typename Table::Value;
  std::vector<PairTables<Table>> pairs;
  double unit = 0;  // unit of the tables, nm
  // One for each thread, for the chunk that it works on.
  std::vector<NodePositions<C>> nodes;
  std::vector<LineWork<T>> work;
  std::vector<ContactBuffer<T>> of_chunks;
};
using MixedBuffers = LineBuffers<MixedTable, std::int32_t>;
using FullBuffers = LineBuffers<FullTable, double>;

// The kernel: one chunk, with the widest vectors that the machine has. `out` takes energies and the forces on the
// chunk's own elements, `work` the forces on the nodes of their neighbours.
void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer<float>& out);
void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer<double>& out);

class LineEngine : public ContactEngine {
 public:
  std::unique_ptr<ContactEngine> copy() const override { return std::make_unique<LineEngine>(*this); }
  // Elements from which on a block is finished as soon as it can be, while the forces on it are in the cache of a
  // thread, and not in the end.
  std::size_t finish_at_once_from = large_scene;

  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes) override;
  void add_to(int part, const ForceRows& sums) const override;
  double energy() const override;
  double best_skin(const Topology& topology, double listed, long steps) const override {
    return list_.best_skin(topology, listed, steps);
  }
  PairEnergy pair_energy(const ContactLaw& law) const override;
  const LineList& list() const { return list_; }
  std::size_t bytes() const override;
  double step_bytes(const NeighbourList& list, std::size_t number) const override;

 private:
  template <class Buffers>
  using KernelInput = LineKernelInput<typename Buffers::Table, typename Buffers::C>;
  void update_list(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                   const TubeWork& tubes);
  template <class Buffers>
  void compute_all(Buffers& b, const Topology& topology, const NeighbourList& list, const State& state,
                   const Vec3Array& axis, bool energies, const TubeWork& tubes);
  template <class Buffers>
  void compute_chunk(std::size_t chunk, std::size_t thread, PairWork* pairs, Buffers& b, KernelInput<Buffers> in);
  // Calls `of` with the buffers in use.
  template <class Of>
  auto in_use(const Of& of) const {
    return full_ ? of(full_buffers_) : of(mixed_);
  }

  LineList list_;
  long stamp_ = 0;
  bool full_ = false;
  std::vector<NodeOffsets> offsets_;  // offsets of each tube type
  WorkShares shares_;
  WrittenRanges written_;
  Countdowns left_;  // chunks that have yet to act on each block
  MixedBuffers mixed_;
  FullBuffers full_buffers_;
};

}  // namespace ropewalk
