#include "sim/forces.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "sim/plain_vector.hpp"

namespace ropewalk {

namespace {

// frame_of() over plain numbers, which the compiler vectorises; element `begin` becomes frame 0.
ROPEWALK_VECTOR_CLONES
void frames_of(const QuaternionArray& q, std::ptrdiff_t begin, std::ptrdiff_t end, FrameArray& out) {
  const double *qw = q.w.data() + begin, *qx = q.x.data() + begin, *qy = q.y.data() + begin,
               *qz = q.z.data() + begin;
  double *ax = out.e1.x.data(), *ay = out.e1.y.data(), *az = out.e1.z.data(), *bx = out.e2.x.data(),
         *by = out.e2.y.data(), *bz = out.e2.z.data(), *tx = out.t.x.data(), *ty = out.t.y.data(),
         *tz = out.t.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < end - begin; ++i) {
    const double w = qw[i], x = qx[i], y = qy[i], z = qz[i];
    ax[i] = 1 - 2 * (y * y + z * z), ay[i] = 2 * (x * y + w * z), az[i] = 2 * (x * z - w * y);
    bx[i] = 2 * (x * y - w * z), by[i] = 1 - 2 * (x * x + z * z), bz[i] = 2 * (y * z + w * x);
    tx[i] = 2 * (x * z + w * y), ty[i] = 2 * (y * z - w * x), tz[i] = 1 - 2 * (x * x + y * y);
  }
}

// axis_of() likewise, each at its own place.
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

// The bonds of the tube that begins with element `begin`. Returns their energies; `slips` becomes negative where a
// bond does.
ROPEWALK_VECTOR_CLONES __attribute__((flatten)) BondEnergy<double> bond_forces(
    const TubeType& type, const Vec3Array& position, const FrameArray& frames, std::ptrdiff_t begin,
    std::ptrdiff_t bonds, BondArray& out, double& slips) {
  const double *x = position.x.data() + begin, *y = position.y.data() + begin, *z = position.z.data() + begin;
  const Vec3Array &e1 = frames.e1, &e2 = frames.e2, &t = frames.t;
  const double *ax = e1.x.data(), *ay = e1.y.data(), *az = e1.z.data(), *bx = e2.x.data(), *by = e2.y.data(),
               *bz = e2.z.data(), *tx = t.x.data(), *ty = t.y.data(), *tz = t.z.data();
  double *fx = out.force_j.x.data(), *fy = out.force_j.y.data(), *fz = out.force_j.z.data();
  double *ix = out.torque_i.x.data(), *iy = out.torque_i.y.data(), *iz = out.torque_i.z.data();
  double *jx = out.torque_j.x.data(), *jy = out.torque_j.y.data(), *jz = out.torque_j.z.data();
  const BondStiffness k = type.bond;
  const double a = type.element_length;
  double stretch = 0, shear = 0, bend = 0, twist = 0, smallest = 1;
  // Not `omp simd`, whose reductions GCC 12 does not vectorise here; -ffast-math lets it reorder the sums.
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < bonds; ++i) {
    const std::ptrdiff_t j = i + 1;
    const Frame<double, PlainVector> fi{{ax[i], ay[i], az[i]}, {bx[i], by[i], bz[i]}, {tx[i], ty[i], tz[i]}};
    const Frame<double, PlainVector> fj{{ax[j], ay[j], az[j]}, {bx[j], by[j], bz[j]}, {tx[j], ty[j], tz[j]}};
    const BondForce<double, PlainVector> f =
        bond_energy_and_gradient(k, a, {x[j] - x[i], y[j] - y[i], z[j] - z[i]}, fi, fj);
    fx[i] = f.force_j.x, fy[i] = f.force_j.y, fz[i] = f.force_j.z;
    ix[i] = f.torque_i.x, iy[i] = f.torque_i.y, iz[i] = f.torque_i.z;
    jx[i] = f.torque_j.x, jy[i] = f.torque_j.y, jz[i] = f.torque_j.z;
    stretch += f.energy.stretch;
    shear += f.energy.shear;
    bend += f.energy.bend;
    twist += f.energy.twist;
    smallest = std::min(smallest, fi.e1.dot(fj.e1) + fi.e2.dot(fj.e2));
  }
  slips = smallest;
  return {stretch, shear, bend, twist};
}

