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
  const Frame<double> fi = frame_of(s.orientation[i]), fj = frame_of(s.orientation[j]);
  const BondForce<double> f = bond_energy_and_gradient(type.bond, type.element_length, separation, fi, fj);
  out.energy.stretch += f.energy.stretch;
  out.energy.shear += f.energy.shear;
  out.energy.bend += f.energy.bend;
  out.energy.twist += f.energy.twist;
  out.force.add(i, -f.force_j);
  out.force.add(j, f.force_j);
  out.torque.add(i, f.torque_i);
  out.torque.add(j, f.torque_j);
  if (std::fabs(bond_twist_angle(fi, fj)) >= 0.5 * units::pi && out.slipping_bond < 0)
    out.slipping_bond = static_cast<int>(i);
  if (in.damping.bond.rate > 0)
    add_pair(in.damping.bond.force(type.mass, type.inertia, separation, s.velocity[i], s.angular_velocity[i],
                                s.velocity[j], s.angular_velocity[j]),
          i, j, out);
}

}  // namespace

void compute_reference(const Topology& topology, const Interaction& in, const State& s, Forces& out) {
  out = Forces(s.size());
  for (int t = 0; t < topology.tubes(); ++t)
    for (int i = topology.tube_begin[t]; i + 1 < topology.tube_begin[t + 1]; ++i)
      bond(topology.type_of(t), in, s, static_cast<std::size_t>(i), out);
  if (in.has_contact())
    for_all_pairs(topology, in, [&](int i, int j) {
      contact_pair({topology.tube_type[topology.tube_of(i)], topology.tube_type[topology.tube_of(j)]}, in, s,
                   static_cast<std::size_t>(i), static_cast<std::size_t>(j), out);
    });
  ForceTerms terms;
  terms.use(in);
  terms.add_reference(topology, in, s, out);
}

}  // namespace ropewalk
