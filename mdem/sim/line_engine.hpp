// Contact by the line law: tables, rows of nodes and buffers around the kernel (contact_line_kernel.cpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/contact_kernel.hpp"
#include "sim/line_list.hpp"
#include "sim/radial_table.hpp"

namespace ropewalk {

// Where all nodes are: in units of the list as integers, or in nm.
template <class C>
struct LineNodes {
  std::vector<C> x, y, z;
  double per_unit = 1;

  C coordinate(double v) const {
    if constexpr (sizeof(C) == 4) return static_cast<C>(std::lrint(v * per_unit));
    return static_cast<C>(v);
  }
};

// Forces on the nodes first .. of a chunk, eV/nm.
template <class T>
struct NodeForces {
  using Value = T;
  std::vector<T> x, y, z;
  int first = 0;

  void clear(int from, int to) {
    first = from;
    for (auto* v : {&x, &y, &z}) v->assign(static_cast<std::size_t>(to - from + NodeLayout::pad), T{0});
  }
};

// Of a run whose elements do not all take the same sum: shares and energies of the nodes, shares of the elements.
template <class T>
struct LineScratch {
  std::vector<T> sparse, dense, sparse_energy, dense_energy;
  std::vector<SparseWeight> share;
  std::vector<const LineRun*> even;  // runs of one element that take the sparse sum throughout

  void clear(std::size_t nodes) {
    for (auto* v : {&sparse, &dense, &sparse_energy, &dense_energy}) v->assign(nodes, T{0});
    share.clear();
  }
};

template <class Table_, class C>
struct LineKernelInput {
  using Table = Table_;
  using Coordinate = C;
  const Topology* topology;
  const Interaction* interaction;
  const State* state;
  const Vec3Array* axis;
  const LineList* list;
  const LineNodes<C>* nodes;
  const Table* tables;  // of tube types i, j at i * types + j
  const int* type;      // of each element
  double moved;         // nm: no distance has become smaller by more than this since the list was built
};

template <class Table_, class C_>
struct LineBuffers {
  using Table = Table_;
  using C = C_;
  using T = typename Table::Value;
  std::vector<Table> tables;
  double tables_unit = 0;
  LineNodes<C> nodes;
  std::vector<NodeForces<T>> forces;  // of each chunk, as are the next
  std::vector<LineScratch<T>> scratch;
};
using MixedBuffers = LineBuffers<MixedTable, std::int32_t>;
using FullBuffers = LineBuffers<FullTable, double>;

// The kernel: one chunk, with the widest vectors that the machine has. `out` takes energies and what acts on whole
// elements, `forces` what acts on the nodes of the neighbours.
void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const NeighbourList::Chunk& chunk,
                  LineScratch<float>& scratch, NodeForces<float>& forces, ContactBuffer& out);
void line_contact(const LineKernelInput<FullTable, double>& in, const NeighbourList::Chunk& chunk,
                  LineScratch<double>& scratch, NodeForces<double>& forces, ContactBuffer& out);
// Instruction sets of the kernel that this machine can run, best first; use_instructions limits the choice to one
// of them ("" lifts the limit) and returns false where there is none of that name. For tests and `bench`.
std::vector<std::string> instruction_sets();
bool use_instructions(const std::string& name);

// Viscous damping of the pairs of elements in the runs.
void line_damping(const Interaction& interaction, const State& state, const LineList& list,
                  const NeighbourList::Chunk& chunk, ContactBuffer& out);

class LineEngine {
 public:
  // Fills buffers[chunk], and the node forces that add_node_forces then takes.
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, ContactBuffer* buffers);
  // Of the nodes of one tube, onto its elements.
  void add_node_forces(const Topology& topology, const NeighbourList& list, const Vec3Array& axis, int tube,
                       Vec3Array& force, Vec3Array& torque) const;
  const LineList& list() const { return list_; }
  double list_seconds() const { return list_seconds_; }  // spent on it so far
  std::size_t bytes() const;

 private:
  template <class Buffers>
  void run(Buffers& b, const Topology& topology, const Interaction& interaction, const NeighbourList& list,
           const State& state, const Vec3Array& axis, ContactBuffer* buffers);
  template <class Buffers>
  void add(const Buffers& b, const Topology& topology, const NeighbourList& list, const Vec3Array& axis, int tube,
           Vec3Array& force, Vec3Array& torque) const;
  void describe(const Topology& topology, const Interaction& interaction, const NeighbourList& list);

  LineList list_;
  long stamp_ = 0;
  double list_seconds_ = 0;
  bool full_ = false;
  std::vector<int> type_;       // of each element
  std::vector<double> length_;  // of the elements of each type
  MixedBuffers mixed_;
  FullBuffers full_buffers_;
};

}  // namespace ropewalk