// Adds the damping of these bonds; returns its power.
ROPEWALK_VECTOR_CLONES
double bond_damping(const TubeType& type, const BondDamping& damping, const State& s, std::ptrdiff_t begin,
                    std::ptrdiff_t bonds, BondArray& out) {
  const auto from = [&](const std::vector<double>& v) { return v.data() + begin; };
  const double *x = from(s.position.x), *y = from(s.position.y), *z = from(s.position.z);
  const double *vx = from(s.velocity.x), *vy = from(s.velocity.y), *vz = from(s.velocity.z);
  const double *wx = from(s.angular_velocity.x), *wy = from(s.angular_velocity.y), *wz = from(s.angular_velocity.z);
  double *fx = out.force_j.x.data(), *fy = out.force_j.y.data(), *fz = out.force_j.z.data();
  double *ix = out.torque_i.x.data(), *iy = out.torque_i.y.data(), *iz = out.torque_i.z.data();
  double *jx = out.torque_j.x.data(), *jy = out.torque_j.y.data(), *jz = out.torque_j.z.data();
  double power = 0;
  const BondDamping law = damping;
  const double mass = type.mass, inertia = type.inertia;
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < bonds; ++i) {
    const std::ptrdiff_t j = i + 1;
    const PairDamping<PlainVector> d = law.force<PlainVector>(
        mass, inertia, PlainVector{x[j] - x[i], y[j] - y[i], z[j] - z[i]}, PlainVector{vx[i], vy[i], vz[i]},
        PlainVector{wx[i], wy[i], wz[i]}, PlainVector{vx[j], vy[j], vz[j]}, PlainVector{wx[j], wy[j], wz[j]});
    fx[i] += d.force_j.x, fy[i] += d.force_j.y, fz[i] += d.force_j.z;
    ix[i] += d.torque_i.x, iy[i] += d.torque_i.y, iz[i] += d.torque_i.z;
    jx[i] += d.torque_j.x, jy[i] += d.torque_j.y, jz[i] += d.torque_j.z;
    power += d.power;
  }
  return power;
}

// What acts on the elements of a tube by its bonds: bond i on the elements i and i + 1.
ROPEWALK_VECTOR_CLONES
void collect_bonds(const std::vector<double>& on_i, double sign_i, const std::vector<double>& on_j,
                   std::ptrdiff_t elements, double* to) {
  const double *a = on_i.data(), *b = on_j.data();
  if (elements < 2) {
    std::fill_n(to, elements, 0.0);
    return;
  }
  to[0] = sign_i * a[0];
#pragma omp simd
  for (std::ptrdiff_t i = 1; i < elements - 1; ++i) to[i] = sign_i * a[i] + b[i - 1];
  to[elements - 1] = b[elements - 2];
}

// Sets forces and torques of one tube to those of its bonds.
TubeSum compute_bonds(const Topology& topology, const Interaction& interaction, const State& state, int tube,
                      Forces& out) {
  thread_local TubeBonds work;
  const std::ptrdiff_t begin = topology.tube_begin[tube], end = topology.tube_begin[tube + 1],
                       elements = end - begin;
  const TubeType& type = topology.type_of(tube);
  work.resize(static_cast<std::size_t>(elements));
  frames_of(state.orientation, begin, end, work.frames);
  TubeSum sum;
  double slips = 1;
  BondArray& bonds = work.bonds;
  sum.energy = bond_forces(type, state.position, work.frames, begin, elements - 1, bonds, slips);
  for (std::ptrdiff_t i = 0; !(slips > 0) && i + 1 < elements && sum.slipping < 0; ++i) {
    const Frame<double> fi = work.frames[static_cast<std::size_t>(i)],
                        fj = work.frames[static_cast<std::size_t>(i + 1)];
    if (!(fi.e1.dot(fj.e1) + fi.e2.dot(fj.e2) > 0)) sum.slipping = static_cast<int>(begin + i);
  }
  if (interaction.damping.bond.rate > 0)
    sum.power = bond_damping(type, interaction.damping.bond, state, begin, elements - 1, bonds);
  collect_bonds(bonds.force_j.x, -1, bonds.force_j.x, elements, out.force.x.data() + begin);
  collect_bonds(bonds.force_j.y, -1, bonds.force_j.y, elements, out.force.y.data() + begin);
  collect_bonds(bonds.force_j.z, -1, bonds.force_j.z, elements, out.force.z.data() + begin);
  collect_bonds(bonds.torque_i.x, 1, bonds.torque_j.x, elements, out.torque.x.data() + begin);
  collect_bonds(bonds.torque_i.y, 1, bonds.torque_j.y, elements, out.torque.y.data() + begin);
  collect_bonds(bonds.torque_i.z, 1, bonds.torque_j.z, elements, out.torque.z.data() + begin);
  return sum;
}

