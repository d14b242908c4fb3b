// Forces of bonds. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// frame_of() over plain numbers, which the compiler vectorises; element `origin` becomes frame 0.
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

__attribute__((flatten)) BondEnergy<double> harmonic_forces(const TubeType& type, const Vec3Array& position,
                                                            const FrameArray& frames, const BondRange& bonds,
                                                            BondArray& out, double& slips) {
  return bond_forces<false>(type, position, frames, bonds, out, slips);
}

__attribute__((flatten)) BondEnergy<double> anharmonic_forces(const TubeType& type, const Vec3Array& position,
                                                              const FrameArray& frames, const BondRange& bonds,
                                                              BondArray& out, double& slips) {
  return bond_forces<true>(type, position, frames, bonds, out, slips);
}

// Adds the damping of these bonds; returns its power.
double bond_damping(const TubeType& type, const BondDamping& damping, const State& s, const BondRange& bonds,
                    BondArray& out) {
  const std::ptrdiff_t from = bonds.from, to = bonds.to;
  const auto at = [&](const Column& v) { return v.data() + bonds.begin; };
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

// Collects the action of `bonds` bonds of a tube on the elements from .. to - 1, numbered from the first bond's element:
// bond i acts on the elements i and i + 1.
void collect_bonds(const Column& on_i, double sign_i, const Column& on_j,
                   std::ptrdiff_t bonds, std::ptrdiff_t from, std::ptrdiff_t to, double* out) {
  const double *a = on_i.data(), *b = on_j.data();
  if (from == 0) out[0] = bonds > 0 ? sign_i * a[0] : 0.0;
#pragma omp simd
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(from, 1); i < std::min(to, bonds); ++i)
    out[i - from] = sign_i * a[i] + b[i - 1];
  if (bonds > 0 && to == bonds + 1) out[bonds - from] = b[bonds - 1];
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
