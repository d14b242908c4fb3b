#include "run/colours.hpp"

#include <type_traits>
#include <vector>

#include "observe/bending.hpp"
#include "sim/contact/line/radial_table.hpp"
#include "sim/neighbours/neighbours.hpp"

namespace ropewalk {
namespace {

// The line law by its tables, without its exp and log: the same digits in a frame.
struct PairEnergy {
  const Topology& topology;
  const Interaction& in;
  const State& s;
  std::vector<FullTable> tables;  // of in.line

  PairEnergy(const Topology& t, const Interaction& i, const State& state) : topology(t), in(i), s(state) {
    for (const LineContact& pair : in.line) tables.emplace_back(pair.density, 1);
  }
  double operator()(int i, int j) const {
    const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
    const Vector3 apart = s.position[sj] - s.position[si];
    const Vector3 n_i = axis_of(s.orientation[si]), n_j = axis_of(s.orientation[sj]);
    return with_law(topology, in, i, j, [&](const auto& law) {
      if constexpr (std::is_same_v<decltype(law), const LineContact&>) {
        const FullTable& table = tables[in.line_index(topology, topology.tube_of(i), topology.tube_of(j))];
        return law.energy_by([&](double distance2) { return table.energy(distance2); }, apart, n_i, n_j);
      } else {
        return law.energy(apart, n_i, n_j);
      }
    });
  }
};

void colour_contacts(const Topology& topology, const Interaction& in, const State& s, ElementColours& c) {
  NeighbourList list(in, 0);
  list.build(topology, s);
  const PairEnergy energy(topology, in, s);
  std::vector<std::size_t> first_pair{0};
  for (int i = 0; i < topology.elements(); ++i) first_pair.push_back(first_pair.back() + list.pairs(i));
  std::vector<double> of_pair(list.pairs());
#pragma omp parallel for schedule(dynamic, 64) if (s.size() > parallel_from)
  for (int i = 0; i < topology.elements(); ++i) {
    double* next = of_pair.data() + first_pair[static_cast<std::size_t>(i)];
    list.for_neighbours(i, [&](int j) { *next++ = energy(i, j); });
  }
  const double* next = of_pair.data();
  for (int i = 0; i < topology.elements(); ++i)
    list.for_neighbours(i, [&](int j) {
      const double half = 0.5 * *next++;
      c.vdw_energy[static_cast<std::size_t>(i)] += half;
      c.vdw_energy[static_cast<std::size_t>(j)] += half;
    });
}

// An inner element has two bonds, an end element one: means are over the bonds that are there.
void colour_bonds(const Topology& topology, const State& s, ElementColours& c) {
  for (int t = 0; t < topology.tubes(); ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    const BondStiffness& bond = topology.type_of(t).bond;
    const double a = topology.type_of(t).element_length;
    for (int i = from; i + 1 < to; ++i) {
      const auto si = static_cast<std::size_t>(i), sj = si + 1;
      const Frame<double> fi = frame_of(s.orientation[si]), fj = frame_of(s.orientation[sj]);
      const double energy = bond_energy(bond, a, Vector3(s.position[sj] - s.position[si]), fi, fj).total();
      const double moment = bending_moment(bond, a, fi.t, fj.t);
      const double twist = bond_twist_angle(fi, fj);
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

ElementColours element_colours(const Topology& topology, const Interaction& in, const State& s) {
  ElementColours c;
  for (auto* v : {&c.bond_energy, &c.vdw_energy, &c.bending_moment, &c.twist_angle}) v->assign(s.size(), 0.0);
  colour_bonds(topology, s, c);
  if (in.has_contact()) colour_contacts(topology, in, s, c);
  return c;
}

}  // namespace ropewalk
