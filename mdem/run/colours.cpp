#include "run/colours.hpp"

#include <vector>

#include "observe/bending.hpp"
#include "sim/contact/contact_engine.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/threads/for_each.hpp"

namespace ropewalk {
namespace {

// Means over the bonds of an element: an inner element has two, an end element one.
void colour_bonds(const Topology& topology, const State& s, ElementColours& c) {
  for (int t = 0; t < topology.tubes(); ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    const BondStiffness& bond = topology.type_of(t).bond;
    const double a = topology.type_of(t).element_length;
    for (int i = from; i + 1 < to; ++i) {
      const auto si = static_cast<std::size_t>(i), sj = si + 1;
      const Frame fi = frame_of(s.orientation[si]), fj = frame_of(s.orientation[sj]);
      const double energy = bond_energy(bond, a, Vector3(s.position[sj] - s.position[si]), fi, fj).total();
      const double moment = bending_moment(bond, a, fi, fj);
      const double twist = bond_twist_angle(bond, a, fi, fj);
      const double wi = i == from ? 1.0 : 0.5, wj = i + 2 == to ? 1.0 : 0.5;
      c.bond_energy[si] += 0.5 * energy;
      c.bond_energy[sj] += 0.5 * energy;
      c.bending_moment[si] += wi * moment;
      c.bending_moment[sj] += wj * moment;
      c.twist_angle[si] += wi * twist;
      c.twist_angle[sj] += wj * twist;
    }
  }
}

}  // namespace

std::vector<double> contact_energies(const Topology& topology, const Interaction& in, const State& s) {
  std::vector<double> out(s.size(), 0.0);
  if (!in.has_contact()) return out;
  NeighbourList list(in, 0);
  list.build(topology, s);
  const PairEnergy law = make_contact_engine(*in.law)->pair_energy(*in.law);
  const auto energy = [&](int i, int j) {
    const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
    return law({topology.tube_type[topology.tube_of(i)], topology.tube_type[topology.tube_of(j)]},
               s.position[sj] - s.position[si], axis_of(s.orientation[si]), axis_of(s.orientation[sj]));
  };
  std::vector<std::size_t> first_pair{0};
  for (int i = 0; i < topology.elements(); ++i) first_pair.push_back(first_pair.back() + list.pairs(i));
  std::vector<double> of_pair(list.pairs());
  for_each_uneven(topology.elements(), 64, s.size() > parallel_from, [&](int i) {
    double* next = of_pair.data() + first_pair[static_cast<std::size_t>(i)];
    list.for_neighbours(i, [&](int j) { *next++ = energy(i, j); });
  });
  const double* next = of_pair.data();
  for (int i = 0; i < topology.elements(); ++i)
    list.for_neighbours(i, [&](int j) {
      const double half = 0.5 * *next++;
      out[static_cast<std::size_t>(i)] += half;
      out[static_cast<std::size_t>(j)] += half;
    });
  return out;
}

ElementColours element_colours(const Topology& topology, const Interaction& in, const State& s,
                               const Topology& bonded) {
  ElementColours c;
  for (auto* v : {&c.bond_energy, &c.bending_moment, &c.twist_angle}) v->assign(s.size(), 0.0);
  colour_bonds(bonded, s, c);
  c.vdw_energy = contact_energies(topology, in, s);
  return c;
}

}  // namespace ropewalk
