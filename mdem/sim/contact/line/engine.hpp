// Contact by the line law: tables, rows of nodes and buffers around the kernel (contact_line_kernel.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "model/segments.hpp"
#include "sim/contact/line/nodes.hpp"
#include "sim/contact/line/plan.hpp"
#include "sim/contact/line/radial_table.hpp"
#include "sim/contact/line/written_ranges.hpp"
#include "sim/contact/shared/buffer.hpp"
#include "sim/state/force_rows.hpp"
#include "sim/state/tiles.hpp"
#include "sim/threads/work_shares.hpp"

namespace ropewalk {

// Those that are met with one sum.
struct MetRows {
  std::vector<NodeRow> row;  // as many as there can be
  int count = 0;

  void add(const NodeRow& r) { row[static_cast<std::size_t>(count++)] = r; }
  // Nodes of a run. Field by field: put together and then copied, the copy waits for what was just stored.
  void add(const LineRun& run, int at, int nodes) {
    NodeRow& r = row[static_cast<std::size_t>(count++)];
    r.at = at;
    r.count = static_cast<short>(nodes);
    r.type = run.type;
    r.part = run.part;
  }
  const NodeRow* begin() const { return row.data(); }
  const NodeRow* end() const { return row.data() + count; }
};

// A run whose elements may take several sums: those that may be within reach, as bits, by the sum that they take;
// `shared`: it and the next.
struct SplitRun {
  const LineRun* run = nullptr;
  std::uint64_t sum[line_sums] = {}, shared[SparseNodes::most] = {};
  static_assert(LineRun::longest <= 64);
};
struct SplitRuns {
  std::vector<SplitRun> run;  // as many as there can be
  int count = 0;

  void add(const LineRun& r) { run[static_cast<std::size_t>(count++)].run = &r; }
};

// Pairs of elements that are summed one by one, a pair in each lane: all of the same types, ends and sums.
template <class T>
struct PairBatch {
  static constexpr int most = 16;  // lanes of the widest vectors
  PairKind kind;
  int count = 0;
  int i[most] = {}, j[most] = {}, at_i[most] = {}, at_j[most] = {};  // elements, and their entries in the buffer
  alignas(64) T share[most] = {}, derivative[most] = {};             // of the first sum; by the cosine of the angle
  alignas(64) T apart[3][most] = {}, axis_i[3][most] = {}, axis_j[3][most] = {};  // in units of the list
};

// For a chunk.
template <class T>
struct LineWork {
  NodeForces<T> forces[row_kinds];
  MetRows shared;             // by both elements of a block, with the first sum
  MetRows met[2][line_sums];  // by one of them
  SplitRuns split[2];         // likewise, to be met
  ChunkPlan* plan = nullptr;  // of the chunk, where there is one
  std::vector<PairBatch<T>> batches;
  DampedElements damped;  // in floats alone

  PairBatch<T>& batch(const PairKind& kind) {
    for (auto& b : batches)
      if (b.kind == kind) return b;
    batches.emplace_back();
    batches.back().kind = kind;
    return batches.back();
  }

  // For any chunk of the list.
  void make_room(const LineList& list) {
    for (int kind = 0; kind < row_kinds; ++kind) forces[kind].make_room(list.most_nodes(static_cast<Rows>(kind)));
    const auto most = static_cast<std::size_t>(list.most_rows());
    shared.row.resize(2 * most);
    for (auto& of_one : met)
      for (MetRows& rows : of_one) rows.row.resize(most);
    for (SplitRuns& runs : split) runs.run.resize(most);
    if (sizeof(T) < sizeof(double)) damped.make_room(list.most_elements());
  }
  void start(const LineChunk& chunk, ChunkPlan* of) {
    for (auto& f : forces) f.start(chunk.parts.size());
    batches.clear();  // their order belongs to the state alone: a resumed run has no older ones
    plan = of;
  }
};

// The pairs of nodes of two elements: places on i and on j (nm) and weight (nm^2).
template <class T>
struct NodePairs {
  std::vector<T> i, j, weight;

