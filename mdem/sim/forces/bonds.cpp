#include "sim/forces/bonds.hpp"

#include <algorithm>

#include "sim/state/plain_vector.hpp"
#include "sim/threads/vector_clones.hpp"

namespace ropewalk {
namespace {

// frame_of() over plain numbers, which the compiler vectorises; element `origin` becomes frame 0.
ROPEWALK_VECTOR_CLONES
void frames_of(const QuaternionArray& q, std::ptrdiff_t origin, std::ptrdiff_t begin, std::ptrdiff_t end,
               FrameArray& out) {
  const double *qw = q.w.data() + origin, *qx = q.x.data() + origin, *qy = q.y.data() + origin,
               *qz = q.z.data() + origin;
  double *ax = out.e1.x.data(), *ay = out.e1.y.data(), *az = out.e1.z.data(), *bx = out.e2.x.data(),
         *by = out.e2.y.data(), *bz = out.e2.z.data(), *tx = out.t.x.data(), *ty = out.t.y.data(),
         *tz = out.t.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin - origin; i < end - origin; ++i) {
    const double w = qw[i], x = qx[i], y = qy[i], z = qz[i];
    ax[i] = 1 - 2 * (y * y + z * z), ay[i] = 2 * (x * y + w * z), az[i] = 2 * (x * z - w * y);
    bx[i] = 2 * (x * y - w * z), by[i] = 1 - 2 * (x * x + z * z), bz[i] = 2 * (y * z + w * x);
    tx[i] = 2 * (x * z + w * y), ty[i] = 2 * (y * z - w * x), tz[i] = 1 - 2 * (x * x + y * y);
  }
}

// Consecutive bonds of a tube, counted from its element `begin`, which frame 0 is of.
struct BondRange {
  std::ptrdiff_t begin, from, to;
};

// Returns their energies; `slips` becomes negative where a bond does.
template <bool anharmonic>
__attribute__((always_inline)) inline BondEnergy<double> bond_forces(const TubeType& type,
                                                                     const Vec3Array& position,
                                                                     const FrameArray& frames,
                                                                     const BondRange& bonds, BondArray& out,
                                                                     double& slips) {
  const std::ptrdiff_t begin = bonds.begin, from = bonds.from, to = bonds.to;
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
  for (std::ptrdiff_t i = from; i < to; ++i) {
    const std::ptrdiff_t j = i + 1;
    const Frame<double, PlainVector> fi{{ax[i], ay[i], az[i]}, {bx[i], by[i], bz[i]}, {tx[i], ty[i], tz[i]}};
    const Frame<double, PlainVector> fj{{ax[j], ay[j], az[j]}, {bx[j], by[j], bz[j]}, {tx[j], ty[j], tz[j]}};
    const PlainVector separation{x[j] - x[i], y[j] - y[i], z[j] - z[i]};
    const BondForce<double, PlainVector> f =
        anharmonic ? anharmonic_force(k, a, separation, fi, fj) : harmonic_force(k, a, separation, fi, fj);
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

ROPEWALK_VECTOR_CLONES __attribute__((flatten)) BondEnergy<double> harmonic_forces(
    const TubeType& type, const Vec3Array& position, const FrameArray& frames, const BondRange& bonds,
    BondArray& out, double& slips) {
  return bond_forces<false>(type, position, frames, bonds, out, slips);
}

ROPEWALK_VECTOR_CLONES __attribute__((flatten)) BondEnergy<double> anharmonic_forces(
    const TubeType& type, const Vec3Array& position, const FrameArray& frames, const BondRange& bonds,
    BondArray& out, double& slips) {
  return bond_forces<true>(type, position, frames, bonds, out, slips);
}

// Adds the damping of these bonds; returns its power.
ROPEWALK_VECTOR_CLONES
double bond_damping(const TubeType& type, const BondDamping& damping, const State& s, const BondRange& bonds,
                    BondArray& out) {
  const std::ptrdiff_t from = bonds.from, to = bonds.to;
  const auto at = [&](const std::vector<double>& v) { return v.data() + bonds.begin; };
  const double *x = at(s.position.x), *y = at(s.position.y), *z = at(s.position.z);
  const double *vx = at(s.velocity.x), *vy = at(s.velocity.y), *vz = at(s.velocity.z);
  const double *wx = at(s.angular_velocity.x), *wy = at(s.angular_velocity.y), *wz = at(s.angular_velocity.z);
  double *fx = out.force_j.x.data(), *fy = out.force_j.y.data(), *fz = out.force_j.z.data();
  double *ix = out.torque_i.x.data(), *iy = out.torque_i.y.data(), *iz = out.torque_i.z.data();
  double *jx = out.torque_j.x.data(), *jy = out.torque_j.y.data(), *jz = out.torque_j.z.data();
  double power = 0;
  const BondDamping law = damping;
  const double mass = type.mass, inertia = type.inertia;
#pragma GCC ivdep
  for (std::ptrdiff_t i = from; i < to; ++i) {
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

// What the bonds of a tube, of which there are so many here, do to the elements from .. to - 1, the first one's at
// 0: bond i acts on the elements i and i + 1.
ROPEWALK_VECTOR_CLONES
void collect_bonds(const std::vector<double>& on_i, double sign_i, const std::vector<double>& on_j,
                   std::ptrdiff_t bonds, std::ptrdiff_t from, std::ptrdiff_t to, double* out) {
  const double *a = on_i.data(), *b = on_j.data();
  if (from == 0) out[0] = bonds > 0 ? sign_i * a[0] : 0.0;
#pragma omp simd
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(from, 1); i < std::min(to, bonds); ++i)
    out[i - from] = sign_i * a[i] + b[i - 1];
  if (bonds > 0 && to == bonds + 1) out[bonds - from] = b[bonds - 1];
}

// The bonds of the range, with their damping: into `work`, from the frames in it.
BondSum bonds_of(const BondInput& in, int tube, const BondRange& range, TubeBonds& work) {
  const TubeType& type = in.topology.type_of(tube);
  BondSum sum;
  double slips = 1;
  const auto forces = type.bond.anharmonic.used ? anharmonic_forces : harmonic_forces;
  sum.energy = forces(type, in.state.position, work.frames, range, work.bonds, slips);
  for (std::ptrdiff_t i = range.from; !(slips > 0) && i < range.to && sum.slipping < 0; ++i) {
    const Frame<double> fi = work.frames[static_cast<std::size_t>(i)],
                        fj = work.frames[static_cast<std::size_t>(i + 1)];
    if (!(fi.e1.dot(fj.e1) + fi.e2.dot(fj.e2) > 0)) sum.slipping = static_cast<int>(range.begin + i);
  }
  if (in.damping.rate > 0) sum.power = bond_damping(type, in.damping, in.state, range, work.bonds);
  return sum;
}

void put(const Joint& joint, std::size_t at, BondArray& bonds) {
  bonds.force_j.set(at, joint.force_j);
  bonds.torque_i.set(at, joint.torque_i);
  bonds.torque_j.set(at, joint.torque_j);
}

}  // namespace

void add(const BondSum& of, BondSum& sum) {
  sum.energy.stretch += of.energy.stretch;
  sum.energy.shear += of.energy.shear;
  sum.energy.bend += of.energy.bend;
  sum.energy.twist += of.energy.twist;
  sum.power += of.power;
  if (sum.slipping < 0) sum.slipping = of.slipping;
}

void add_behind(const Joint& bond, int element, const ForceRows& out) {
  const auto at = static_cast<std::size_t>(element - out.origin);
  out.force.add(at, bond.force_j);
  out.torque.add(at, bond.torque_j);
}

Joint joint_behind(const BondInput& in, int tube, int i) {
  thread_local TubeBonds work;
  work.resize(2);
  frames_of(in.state.orientation, i, i, i + 2, work.frames);
  Joint out;
  out.sum = bonds_of(in, tube, {i, 0, 1}, work);
  out.force_j = work.bonds.force_j[0];
  out.torque_i = work.bonds.torque_i[0];
  out.torque_j = work.bonds.torque_j[0];
  return out;
}

BondSum compute_bonds(const BondInput& in, const Segment& of, const Joint* before, const Joint* behind,
                      const ForceRows& out) {
  thread_local TubeBonds work;
  const std::ptrdiff_t from = before ? 1 : 0, begin = of.begin - from, to = of.end - begin,
                       bonds = to - 1 + (behind ? 1 : 0);
  BondArray& each = work.bonds;
  work.resize(static_cast<std::size_t>(to));
  frames_of(in.state.orientation, begin, of.begin, of.end, work.frames);
  BondSum sum = bonds_of(in, of.tube, {begin, from, to - 1}, work);
  if (before) put(*before, 0, each);
  if (behind) {
    put(*behind, static_cast<std::size_t>(to - 1), each);
    add(behind->sum, sum);
  }
  const auto collect = [&](const std::vector<double>& on_i, double sign_i, const std::vector<double>& on_j,
                           std::vector<double>& sums) {
    collect_bonds(on_i, sign_i, on_j, bonds, from, to, sums.data() + (of.begin - out.origin));
  };
  collect(each.force_j.x, -1, each.force_j.x, out.force.x);
  collect(each.force_j.y, -1, each.force_j.y, out.force.y);
  collect(each.force_j.z, -1, each.force_j.z, out.force.z);
  collect(each.torque_i.x, 1, each.torque_j.x, out.torque.x);
  collect(each.torque_i.y, 1, each.torque_j.y, out.torque.y);
  collect(each.torque_i.z, 1, each.torque_j.z, out.torque.z);
  return sum;
}

}  // namespace ropewalk
