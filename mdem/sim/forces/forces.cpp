#include "sim/forces/forces.hpp"

#include <omp.h>

#include <algorithm>

#include "sim/forces/bonds.hpp"
#include "sim/threads/vector_clones.hpp"

namespace ropewalk {
namespace {

// axis_of() over plain numbers, which the compiler vectorises.
ROPEWALK_VECTOR_CLONES
void axes_of(const QuaternionArray& q, std::ptrdiff_t begin, std::ptrdiff_t end, Vec3Array& out) {
  const double *qw = q.w.data(), *qx = q.x.data(), *qy = q.y.data(), *qz = q.z.data();
  double *tx = out.x.data(), *ty = out.y.data(), *tz = out.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double w = qw[i], x = qx[i], y = qy[i], z = qz[i];
    tx[i] = 2 * (x * z + w * y), ty[i] = 2 * (y * z - w * x), tz[i] = 1 - 2 * (x * x + y * y);
  }
}

void clear(const Segment& of, const ForceRows& out) {
  for (Vec3Array* v : {&out.force, &out.torque})
    for (std::vector<double>* c : {&v->x, &v->y, &v->z})
      std::fill(c->begin() + (of.begin - out.origin), c->begin() + (of.end - out.origin), 0.0);
}

}  // namespace

void ForceEngine::make_all_axes(const State& state) {
  const auto n = static_cast<std::ptrdiff_t>(state.size());
  constexpr std::ptrdiff_t block = 512;
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (std::ptrdiff_t i = 0; i < n; i += block) axes_of(state.orientation, i, std::min(i + block, n), axis_);
}

std::size_t ForceEngine::bytes() const {
  std::size_t total = 3 * axis_.size() * sizeof(double);
  for (const ContactBuffer<double>& b : buffers_) total += b.bytes();
  return total + line_.bytes() + paper_.bytes();
}

// Of all chunks in their fixed order, on the elements from .. to.
void ForceEngine::add_buffers(const NeighbourList& list, int from, int to, const ForceRows& out) const {
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const auto& chunk = list.chunks()[k];
    const ContactBuffer<double>& b = buffers_[k];
    const int low = std::max(from, chunk.touched_begin), high = std::min(to, chunk.touched_end);
    for (int i = low; i < high; ++i) {
      const auto at = static_cast<std::size_t>(i - chunk.touched_begin),
                 to_row = static_cast<std::size_t>(i - out.origin);
      out.force.x[to_row] += b.fx[at];
      out.force.y[to_row] += b.fy[at];
      out.force.z[to_row] += b.fz[at];
      out.torque.x[to_row] += b.tx[at];
      out.torque.y[to_row] += b.ty[at];
      out.torque.z[to_row] += b.tz[at];
    }
  }
}

void ForceEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                          const State& state, Forces& out, const ForceOptions& options) {
  const double t0 = omp_get_wtime(), finished_before = line_.finish_seconds();
  const bool contact = interaction.has_contact() && options.parts != Parts::bonds,
             bonds = options.parts != Parts::contact;
  const bool by_line = contact && !interaction.paper, by_paper = contact && !by_line;
  if (contact) axis_.resize(state.size());
  if (by_paper) make_all_axes(state);  // by the line law with the nodes
  const double t1 = omp_get_wtime();

  // Part by part of the tubes: the bonds, and what the contact buffers hold, in their fixed order.
  parts_.cut(topology);
  const int tube_parts = parts_.count();
  joints_.resize(static_cast<std::size_t>(tube_parts));
  std::vector<BondSum> sums(static_cast<std::size_t>(tube_parts));
  const BondInput bonded{topology, interaction.damping.bond, state};
  // Behind part k, if the tube goes on there.
  const auto joint = [&](int k, bool goes_on) -> const Joint* {
    return goes_on ? &joints_[static_cast<std::size_t>(k)] : nullptr;
  };
  const auto join = [&](int tube) {
    for (int k = parts_.begin(tube); bonds && k + 1 < parts_.begin(tube + 1); ++k)
      joints_[static_cast<std::size_t>(k)] = joint_behind(bonded, tube, parts_[k].end - 1);
  };
  const ForceRows on = rows_of(out);
  const auto finish = [&](int k) {
    const Segment& part = parts_[k];
    if (bonds) {
      const Joint *before = joint(k - 1, part.begin > topology.tube_begin[part.tube]),
                  *behind = joint(k, part.end < topology.tube_begin[part.tube + 1]);
      sums[static_cast<std::size_t>(k)] = compute_bonds(bonded, part, before, behind, on);
    } else {
      clear(part, on);
    }
    if (by_paper) add_buffers(list, part.begin, part.end, on);
    if (by_line) line_.add_to(k, on);
  };
  const auto finish_block = [&](int block) {
    for (int k = parts_.block_begin(block); k < parts_.block_begin(block + 1); ++k) finish(k);
  };
  if (by_line) {
    const auto place = [&](int t) {
      axes_of(state.orientation, topology.tube_begin[t], topology.tube_begin[t + 1], axis_);
      join(t);
    };
    line_.compute(topology, interaction, list, state, axis_, options.energies, {parts_, place, finish_block});
  }
  if (by_paper) {
    buffers_.resize(list.chunks().size());
    // Always with energies: its loops are the compiler's, who orders their sums as it likes, and forces must be the
    // same bits whoever reads energies.
    paper_.compute(topology, interaction, list, state, axis_, buffers_.data());
  }
  const double t2 = omp_get_wtime();
  if (!by_line) {
#pragma omp parallel if (state.size() > parallel_from)
    {
#pragma omp for schedule(static)
      for (int t = 0; t < topology.tubes(); ++t) join(t);
#pragma omp for schedule(static)
      for (int block = 0; block < parts_.blocks(); ++block) finish_block(block);
    }
  }

  out.energy = Energies{};
  out.damping_power = 0;
  BondSum all;
  for (const BondSum& sum : sums) add(sum, all);
  out.energy.stretch = all.energy.stretch;
  out.energy.shear = all.energy.shear;
  out.energy.bend = all.energy.bend;
  out.energy.twist = all.energy.twist;
  out.damping_power = all.power;
  out.slipping_bond = all.slipping;
  if (by_line) {
    out.energy.vdw = line_.energy();
    out.damping_power += line_.damping_power();
  }
  if (by_paper)
    for (const ContactBuffer<double>& b : buffers_) {
      out.energy.vdw += b.energy;
      out.damping_power += b.power;
    }
  const double t3 = omp_get_wtime(), finished = line_.finish_seconds() - finished_before;
  times_.axes += t1 - t0;
  times_.contact += t2 - t1 - finished;
  times_.bonds += t3 - t2 + finished;
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