  template <class Share>
  void add(const LineContact& law, int on_i, int on_j, Share share) {
    for (int k = 0; k < on_i; ++k)
      for (int l = 0; l < on_j; ++l) {
        const double part = share(k, l);
        if (part == 0) continue;
        i.push_back(static_cast<T>(line_node(k, on_i, law.length_i)));
        j.push_back(static_cast<T>(line_node(l, on_j, law.length_j)));
        weight.push_back(static_cast<T>(part * law.length_i / on_i * law.length_j / on_j));
      }
  }
};

// Whether nodes of two elements may be within the cutoff, by least_squared_distance of the segments between their
// first and last nodes.
struct ElementReach {
  // As it takes them (nm), for the nodes of each sum and of those before it; and where tubes end, for all nodes.
  double ahead[2][line_sums] = {}, beside[2][line_sums] = {};
  double cutoff2 = 0;  // nm^2

  explicit ElementReach(const LineContact& k) {
    const auto half = [](double length, int nodes) { return line_node(nodes - 1, nodes, length); };
    double half_i = 0, half_j = 0;
    for (int t = 0; t < line_sums; ++t) {
      half_i = std::max(half_i, half(k.length_i, k.sum_nodes_i(t)));
      half_j = std::max(half_j, half(k.length_j, k.sum_nodes_j(t)));
      ahead[0][t] = half_i + half_j;
      beside[0][t] = 2 * half_j;
      ahead[1][t] = half(k.length_i, k.nodes_i) + half(k.length_j, k.nodes_j);
      beside[1][t] = 2 * half(k.length_j, k.nodes_j);
    }
    cutoff2 = k.density.cutoff() * k.density.cutoff();
  }
  // For the nodes of sum t; `ended`: a tube begins or ends at one of the elements.
  bool near(int t, bool ended, const Vector3& d, const Vector3& n_i, const Vector3& n_j) const {
    return least_squared_distance(d, n_i, n_j, ahead[ended ? 1 : 0][t], beside[ended ? 1 : 0][t]) < cutoff2;
  }
};

// Between which angles elements share two sums, as squared cosines, and how far they reach: with room for as many
// rad and nm, within which an element that is not between them stays where it is.
struct SumLimits {
  double from_cos2[SparseNodes::most] = {}, full_cos2[SparseNodes::most] = {};
  double cutoff2 = 0;  // nm^2

  SumLimits(const LineContact& k, double turn_room, double motion_room) {
    const auto turned = [](double cos2, double by) {
      constexpr double right_angle = 1.57079632679489662;
      const double angle = std::acos(std::sqrt(std::min(cos2, 1.0))) + by;
      return angle < 0 ? 2 : angle > right_angle ? -1 : std::cos(angle) * std::cos(angle);
    };
    for (int t = 0; t < k.sparse.count; ++t) {
      const SparseSum& sum = k.sparse.sum[static_cast<std::size_t>(t)];
      from_cos2[t] = turn_room > 0 ? turned(sum.from_cos2, turn_room) : sum.from_cos2;
      full_cos2[t] = turn_room > 0 ? turned(sum.full_cos2, -turn_room) : sum.full_cos2;
    }
    const double reach = k.density.cutoff() + motion_room;
    cutoff2 = reach * reach;
  }
};

// What two elements sum over (LineContact).
template <class T>
struct PairSum {
  // One of its sums: by rows, with the places of i's nodes (nm) and the weight of a pair (nm^2); pair by pair, by
  // the ends of i and of j.
  struct Sum {
    std::vector<double> places;
    double weight = 0;
    NodePairs<T> pairs[4][4];
  };
  Sum sums[line_sums];
  ElementReach reach;
  SumLimits limits[2];  // of this state alone, for as long as a plan holds