void clear(Forces& out, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (Vec3Array* v : {&out.force, &out.torque})
    for (std::vector<double>* c : {&v->x, &v->y, &v->z}) std::fill(c->begin() + begin, c->begin() + end, 0.0);
}

}  // namespace

void ForceEngine::make_axes(const State& state, std::ptrdiff_t begin, std::ptrdiff_t end) {
  axes_of(state.orientation, begin, end, axis_);
}

void ForceEngine::make_all_axes(const State& state) {
  const auto n = static_cast<std::ptrdiff_t>(state.size());
  constexpr std::ptrdiff_t block = 512;
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
  for (std::ptrdiff_t i = 0; i < n; i += block) make_axes(state, i, std::min(i + block, n));
}

std::size_t ForceEngine::bytes() const {
  std::size_t total = 3 * axis_.size() * sizeof(double);
  for (const ContactBuffer& b : buffers_) total += 6 * b.fx.capacity() * sizeof(double);
  return total + line_.bytes() + paper_.bytes();
}

// Of all chunks in their fixed order, on the elements from .. to.
void ForceEngine::add_buffers(const NeighbourList& list, int from, int to, Forces& out) const {
  for (std::size_t k = 0; k < list.chunks().size(); ++k) {
    const auto& chunk = list.chunks()[k];
    const ContactBuffer& b = buffers_[k];
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

void ForceEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                          const State& state, Forces& out, bool energies, Parts parts, bool axes_made) {
  const double t0 = omp_get_wtime(), finished_before = line_.finish_seconds();
  const bool contact = interaction.has_contact() && parts != Parts::bonds, bonds = parts != Parts::contact;
  const bool by_line = contact && !interaction.paper, by_paper = contact && !by_line;
  if (contact) axis_.resize(state.size());
  if (by_paper && !axes_made) make_all_axes(state);  // by the line law with the nodes
  const double t1 = omp_get_wtime();

  // Tube by tube: its bonds, and what the contact buffers hold for it, in their fixed order.
  const int tubes = topology.tubes();
  std::vector<TubeSum> sums(static_cast<std::size_t>(tubes));
  const auto finish = [&](int t) {
    const int from = topology.tube_begin[t], to = topology.tube_begin[t + 1];
    if (bonds)
      sums[static_cast<std::size_t>(t)] = compute_bonds(topology, interaction, state, t, out);
    else
      clear(out, from, to);
    if (by_paper) add_buffers(list, from, to, out);
    if (by_line) line_.add_to_tube(t, out.force, out.torque);
  };
  if (by_line) {
    const auto place = [&](int t) {
      if (!axes_made) make_axes(state, topology.tube_begin[t], topology.tube_begin[t + 1]);
    };
    line_.compute(topology, interaction, list, state, axis_, energies, {place, finish});
  }
  if (by_paper) {
    buffers_.resize(list.chunks().size());
    // Always with energies: its loops are the compiler's, who orders their sums as it likes, and forces must be the
    // same bits whoever reads energies.
    paper_.compute(topology, interaction, list, state, axis_, buffers_.data());
  }
  const double t2 = omp_get_wtime();
  if (!by_line) {
#pragma omp parallel for schedule(static) if (state.size() > parallel_from)
    for (int t = 0; t < tubes; ++t) finish(t);
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
  if (by_line) {
    out.energy.vdw = line_.energy();
    out.damping_power += line_.damping_power();
  }
  if (by_paper)
    for (const ContactBuffer& b : buffers_) {
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
