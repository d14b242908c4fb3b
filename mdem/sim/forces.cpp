#include "sim/forces.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

// One binary for every x86-64: the loader picks the widest vector unit that the machine has.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ROPEWALK_VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ROPEWALK_VECTOR_CLONES
#endif

namespace ropewalk {
namespace {

constexpr int block = 128;
constexpr int lanes = 8;  // blocks are filled up to a multiple of this with pairs beyond the cutoff

// Pairs of one element within the cutoff, gathered so that the arithmetic runs over plain arrays.
struct PairBlock {
  alignas(64) double dx[block], dy[block], dz[block], r[block];
  alignas(64) double nx[block], ny[block], nz[block];
  alignas(64) double fx[block], fy[block], fz[block];  // on j
  alignas(64) double tx[block], ty[block], tz[block];  // on j
  int j[block];
  int count = 0;
};

struct ElementSum {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0, energy = 0;
};

template <class Powers, bool legacy>
inline __attribute__((always_inline)) void evaluate(const PaperContact& law, PairBlock& b, double nix, double niy,
                                                    double niz, ElementSum& sum) {
  double fx = 0, fy = 0, fz = 0, tx = 0, ty = 0, tz = 0, energy = 0;
  const PaperContact k = law;  // a local copy: the compiler need not fear that the stores below change it
  const int count = (b.count + lanes - 1) / lanes * lanes;
#pragma omp simd reduction(+ : fx, fy, fz, tx, ty, tz, energy)
  for (int m = 0; m < count; ++m) {
    const double r = b.r[m], inv = 1.0 / r;
    const double ux = b.dx[m] * inv, uy = b.dy[m] * inv, uz = b.dz[m] * inv;
    const double njx = b.nx[m], njy = b.ny[m], njz = b.nz[m];
    const double p = nix * ux + niy * uy + niz * uz;
    const double q = njx * ux + njy * uy + njz * uz;
    const double c = nix * njx + niy * njy + niz * njz;
    const PairTerms<double> t = k.terms<Powers, double>(r, p, q, c);
    const double radial = t.d_r - (t.d_p * p + t.d_q * q) * inv;
    const double ap = t.d_p * inv, aq = t.d_q * inv;
    const double gx = -(radial * ux + ap * nix + aq * njx);
    const double gy = -(radial * uy + ap * niy + aq * njy);
    const double gz = -(radial * uz + ap * niz + aq * njz);
    b.fx[m] = gx;
    b.fy[m] = gy;
    b.fz[m] = gz;
    fx -= gx;
    fy -= gy;
    fz -= gz;
    const double tp = legacy ? 0.0 : t.d_p, tq = legacy ? 0.0 : t.d_q, tc = legacy ? t.d_c_crossing : t.d_c;
    const double aix = tp * ux + tc * njx, aiy = tp * uy + tc * njy, aiz = tp * uz + tc * njz;
    const double ajx = tq * ux + tc * nix, ajy = tq * uy + tc * niy, ajz = tq * uz + tc * niz;
    tx += aiy * niz - aiz * niy;
    ty += aiz * nix - aix * niz;
    tz += aix * niy - aiy * nix;
    b.tx[m] = ajy * njz - ajz * njy;
    b.ty[m] = ajz * njx - ajx * njz;
    b.tz[m] = ajx * njy - ajy * njx;
    energy += t.energy;
  }
  sum.fx += fx;
  sum.fy += fy;
  sum.fz += fz;
  sum.tx += tx;
  sum.ty += ty;
  sum.tz += tz;
  sum.energy += energy;
}

struct KernelInput {
  const PaperContact* law;
  const ContactViscosity* viscosity;  // null: none
  const State* state;
  const Vec3Array* axis;
  const int* index;
  double cutoff2;
  double nowhere;  // a distance at which the law is zero
};

}  // namespace

struct ContactKernel {
  using Buffer = ForceEngine::Buffer;