  static int index(const TubeEnds& e) { return (e.begins ? 1 : 0) + (e.ends ? 2 : 0); }
  const NodePairs<T>& pairs(int sum, const TubeEnds& ends_i, const TubeEnds& ends_j) const {
    return sums[sum].pairs[index(ends_i)][index(ends_j)];
  }
  explicit PairSum(LineContact law)
      : reach(law), limits{{law, 0, 0}, {law, LinePlan::turn_room, LinePlan::motion_room}} {
    for (int t = 0; t <= law.sparse.count; ++t) {
      const int on_i = law.sum_nodes_i(t), on_j = law.sum_nodes_j(t);
      Sum& sum = sums[t];
      sum.weight = law.length_i / on_i * law.length_j / on_j;
      for (int k = 0; k < on_i; ++k) sum.places.push_back(line_node(k, on_i, law.length_i));
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) {
          law.ends_i = {(a & 1) != 0, (a & 2) != 0};
          law.ends_j = {(b & 1) != 0, (b & 2) != 0};
          NodePairs<T>& nodes = sum.pairs[a][b];
          nodes.add(law, on_i, on_j, [&](int k, int l) { return law.ramp(t, k, on_i, l, on_j); });
          const int left_i = law.end_nodes_i(t), left_j = law.end_nodes_j(t);
          if (law.fades(t))
            nodes.add(law, left_i, left_j, [&](int k, int l) { return 1 - law.ramp(t, k, left_i, l, left_j); });
        }
    }
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
  Rows rows[line_sums];  // that the sums take, whatever the types
  // No axis has changed by more than `turned` since the list was built, and no distance (nm) has become smaller by
  // more than `moved`: nor will they while the plan holds.
  double turned, moved;
  LinePlan::Use plan;
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
  // Rows, and forces on them, of the chunk that each thread is at.
  std::vector<std::array<LineNodes<C>, row_kinds>> nodes;
  std::vector<LineWork<T>> work;
  std::vector<ContactBuffer<T>> of_chunks;
};
using MixedBuffers = LineBuffers<MixedTable, std::int32_t>;
using FullBuffers = LineBuffers<FullTable, double>;

// The kernel: one chunk, with the widest vectors that the machine has. `out` takes energies and what acts on whole
// elements, `work` what acts on the nodes of the neighbours.
void line_contact(const LineKernelInput<MixedTable, std::int32_t>& in, const LineChunk& chunk,
                  LineWork<float>& work, ContactBuffer<float>& out);
void line_contact(const LineKernelInput<FullTable, double>& in, const LineChunk& chunk, LineWork<double>& work,
                  ContactBuffer<double>& out);
// Instruction sets of the kernel that this machine can run, best first; use_instructions limits the choice to one
// of them ("" lifts the limit) and returns false where there is none of that name. For tests and `bench`.
std::vector<std::string> instruction_sets();
bool use_instructions(const std::string& name);

// What tubes need besides the contact: `place` the axes of each tube and what else is needed of it as it is, before
// any node or block (which `finish` may move), and `finish` each block of elements once nothing acts on it any
// more, nor needs to know where it is; in large scenes at once, when what acted on it is still in the cache of a
// thread. Each once, by any thread.
struct TubeWork {
  const TubeParts& parts;
  std::function<void(int)> place, finish;
};

class LineEngine {
 public:
  // Elements from which on a block is finished as soon as it can be, not in the end.
  std::size_t finish_at_once_from = large_scene;

  // The contact of all chunks; `finish` then calls add_to. Energies only if wanted: forces are the same bits.
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes);
  // Adds what acts on a part of a tube, in the order of the chunks, whoever was done first.
  void add_to(int part, const ForceRows& sums) const;
  const LinePlan& plan() const { return plan_; }
  // Goes on with this plan.
  void resume(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
              LinePlan::Saved plan);
  double energy() const;         // eV
  double damping_power() const;  // eV/ps
  const LineList& list() const { return list_; }
  double list_seconds() const { return list_seconds_; }      // spent on it so far
  double finish_seconds() const { return finish_seconds_; }  // by the first thread, in `finish`
  std::size_t bytes() const;

 private:
  template <class Buffers>
  void run(Buffers& b, const Topology& topology, const Interaction& interaction, const NeighbourList& list,
           const State& state, const Vec3Array& axis, bool energies, const TubeWork& tubes);
  template <class Buffers>
  using KernelInput = LineKernelInput<typename Buffers::Table, typename Buffers::C>;
  template <class Buffers>
  void make_room(Buffers& b, std::size_t threads) const;
  template <class Buffers>
  void meet(std::size_t chunk, std::size_t thread, Buffers& b, KernelInput<Buffers> in);
  void describe(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                const TubeParts& parts);
  // What `of` makes of the buffers in use.
  template <class Of>
  auto in_use(const Of& of) const {
    return full_ ? of(full_buffers_) : of(mixed_);
  }

  LineList list_;
  long stamp_ = 0;
  double moved_ = 0;  // nm, of the last forces, as in their input
  double list_seconds_ = 0, finish_seconds_ = 0;
  bool full_ = false;
  LinePlan plan_;
  std::vector<NodePlaces> places_[row_kinds];  // of each tube type
  WorkShares shares_;
  LineTouches touches_;
  Countdowns left_;  // chunks that have yet to act on each block
  MixedBuffers mixed_;
  FullBuffers full_buffers_;
};

}  // namespace ropewalk
