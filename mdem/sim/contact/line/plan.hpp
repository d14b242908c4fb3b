// What elements meet whose runs take several sums: chosen once, with room for some motion, and used for as many
// steps as keep within it. Neighbours in a twisted rope cross at angles where one sum goes over into the next, and
// these angles hardly change from step to step.
#pragma once

#include <array>
#include <vector>

#include "model/contact/line.hpp"
#include "sim/contact/line/list.hpp"
#include "sim/neighbours/motion_since.hpp"
#include "sim/neighbours/neighbours.hpp"

namespace ropewalk {

// The sparse ones, and that over all nodes.
inline constexpr int line_sums = SparseNodes::most + 1;

// Of a chunk, in the order in which the kernel comes to its elements.
struct ChunkPlan {
  using Element = std::array<short, line_sums>;  // rows of each sum

  std::vector<Element> elements;  // those with such runs
  std::vector<NodeRow> rows;
  std::vector<AlikePairs> pairs;     // summed one by one; shares of two sums are found in every step
  std::size_t element = 0, row = 0;  // up to where the kernel has come

  void rewind() { element = row = 0; }
  // Once it has all of them, for as long as it holds.
  void shrink() {
    elements.shrink_to_fit();
    rows.shrink_to_fit();
    for (AlikePairs& of : pairs) of.pairs.shrink_to_fit();
  }
  void clear() {
    elements.clear();
    rows.clear();
    pairs.clear();
    rewind();
  }
};

class LinePlan {
 public:
  // A plan holds until an angle may have changed by twice `turn` (rad) or a distance by twice `motion` (nm). Until
  // then elements within `turn_room` of where a sum begins to be shared are summed one by one, and what is up to
  // `motion_room` beyond the cutoff is summed in vain.
  static constexpr double turn = 0.0015, motion = 0.02;
  static constexpr double turn_room = 2.02 * turn, motion_room = 2 * motion;
  // Runs for an element that take several sums from which on it pays to look for how far everything has come.
  static constexpr double worth = 0.25;

  enum class Use { none, record, replay };

  // Before the forces of a state: its list, and the runs of it.
  void start(const Topology& topology, const NeighbourList& list, const LineList& runs);
  // Whether enough runs take several sums: if not, the axes need not be there to choose.
  bool wanted() const { return wanted_; }
  // How far a tube has come since the plan was made: of each one, by any thread.
  void look(const Topology& topology, const State& state, int tube);
  // What to do with the forces of this state, whose axes these are: a new plan is made while they are computed.
  void choose(const State& state, const Vec3Array& axis);
  Use use() const { return use_; }
  // As LineKernelInput has them, for as long as the plan holds.
  double turned() const { return turned_; }
  double moved() const { return moved_; }
  ChunkPlan* chunk(std::size_t k) { return use_ == Use::none ? nullptr : &chunks_[k]; }
  std::size_t bytes() const;

  // What the same plan is made of again: the places and axes that it was made at.
  struct Saved {
    double turned = 0, moved = 0;
    std::array<double, 2> twist{};
    Vec3Array position, axis;
  };
  bool any() const { return use_ != Use::none; }
  Saved saved() const { return {turned_, moved_, since_.twist(), since_.position(), since_.axis()}; }
  // The next forces, which are of these places and axes, make it.
  void resume(const NeighbourList& list, Saved saved);

 private:
  bool holds();

  Use use_ = Use::none;
  bool wanted_ = false, resumes_ = false;
  long stamp_ = 0;  // of the list
  double list_turned_ = 0, list_moved_ = 0, within_ = 0, lever_ = 0;
  double turned_ = 0, moved_ = 0;
  MotionSince since_;
  std::vector<Change> changes_;  // of each tube
  std::vector<ChunkPlan> chunks_;
};

}  // namespace ropewalk