  static void damp(const KernelInput& in, int i, const PairBlock& b, const NeighbourList::Chunk& chunk,
                   ElementSum& sum, Buffer& out) {
    const ContactViscosity& viscosity = *in.viscosity;
    const Vector3 vi = in.state->velocity[static_cast<std::size_t>(i)];
    const Vector3 wi = in.state->angular_velocity[static_cast<std::size_t>(i)];
    for (int m = 0; m < b.count; ++m) {
      if (b.r[m] >= viscosity.outer) continue;
      const auto j = static_cast<std::size_t>(b.j[m]);
      const DampingForce d = viscosity.force({b.dx[m], b.dy[m], b.dz[m]}, vi, wi, in.state->velocity[j],
                                             in.state->angular_velocity[j]);
      const auto at = j - static_cast<std::size_t>(chunk.touched_begin);
      out.fx[at] += d.force_j.x();
      out.fy[at] += d.force_j.y();
      out.fz[at] += d.force_j.z();
      out.tx[at] += d.torque_j.x();
      out.ty[at] += d.torque_j.y();
      out.tz[at] += d.torque_j.z();
      sum.fx -= d.force_j.x();
      sum.fy -= d.force_j.y();
      sum.fz -= d.force_j.z();
      sum.tx += d.torque_i.x();
      sum.ty += d.torque_i.y();
      sum.tz += d.torque_i.z();
      out.power += d.power;
    }
  }

  template <class Powers, bool legacy>
  static inline __attribute__((always_inline)) void run(const KernelInput& in, const NeighbourList& list,
                                                        const NeighbourList::Chunk& chunk, Buffer& out) {
    const Vec3Array& x = in.state->position;
    const Vec3Array& n = *in.axis;
    const double *px = x.x.data(), *py = x.y.data(), *pz = x.z.data();
    const double *ax = n.x.data(), *ay = n.y.data(), *az = n.z.data();
    PairBlock b;
    for (int i = chunk.begin; i < chunk.end; ++i) {
      const double xi = px[i], yi = py[i], zi = pz[i];
      ElementSum sum;
      const std::size_t end = list.begin(i + 1);
      std::size_t k = list.begin(i);
      while (k < end) {
        b.count = 0;
        for (; k < end && b.count < block; ++k) {
          const int j = in.index[k];
          const double dx = px[j] - xi, dy = py[j] - yi, dz = pz[j] - zi;
          const double r2 = dx * dx + dy * dy + dz * dz;
          const int m = b.count;
          b.dx[m] = dx;
          b.dy[m] = dy;
          b.dz[m] = dz;
          b.r[m] = r2;
          b.j[m] = j;
          b.count += r2 < in.cutoff2;
        }
        for (int m = 0; m < b.count; ++m) {
          const int j = b.j[m];
          b.r[m] = std::sqrt(std::max(b.r[m], 1e-12));
          b.nx[m] = ax[j];
          b.ny[m] = ay[j];
          b.nz[m] = az[j];
        }
        for (int m = b.count; m % lanes != 0; ++m) {
          b.dx[m] = b.r[m] = in.nowhere;
          b.dy[m] = b.dz[m] = b.nx[m] = b.ny[m] = 0;
          b.nz[m] = 1;
        }
        evaluate<Powers, legacy>(*in.law, b, ax[i], ay[i], az[i], sum);
        for (int m = 0; m < b.count; ++m) {
          const int at = b.j[m] - chunk.touched_begin;
          out.fx[at] += b.fx[m];
          out.fy[at] += b.fy[m];
          out.fz[at] += b.fz[m];
          out.tx[at] += b.tx[m];
          out.ty[at] += b.ty[m];
          out.tz[at] += b.tz[m];
        }
        if (in.viscosity) damp(in, i, b, chunk, sum, out);
      }
      const int at = i - chunk.touched_begin;
      out.fx[at] += sum.fx;
      out.fy[at] += sum.fy;
      out.fz[at] += sum.fz;
      out.tx[at] += sum.tx;
      out.ty[at] += sum.ty;
      out.tz[at] += sum.tz;
      out.energy += sum.energy;
    }
  }

