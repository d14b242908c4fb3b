// Contact by the line law: tables, rows of nodes and buffers around the kernel (contact_line_kernel.cpp).
#pragma once

#include <algorithm>
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

// Forces on the nodes that a chunk acts on, eV/nm: those of its touched tubes one after another.
template <class T>
struct NodeForces {
  using Value = T;
  std::vector<T> x, y, z;
  std::vector<char> used;  // of the touched tubes; the forces on the others are not even cleared

  void start(int nodes, std::size_t tubes) {
    for (auto* v : {&x, &y, &z}) v->resize(static_cast<std::size_t>(nodes + NodeLayout::pad));
    used.assign(tubes, 0);
  }
  void use(const TouchedTube& t, Rows kind, int index) {
    char& done = used[static_cast<std::size_t>(index)];
    if (done) return;
    done = 1;
    const TouchedTube::Row& row = t.row[static_cast<int>(kind)];
    const auto from = row.origin + t.begin * row.per_element + row.shift;
    for (auto* v : {&x, &y, &z}) std::fill_n(v->begin() + from, (t.end - t.begin) * row.per_element, T{0});
  }
};

// Of a chunk.
template <class T>
struct LineWork {
  NodeForces<T> forces[row_kinds];
  std::vector<const LineRun*> even;  // runs of one element that take the sparse sum throughout
  // Of a run whose elements do not all take the same sum: shares of the elements, shares and energies of the nodes.
  std::vector<SparseWeight> share;
  std::vector<T> weight[row_kinds], energy[row_kinds];

  void start(const LineChunk& chunk) {
    for (int kind = 0; kind < row_kinds; ++kind) forces[kind].start(chunk.nodes[kind], chunk.touched.size());
  }
};

// The pairs of nodes of two elements in lanes: places on i and on j (nm) and weight (nm^2).
template <class T>
struct PairLanes {
  std::vector<T> i, j, weight;  // up to a multiple of 16 with weight 0

  template <class Share>
  void add(const LineContact& law, int on_i, int on_j, Share share) {
    for (int k = 0; k < on_i; ++k)
      for (int l = 0; l < on_j; ++l) {
        i.push_back(static_cast<T>(line_node(k, on_i, law.length_i)));
        j.push_back(static_cast<T>(line_node(l, on_j, law.length_j)));
        weight.push_back(static_cast<T>(share(k, l) * law.length_i / on_i * law.length_j / on_j));
      }
  }
  void fill_up() {
    for (auto* v : {&i, &j, &weight}) v->resize((v->size() + 15) / 16 * 16, T{0});
  }
};

// What two elements sum over (LineContact), for the ends of tubes too.
template <class T>
struct PairSum {
  PairLanes<T> all;         // at large angles
  PairLanes<T> near[4][4];  // at small ones, by the ends of i and of j
  // Rows: places of i's nodes (nm) and the weight of a pair (nm^2), of each kind.
  std::vector<double> places[row_kinds];
  double weight[row_kinds] = {0, 0};

  static int index(const TubeEnds& e) { return (e.begins ? 1 : 0) + (e.ends ? 2 : 0); }
  explicit PairSum(LineContact law) {
    all.add(law, law.nodes_i, law.nodes_j, [](int, int) { return 1.0; });
    all.fill_up();
    describe_rows(Rows::all, law, law.nodes_i, law.nodes_j);
    if (law.sparse.none()) return;
    describe_rows(Rows::sparse, law, law.sparse.i, law.sparse.j);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        law.ends_i = {(a & 1) != 0, (a & 2) != 0};
        law.ends_j = {(b & 1) != 0, (b & 2) != 0};
        const auto faded = [&](int on_i, int on_j) {
          return [&law, on_i, on_j](int k, int l) {
            return end_ramp(k, on_i, law.ends_i) * end_ramp(l, on_j, law.ends_j);
          };
        };
        PairLanes<T>& lanes = near[a][b];
        lanes.add(law, law.sparse.i, law.sparse.j, faded(law.sparse.i, law.sparse.j));
        const int on_i = law.near_end_nodes_i(), on_j = law.near_end_nodes_j();
        const auto ramp = faded(on_i, on_j);
        if (a != 0 || b != 0) lanes.add(law, on_i, on_j, [&](int k, int l) { return 1 - ramp(k, l); });
        lanes.fill_up();
      }
  }

 private:
  void describe_rows(Rows kind, const LineContact& law, int on_i, int on_j) {
    const int at = static_cast<int>(kind);
    weight[at] = law.length_i / on_i * law.length_j / on_j;
    for (int k = 0; k < on_i; ++k) places[at].push_back(line_node(k, on_i, law.length_i));
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
  const LineNodes<C>* nodes;  // of each kind of rows
  const Table* tables;        // of tube types i, j at i * types + j, as are the next
  const PairSum<typename Table::Value>* pairs;
  double turned;  // no axis has changed by more
  double moved;   // nm: no distance has become smaller by more than this since the list was built
  bool energies;  // whether they are wanted
};

template <class Table_, class C_>
struct LineBuffers {
  using Table = Table_;
  using C = C_;
  using T = typename Table::Value;
  std::vector<Table> tables;
  std::vector<PairSum<T>> pairs;
  double tables_unit = 0;
  LineNodes<C> nodes[row_kinds];
  std::vector<LineWork<T>> work;  // of each chunk
};
using MixedBuffers = LineBuffers<MixedTable, std::int32_t>;
using FullBuffers = LineBuffers<FullTable, double>;

// The kernel: one chunk, with the widest vectors that the machine has. `out` takes energies and what acts on whole
// elements, `work` what acts on the nodes of the neighbours.
void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer& out);
void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer& out);
// Instruction sets of the kernel that this machine can run, best first; use_instructions limits the choice to one
// of them ("" lifts the limit) and returns false where there is none of that name. For tests and `bench`.
std::vector<std::string> instruction_sets();
bool use_instructions(const std::string& name);

// Viscous damping of the pairs of elements in the runs.
void line_damping(const Interaction& interaction, const State& state, const LineList& list, const LineChunk& chunk,
                  ContactBuffer& out);

class LineEngine {
 public:
  // The contact of all chunks; add_to_tube then collects it. Energies only if wanted: forces are the same bits.
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, bool energies);
  // Adds what acts on the elements of one tube.
  void add_to_tube(const Topology& topology, const Vec3Array& axis, int tube, Vec3Array& force,
                   Vec3Array& torque) const;
  double energy() const;         // eV
  double damping_power() const;  // eV/ps
  const LineList& list() const { return list_; }
  double list_seconds() const { return list_seconds_; }  // spent on it so far
  std::size_t bytes() const;

 private:
  template <class Buffers>
  void run(Buffers& b, const Topology& topology, const Interaction& interaction, const NeighbourList& list,
           const State& state, const Vec3Array& axis, bool energies);
  template <class Buffers>
  void add_nodes(const Buffers& b, const Topology& topology, const Vec3Array& axis, int tube, Vec3Array& force,
                 Vec3Array& torque) const;
  void describe(const Topology& topology, const Interaction& interaction, const NeighbourList& list);

  LineList list_;
  long stamp_ = 0;
  double list_seconds_ = 0;
  bool full_ = false;
  std::vector<double> length_;          // of the elements of each type
  std::vector<ContactBuffer> buffers_;  // of each chunk
  MixedBuffers mixed_;
  FullBuffers full_buffers_;
};

}  // namespace ropewalk
