// The terms that one engine of forces works with (sim/forces/force_term.hpp): copies of those of an interaction,
// with memories of their own, and those that its dampings stand for.
#pragma once

#include <memory>
#include <vector>

#include "sim/forces/force_term.hpp"
#include "sim/threads/cloned.hpp"

namespace ropewalk {

// States of several terms.
struct TermStates {
  std::vector<TermState> records;
  std::vector<TermAccount> accounts;
};

// Memories as one list of numbers: for each record the number of its term, its element, how many numbers follow,
// and these; an account stands as a record of the element -1, an event as one of the element -2. Lists of several
// processes may stand behind one another.
inline constexpr int the_account = -1, an_event = -2;
std::vector<double> numbers_of(const TermStates& memories);
std::vector<double> numbers_of(const std::vector<TermEvent>& events);
// How many numbers the record has that begins at `at`, with the three in front; 0: it is none, or not whole.
std::size_t record_length(const std::vector<double>& numbers, std::size_t at);
// Calls work(element, its first number, how many) for each record of a list that is whole, the three in front included.
template <class Work>
void for_records(const std::vector<double>& numbers, const Work& work) {
  for (std::size_t at = 0, length; (length = record_length(numbers, at)) > 0; at += length)
    work(static_cast<int>(numbers[at + 1]), numbers.data() + at, length);
}
// Takes the events out of such a list, in the order of ForceTerms::events(). Throws std::runtime_error for elements
// that a scene of so many does not have.
std::vector<TermEvent> take_events(std::vector<double>& numbers, int elements);
// Records in the order of their elements, accounts added up. Throws std::runtime_error if these are not the
// memories of `terms` terms in a scene of `elements` elements.
TermStates memories_of(const std::vector<double>& numbers, std::size_t terms, int elements);

class ForceTerms : private PairWork {
 public:
  // Returns whether these are other terms than before: new copies, as at the start of the scene.
  bool use(const Interaction& interaction);
  void share_with(const Processes* others) { others_ = others; }
  bool empty() const { return terms_.empty(); }

  // Prepares the terms for a list that is new to them.
  void prepare(const Topology& topology, const NeighbourList& list, const State& state, bool again = false);
  // One evaluation calls these in turn. advance() returns the energy that the terms have lost, eV. `passed`:
  // time since the last evaluation, ps; none where this one is not of the way.
  void begin(const State& state, int parts);
  double advance(double dt, const State& state);
  void add(int part, const Segment& of, const ForceRows& out);
  void sum_up(Forces& out, double passed);
  // For the contact engine; null: no term acts on pairs.
  PairWork* pairs() { return reach() > 0 ? this : nullptr; }

  // StateUpdate::news of a term since the last set_memory().
  bool have_news() const { return news_; }

  bool act_in_kick() const { return in_kick_; }
  void add_in_kick(const State& state, const ForceRows& total, const Segment& of, const ForceRows& out) const;

  void add_reference(const Topology& topology, const Interaction& in, const State& state, Forces& out) const;

  // The name of the first of the interaction's own terms that has no tangent; empty: all have added theirs.
  std::string add_tangent(const State& state, const ForceTerm::AddBlock& add) const;
  // Accounts of the interaction's own terms, one after another.
  std::vector<TermAccount> accounts() const;
  // ForceTerm::broken_bonds of the one that has some; null: none has.
  const std::vector<char>* broken_bonds() const;
  // Events of all terms since the start or since forget_events(), in the order of time, at one time in that of their
  // elements: whichever process saw them.
  std::vector<TermEvent> events() const;
  void forget_events();

  std::vector<double> memory() const;
  // The memories of the interaction's own terms, in their order.
  std::vector<NamedMemory> memories() const;
  // prepare() then finds all lists new. `goes_on`: accounts and events stay as they are. Throws std::runtime_error.
  void set_memory(const std::vector<double>& numbers, int elements, bool goes_on = false);
  std::vector<double> halved_memory(const std::vector<int>& heirs) const;
  std::size_t bytes() const;

 private:
  struct Working {
    Cloned<ForceTerm> term;
    std::vector<TermSum> of_part, of_chunk;
    TermAccount account = {};
  };
  double reach() const override;
  void start(std::size_t chunks) override;
  void list(std::size_t chunk, const ChunkPairs& pairs) override;
  void add(std::size_t chunk, const PairBuffer& buffer) override;

  std::vector<Working> terms_;
  std::vector<std::shared_ptr<const ForceTerm>> copied_;  // the first of them are copies of these
  Damping damping_;                                       // that the others stand for
  std::vector<TermEvent> earlier_;                        // events of before the last set_memory()
  const Processes* others_ = nullptr;
  const State* state_ = nullptr;  // state of the evaluation
  long stamp_ = 0;                // stamp of the list that they are prepared for
  bool in_kick_ = false, news_ = false;
};

}  // namespace ropewalk