  ROPEWALK_VECTOR_CLONES
  static void published(const KernelInput& in, const NeighbourList& list, const NeighbourList::Chunk& chunk,
                        Buffer& out);
  ROPEWALK_VECTOR_CLONES
  static void published_legacy(const KernelInput& in, const NeighbourList& list, const NeighbourList::Chunk& chunk,
                               Buffer& out);
  static void general(const KernelInput& in, const NeighbourList& list, const NeighbourList::Chunk& chunk,
                      Buffer& out, bool legacy) {
    if (legacy) {
      run<GeneralPowers, true>(in, list, chunk, out);
    } else {
      run<GeneralPowers, false>(in, list, chunk, out);
    }
  }
};

ROPEWALK_VECTOR_CLONES
void ContactKernel::published(const KernelInput& in, const NeighbourList& list, const NeighbourList::Chunk& chunk,
                              Buffer& out) {
  run<PublishedPowers, false>(in, list, chunk, out);
}

ROPEWALK_VECTOR_CLONES
void ContactKernel::published_legacy(const KernelInput& in, const NeighbourList& list,
                                     const NeighbourList::Chunk& chunk, Buffer& out) {
  run<PublishedPowers, true>(in, list, chunk, out);
}

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
  for (const Buffer& b : buffers_) total += 6 * b.fx.capacity() * sizeof(double);
  return total;
}

void ForceEngine::compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
                          const State& state, Forces& out) {
  const double t0 = omp_get_wtime();
  make_frames(state);
  const double t1 = omp_get_wtime();

  const bool contact = interaction.paper.has_value();
  if (contact) {
    const KernelInput in{&*interaction.paper,
                         interaction.damped_contact() ? &interaction.damping.contact : nullptr,
                         &state,
                         &axis_,
                         list.indices(),
                         interaction.cutoff() * interaction.cutoff(),
                         2.0 * interaction.cutoff()};
#pragma omp parallel for schedule(dynamic, 1) if (state.size() > parallel_from)
    for (int k = 0; k < NeighbourList::chunk_count; ++k) {
      const auto& chunk = list.chunks()[static_cast<std::size_t>(k)];
      Buffer& b = buffers_[static_cast<std::size_t>(k)];
      const auto width = static_cast<std::size_t>(chunk.touched_end - chunk.touched_begin);
      for (auto* v : {&b.fx, &b.fy, &b.fz, &b.tx, &b.ty, &b.tz}) v->assign(width, 0.0);
      b.energy = b.power = 0;
      if (!interaction.paper->has_published_powers()) {
        ContactKernel::general(in, list, chunk, b, interaction.legacy_torque);
      } else if (interaction.legacy_torque) {
        ContactKernel::published_legacy(in, list, chunk, b);
      } else {
        ContactKernel::published(in, list, chunk, b);
      }
    }
  }
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
        const Buffer& b = buffers_[static_cast<std::size_t>(k)];
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
    for (int i = from; i + 1 < to; ++i) {
      const auto si = static_cast<std::size_t>(i), sj = si + 1;
      const Vector3 separation = state.position[sj] - state.position[si];
      const Frame<double>&fi = frames_[si], &fj = frames_[sj];
      const BondForce<double> f =
          bond_energy_and_gradient(interaction.bond, topology.element_length, separation, fi, fj);
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
        const DampingForce d = interaction.damping.bond.force(topology.mass, topology.inertia, separation,
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
    for (const Buffer& b : buffers_) {
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
  double translation = 0, rotation = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    translation += state.velocity[i].squaredNorm();
    rotation += state.angular_velocity[i].squaredNorm();
  }
  return 0.5 * (topology.mass * translation + topology.inertia * rotation);
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
