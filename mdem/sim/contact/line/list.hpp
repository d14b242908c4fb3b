// What the line law's kernel runs over: rows of nodes along the tubes, and for every element the runs of
// consecutive nodes of other tubes within its reach. No index per pair, no gather.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/contact/shared/damping.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/tiles.hpp"

namespace ropewalk {

// Two kinds of rows: with all nodes of the elements, and with the few that stand for j at the smallest angles.
enum class Rows { all = 0, sparse = 1 };
inline constexpr int row_kinds = 2;

// Whether what was out of reach by so much (nm) may have come within it, as no distance has become smaller by more
// than `moved`.
inline bool may_be_in_reach(float beyond, double moved) { return static_cast<double>(beyond) <= moved; }

// Neighbours of one element on one other tube, or on another part of its own. Most of a list's memory, so kept to
// 36 bytes.
struct LineRun {
  static constexpr int longest = 64;  // elements: the kernel has a bit for each

  struct Nodes {
    short from = 0, count = 0;  // within reach; the first one counted from the first node of element_begin
  };
  int element_begin = 0;
  int part = 0;         // which of those that the chunk acts on
  float beyond = 0;     // nm: by so much the nearest node was out of reach at the build
  float even = -1;      // rad: so long as no axis of the scene has turned by more, the first sum holds throughout
  float crossing = -1;  // rad: likewise the last sum, over all nodes
  Nodes nodes[row_kinds];
  short type = 0;                           // tube type
  std::int8_t elements = 0;                 // with nodes within reach
  std::int8_t damped_from = 0, damped = 0;  // elements within reach of the contact viscosity, from element_begin
  bool begins = false, ends = false;        // the element is the first, the last of its tube, and the only one here
  bool fading = false;                      // the first sum fades, here or at element i: its tube ends

  const Nodes& of(Rows kind) const { return nodes[static_cast<int>(kind)]; }
  TubeEnds tube_ends() const { return {begins, ends}; }
};
static_assert(sizeof(LineRun) == 36 && LineRun::longest <= INT8_MAX);

// Consecutive nodes of another tube, from `at` on in the chunk's rows.
struct NodeRow {
  // Nodes behind the last one of a chunk that are read with it.
  static constexpr int pad = 16;

  int at = 0;
  short count = 0, type = 0;  // tube type
  int part = 0;               // as of the run
};

// What the elements of a block meet on one other tube: the run of one of them, or the runs of both in one row,
// whose nodes out of an element's own reach do nothing to it.
struct BlockRun {
  static constexpr int none = -1;
  static constexpr int both = 2;

  NodeRow row;                // for the first sum
  float beyond = 0;           // nm, as of the runs
  float even = -1;            // rad, likewise; until then the row stands for the runs
  int run[2] = {none, none};  // of the first element and of the second
  int of = both;              // who may meet the row: the first element, the second, both
};

struct ElementRun {
  int element = 0, at = 0, run = 0;  // its entry in the chunk's buffers; the run as LineList has it
};

// Pairs of elements that are alike: of the same types, ends and sums.
struct PairKind {
  int types = 0, sum = 0;  // of the pair: i * types + j; of nodes
  TubeEnds ends_i, ends_j;
  bool shared = false;  // with the next sum

  bool operator==(const PairKind& o) const {
    return types == o.types && sum == o.sum && shared == o.shared && ends_i == o.ends_i && ends_j == o.ends_j;
  }
};

struct AlikePairs {
  struct Pair {
    int i = 0, j = 0, at_i = 0, at_j = 0;  // elements, and their entries in the buffers of the chunk
    float beyond = 0;                      // nm, of their run
  };
  PairKind kind;
  std::vector<Pair> pairs;
};

// Those of a kind, perhaps none yet.
inline AlikePairs& of_kind(const PairKind& kind, std::vector<AlikePairs>& all) {
  for (AlikePairs& of : all)
    if (of.kind == kind) return of;
  all.push_back({kind, {}});
  return all.back();
}

// An element, or two consecutive ones within a tube: neighbours of one are most often neighbours of the other.
struct LineBlock {
  int first = 0, at = 0, elements = 1;  // the first one's entry in the chunk's buffers, the others' follow
  int begin = 0, end = 0;               // its runs in those of the chunk
};

// Whether a sum that some of the run takes fades at the ends of tubes.
inline bool fades(const SparseNodes& sparse, int first, const TubeEnds& ends_i, const LineRun& run) {
  return first < sparse.count && (run.begins || run.ends || (sparse.thins_j(first) && ends_i.any()));
}

// Consecutive elements begin .. end of a tube that a chunk acts on, and where these are in the chunk's own buffers.
struct TouchedPart {
  int tube = 0, begin = 0, end = 0;
  int element_shift = 0;  // element j is entry j + element_shift
  TouchedRange elements() const { return {begin, end, element_shift}; }
  // In the chunk's rows of nodes. None per element: no run meets them.
  struct Row {
    int origin = 0, per_element = 0;  // the first node of element j is node origin + j per_element
    int first(int element) const { return origin + element * per_element; }
  } row[row_kinds];
  // nm: until distances have become smaller by so much nothing acts on it.
  float beyond = 0;
  // The first node within reach of a run on it.
  int first_node(const LineRun& run, Rows kind) const {
    return row[static_cast<int>(kind)].first(run.element_begin) + run.of(kind).from;
  }
};

// Some elements and all that they act on.
struct LineChunk {
  std::vector<Segment> own;        // in the order of their elements
  std::vector<TouchedPart> parts;  // in the order of their elements
  std::vector<LineBlock> blocks;
  std::vector<BlockRun> runs;
  // The runs at the ends of tubes, of the elements in their order, and their pairs, by rising `beyond`, so long as
  // they take the first sum alone; `even` of all of them.
  std::vector<ElementRun> end_runs;
  std::vector<AlikePairs> end_pairs;
  float even = 0;
  std::vector<DampedBlock> damped;
  std::vector<TouchedRange> damped_parts;       // those that have any
  int elements = 0, nodes[row_kinds] = {0, 0};  // sizes of the buffers
  int most_rows = 0;                            // that an element can meet: one for each element of its runs
};

// Finds the parts that elements of a chunk are in, asked for in rising order.
class PartOf {
 public:
  explicit PartOf(const LineChunk& chunk) : part_(chunk.parts.data()) {}
  const TouchedPart& operator()(int element) {
    while (part_->end <= element) ++part_;
    return *part_;
  }

