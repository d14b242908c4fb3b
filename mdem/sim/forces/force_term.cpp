#include "sim/forces/force_term.hpp"

#include <algorithm>
#include <utility>

#include "sim/forces/forces.hpp"

namespace ropewalk {
namespace {

// All pairs of a scene within reach as those of one chunk, whose buffer has all elements.
class AllPairs : public ChunkPairs {
 public:
  AllPairs(const Topology& topology, const Interaction& in, const State& state, double reach)
      : topology_(topology), in_(in), state_(state), reach_(reach) {}

  int entries() const override { return topology_.elements(); }
  void each(const std::function<void(const NearElements&)>& visit) const override {
    for_all_pairs(topology_, in_, [&](int i, int j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      if ((state_.position[b] - state_.position[a]).norm() < reach_)
        visit({i, tube_of(i), i + 1, j, j + 1, tube_of(j)});
    });
  }

 private:
  BufferRange tube_of(int element) const {
    const int tube = topology_.tube_of(element);
    return {topology_.tube_begin[tube], topology_.tube_begin[tube + 1], 0};
  }

  const Topology& topology_;
  const Interaction& in_;
  const State& state_;
  double reach_;
};

TermSum add_all_pairs(const Topology& topology, const Interaction& in, const State& state, ForceTerm& term,
                      Forces& out) {
  ContactBuffer<double> buffer;
  buffer.clear(state.size());
  term.start_chunks(1);
  term.list_chunk(0, AllPairs(topology, in, state, term.pair_reach()));
  const TermSum sum = term.add_pairs(state, 0, buffer);
  for (std::size_t i = 0; i < state.size(); ++i) {
    out.force.add(i, {buffer.fx[i], buffer.fy[i], buffer.fz[i]});
    out.torque.add(i, {buffer.tx[i], buffer.ty[i], buffer.tz[i]});
  }
  return sum;
}

}  // namespace

TermMemory ForceTerm::halved(const TermMemory& coarse) const {
  TermMemory fine = coarse;
  for (TermRecord& record : fine) record.element *= 2;
  return fine;
}

void ForceTerm::add_reference(const Topology& topology, const Interaction& in, const State& state,
                              Forces& out) const {
  const std::unique_ptr<ForceTerm> term = copy();
  NeighbourList list(in, 0);
  list.build(topology, state);
  term->prepare({topology, list, state, true, nullptr});
  term->gather(state);
  TermSum all;
  const auto add = [&](const TermSum& sum) { all.energy += sum.energy, all.power += sum.power; };
  for (int t = 0; t < topology.tubes(); ++t)
    add(term->add(state, {t, topology.tube_begin[t], topology.tube_begin[t + 1]}, rows_of(out)));
  if (term->pair_reach() > 0) add(add_all_pairs(topology, in, state, *term, out));
  out.energy.terms += all.energy;
  out.damping_power += all.power;
}

void add_term(std::shared_ptr<const ForceTerm> term, Interaction& interaction) {
  interaction.term_reach = std::max(interaction.term_reach, term->pair_reach());
  interaction.terms.push_back(std::move(term));
}

void for_all_pairs(const Topology& topology, const Interaction& in, const std::function<void(int, int)>& work) {
  for (int i = 0; i < topology.elements(); ++i) {
    const int tube = topology.tube_of(i), excluded = topology.type_of(tube).elements_within(in.excluded_arc());
    for (int j = i + 1; j < topology.elements(); ++j)
      if (j >= topology.tube_begin[tube + 1] || j - i > excluded) work(i, j);
  }
}

}  // namespace ropewalk
