#include "sim/forces/forces.hpp"

namespace ropewalk {

void add_pair(const DampingForce& d, std::size_t i, std::size_t j, Forces& out) {
  out.force.add(i, -d.force_j);
  out.force.add(j, d.force_j);
  out.torque.add(i, d.torque_i);
  out.torque.add(j, d.torque_j);
  out.damping_power += d.power;
}

namespace {

void contact_pair(TypePair types, const Interaction& in, const State& s, std::size_t i, std::size_t j,
                  Forces& out) {
  const Vector3 separation = s.position[j] - s.position[i];
  if (!(separation.norm() < in.cutoff())) return;
  const PairForce f = in.law->force(types, separation, axis_of(s.orientation[i]), axis_of(s.orientation[j]));
  out.energy.vdw += f.energy;
  out.force.add(i, -f.force_j);
  out.force.add(j, f.force_j);
  out.torque.add(i, f.torque_i);
  out.torque.add(j, f.torque_j);
}

void bond(const TubeType& type, const Interaction& in, const State& s, std::size_t i, Forces& out) {
  const std::size_t j = i + 1;
  const Vector3 separation = s.position[j] - s.position[i];
  const Frame fi = frame_of(s.orientation[i]), fj = frame_of(s.orientation[j]);
  const BondForce f = bond_energy_and_gradient(type.bond, type.element_length, separation, fi, fj);
  out.energy.stretch += f.energy.stretch;
  out.energy.shear += f.energy.shear;
  out.energy.bend += f.energy.bend;
  out.energy.twist += f.energy.twist;
  out.force.add(i, -f.force_j);
  out.force.add(j, f.force_j);
  out.torque.add(i, f.torque_i);
  out.torque.add(j, f.torque_j);
  if (std::fabs(bond_twist_angle(type.bond, type.element_length, fi, fj)) >= 0.5 * units::pi && out.slipping_bond < 0)
    out.slipping_bond = static_cast<int>(i);
  if (in.damping.bond.rate > 0)
    add_pair(in.damping.bond.force(type.mass, type.inertia, separation, s.velocity[i], s.angular_velocity[i],
                                   s.velocity[j], s.angular_velocity[j]),
             i, j, out);
}

}  // namespace

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

// A term that has no plain form.
void add_in_one_piece(const Topology& topology, const Interaction& in, const State& state, ForceTerm& term,
                      Forces& out) {
  NeighbourList list(in, 0);
  list.build(topology, state);
  term.prepare({topology, list, state, true, nullptr});
  term.gather(state);
  const auto add = [&](const TermSum& sum) {
    out.energy.terms += sum.energy;
    out.damping_power += sum.power;
  };
  for (int t = 0; t < topology.tubes(); ++t)
    add(term.add(state, {t, topology.tube_begin[t], topology.tube_begin[t + 1]}, rows_of(out)));
  if (term.pair_reach() > 0 && in.has_contact()) add(add_all_pairs(topology, in, state, term, out));
}

}  // namespace

void ForceTerms::add_reference(const Topology& topology, const Interaction& in, const State& state,
                               Forces& out) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const Cloned<ForceTerm> term = terms_[k].term;
    const double before = out.energy.terms;
    if (!term->acts_in_kick() && !term->add_reference(topology, in, state, out))
      add_in_one_piece(topology, in, state, *term, out);
    if (k < copied_.size()) out.term_energy.push_back(out.energy.terms - before);
  }
}

void compute_reference(const Topology& topology, const Interaction& in, const State& s, Forces& out) {
  out = Forces(s.size());
  ForceTerms terms;
  terms.use(in);
  const std::vector<char>* broken = terms.broken_bonds();
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i + 1 < topology.tube_begin[t + 1]; ++i)
      if (!broken || !(*broken)[static_cast<std::size_t>(i)])
        bond(topology.type_of(t), in, s, static_cast<std::size_t>(i), out);
  if (in.has_contact())
    for_all_pairs(topology, in, [&](int i, int j) {
      contact_pair({topology.tube_type[topology.tube_of(i)], topology.tube_type[topology.tube_of(j)]}, in, s,
                   static_cast<std::size_t>(i), static_cast<std::size_t>(j), out);
    });
  terms.add_reference(topology, in, s, out);
}

}  // namespace ropewalk