 private:
  const TouchedPart* part_;
};

class LineList {
 public:
  // From the pairs of the list and the places that it was built at. Throws std::invalid_argument where a tube
  // type has other numbers of nodes towards different partners.
  void build(const Topology& topology, const Interaction& interaction, const NeighbourList& list);

  // Of an element of a tube in its rows; with all nodes these are there only where the build found tubes that are
  // not nearly parallel.
  int nodes(Rows kind, int tube, int type) const {
    if (kind == Rows::all && !dense_[static_cast<std::size_t>(tube)]) return 0;
    return per_element(kind, type);
  }
  int per_element(Rows kind, int type) const {
    return per_element_[static_cast<int>(kind)][static_cast<std::size_t>(type)];
  }
  const LineRun* begin(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i)]; }
  const LineRun* end(int i) const { return run_.data() + begin_[static_cast<std::size_t>(i) + 1]; }
  const LineRun& run(int k) const { return run_[static_cast<std::size_t>(k)]; }
  int index(const LineRun& run) const { return static_cast<int>(&run - run_.data()); }
  const std::vector<LineChunk>& chunks() const { return chunks_; }
  // Of any chunk, at most: nodes in its rows, rows that one of its elements can meet, entries of its buffers.
  int most_nodes(Rows kind) const { return most_nodes_[static_cast<int>(kind)]; }
  int most_rows() const { return most_rows_; }
  int most_elements() const { return most_elements_; }
  std::size_t runs() const { return run_.size(); }
  // Those whose elements may take several sums from the start.
  std::size_t split_runs() const { return split_runs_; }
  // The skin (nm) whose lists would have cost least, building included, where this one of `listed` was worn after
  // so many steps. It follows from what is in the list and not from a clock: the same run has the same lists.
  double best_skin(const Topology& topology, double listed, long steps) const;
  // A power of two (nm) that resolves every coordinate in 29 bits.
  double unit() const { return unit_; }
  std::size_t bytes() const;

 private:
  struct Part;
  double cost(const Topology& topology, int i, int tube) const;
  void cut_into_chunks(const Topology& topology, const Vec3Array& position, std::size_t count);
  template <class Work>
  void for_runs_of(const LineChunk& chunk, const Work& work);
  void find_parts(const Topology& topology, LineChunk& chunk);
  void place_parts(const Topology& topology, LineChunk& chunk) const;
  void count_rows(LineChunk& chunk) const;
  void make_blocks(const Topology& topology, const Interaction& interaction, LineChunk& chunk) const;
  void add_end_run(const Topology& topology, int i, const TouchedPart& own, const LineRun& run,
                   LineChunk& chunk) const;
  void add_block(const LineBlock& of, int tube, Rows kind, LineChunk& chunk) const;
  void list_damped(LineChunk& chunk) const;

  std::vector<int> per_element_[row_kinds];  // of each tube type
  std::vector<char> dense_;                  // of each tube: whether it has rows of all nodes
  std::vector<LineRun> run_;
  std::vector<std::size_t> begin_;
  std::size_t split_runs_ = 0;
  std::vector<LineChunk> chunks_;
  int most_nodes_[row_kinds] = {0, 0}, most_rows_ = 0, most_elements_ = 0;
  double unit_ = 1;
};

}  // namespace ropewalk
