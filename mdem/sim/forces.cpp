#include "sim/forces.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace ropewalk {

void ForceEngine::make_frames(const State& state) {
  const std::size_t n = state.size();
  frames_.resize(n);
  axis_.resize(n);
#pragma omp parallel for schedule(static) if (n > parallel_from)
  for (std::size_t i = 0; i < n; ++i) {
    frames_[i] = frame_of(state.orientation[i]);
    axis_.set(i, frames_[i].t);
  }
}

std::size_t ForceEngine::bytes() const {
  std::size_t total = frames_.capacity() * sizeof(Frame<double>) + 3 * axis_.size() * sizeof(double);
  total += tube_.capacity() * sizeof(int);
  for (const ContactBuffer& b : buffers_) total += 6 * b.fx.capacity() * sizeof(double);
  return total;
}

void ForceEngine::compute_contact(const Topology& topology, const Interaction& interaction,
                                  const NeighbourList& list, const State& state) {
  if (tube_.size() != static_cast<std::size_t>(topology.elements())) {
    tube_.resize(static_cast<std::size_t>(topology.elements()));
    for (int t = 0; t < topology.tubes(); ++t)
      std::fill(tube_.begin() + topology.tube_begin[t], tube_.begin() + topology.tube_begin[t + 1], t);
  }
  const ContactInput in{&topology, &interaction, &state, &axis_, &list, &tube_};
#pragma omp parallel for schedule(dynamic, 1) if (state.size() > parallel_from)
  for (int k = 0; k < NeighbourList::chunk_count; ++k) {
    const auto& chunk = list.chunks()[static_cast<std::size_t>(k)];
    ContactBuffer& b = buffers_[static_cast<std::size_t>(k)];
    b.clear(static_cast<std::size_t>(chunk.touched_end - chunk.touched_begin));
    interaction.paper ? paper_contact(in, chunk, b) : line_contact(in, chunk, b);
  }
}

void ForceEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                          const State& state, Forces& out) {
  const double t0 = omp_get_wtime();
  make_frames(state);
  const double t1 = omp_get_wtime();

  const bool contact = interaction.has_contact();
  if (contact) compute_contact(topology, interaction, list, state);
  const double t2 = omp_get_wtime();

  // Tube by tube: collect the contact buffers in their fixed order, then add the bonds of this tube.
  const int tubes = topology.tubes();
  struct TubeSum {
    BondEnergy<double> energy;
    double power = 0;
    int slipping = -1;
  };
  std::vector<TubeSum> sums(static_cast<std::size_t>(tubes));
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (int t = 0; t < tubes; ++t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    const auto clear = [&](std::vector<double>& v) { std::fill(v.begin() + from, v.begin() + to, 0.0); };
    clear(out.force.x), clear(out.force.y), clear(out.force.z);
    clear(out.torque.x), clear(out.torque.y), clear(out.torque.z);
    if (contact) {
      for (int k = 0; k < NeighbourList::chunk_count; ++k) {
        const auto& chunk = list.chunks()[static_cast<std::size_t>(k)];
        const ContactBuffer& b = buffers_[static_cast<std::size_t>(k)];
        const int low = std::max(from, chunk.touched_begin), high = std::min(to, chunk.touched_end);
        for (int i = low; i < high; ++i) {
          const auto at = static_cast<std::size_t>(i - chunk.touched_begin);
          out.force.x[i] += b.fx[at];
          out.force.y[i] += b.fy[at];
          out.force.z[i] += b.fz[at];
          out.torque.x[i] += b.tx[at];
          out.torque.y[i] += b.ty[at];
          out.torque.z[i] += b.tz[at];
        }
      }
    }
    TubeSum& sum = sums[static_cast<std::size_t>(t)];
    const TubeType& type = topology.type_of(t);
    for (int i = from; i + 1 < to; ++i) {
      const auto si = static_cast<std::size_t>(i), sj = si + 1;
      const Vector3 separation = state.position[sj] - state.position[si];
      const Frame<double>&fi = frames_[si], &fj = frames_[sj];
      const BondForce<double> f = bond_energy_and_gradient(type.bond, type.element_length, separation, fi, fj);
      out.force.add(si, -f.force_j);
      out.force.add(sj, f.force_j);
      out.torque.add(si, f.torque_i);
      out.torque.add(sj, f.torque_j);
      sum.energy.stretch += f.energy.stretch;
      sum.energy.shear += f.energy.shear;
      sum.energy.bend += f.energy.bend;
      sum.energy.twist += f.energy.twist;
      if (!(fi.e1.dot(fj.e1) + fi.e2.dot(fj.e2) > 0) && sum.slipping < 0) sum.slipping = i;
      if (interaction.damping.bond.rate > 0) {
        const DampingForce d = interaction.damping.bond.force(type.mass, type.inertia, separation,
                                                              state.velocity[si], state.angular_velocity[si],
                                                              state.velocity[sj], state.angular_velocity[sj]);
        out.force.add(si, -d.force_j);
        out.force.add(sj, d.force_j);
        out.torque.add(si, d.torque_i);
        out.torque.add(sj, d.torque_j);
        sum.power += d.power;
      }
    }
  }

  out.energy = Energies{};
  out.damping_power = 0;
  out.slipping_bond = -1;
  for (const TubeSum& sum : sums) {
    out.energy.stretch += sum.energy.stretch;
    out.energy.shear += sum.energy.shear;
    out.energy.bend += sum.energy.bend;
    out.energy.twist += sum.energy.twist;
    out.damping_power += sum.power;
    if (out.slipping_bond < 0) out.slipping_bond = sum.slipping;
  }
  if (contact) {
    for (const ContactBuffer& b : buffers_) {
      out.energy.vdw += b.energy;
      out.damping_power += b.power;
    }
  }
  const double t3 = omp_get_wtime();
  times_.frames += t1 - t0;
  times_.contact += t2 - t1;
  times_.bonds += t3 - t2;
}

double kinetic_energy(const Topology& topology, const State& state) {
  double sum = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    double translation = 0, rotation = 0;
    for (int i = topology.tube_begin[t]; i < topology.tube_begin[t + 1]; ++i) {
      translation += state.velocity[static_cast<std::size_t>(i)].squaredNorm();
      rotation += state.angular_velocity[static_cast<std::size_t>(i)].squaredNorm();
    }
    sum += topology.type_of(t).mass * translation + topology.type_of(t).inertia * rotation;
  }
  return 0.5 * sum;
}

NetForce net_force(const State& state, const Forces& forces) {
  NetForce net;
  for (std::size_t i = 0; i < state.size(); ++i) {
    net.force += forces.force[i];
    net.torque += forces.torque[i] + state.position[i].cross(forces.force[i]);
  }
  return net;
}

}  // namespace ropewalk
