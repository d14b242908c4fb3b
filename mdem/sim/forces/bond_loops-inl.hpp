// Forces of bonds. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// Frames of the elements begin .. end - 1; element `origin` becomes frame 0.
void frames_of(const QuaternionArray& q, std::ptrdiff_t origin, std::ptrdiff_t begin, std::ptrdiff_t end,
               FrameArray& out) {
  const double *qw = q.w.data() + origin, *qx = q.x.data() + origin, *qy = q.y.data() + origin,
               *qz = q.z.data() + origin;
  double *ax = out.e1.x.data(), *ay = out.e1.y.data(), *az = out.e1.z.data(), *bx = out.e2.x.data(),
         *by = out.e2.y.data(), *bz = out.e2.z.data(), *tx = out.t.x.data(), *ty = out.t.y.data(),
         *tz = out.t.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin - origin; i < end - origin; ++i) {
    const forms::BodyFrame f = forms::turn_frame({qw[i], qx[i], qy[i], qz[i]});
    ax[i] = f.e1.x, ay[i] = f.e1.y, az[i] = f.e1.z;
    bx[i] = f.e2.x, by[i] = f.e2.y, bz[i] = f.e2.z;
    tx[i] = f.t.x, ty[i] = f.t.y, tz[i] = f.t.z;
  }
}

// Returns their energies; `slips` becomes negative where a bond does.
template <bool anharmonic>
__attribute__((always_inline)) inline BondEnergy bond_forces(const TubeType& type, const Vec3Array& position,
                                                             const FrameArray& frames, const BondRange& bonds,
                                                             BondArray& out, double& slips) {
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
    const forms::BodyFrame fi{{ax[i], ay[i], az[i]}, {bx[i], by[i], bz[i]}, {tx[i], ty[i], tz[i]}};
    const forms::BodyFrame fj{{ax[j], ay[j], az[j]}, {bx[j], by[j], bz[j]}, {tx[j], ty[j], tz[j]}};
    const forms::Vec separation{x[j] - x[i], y[j] - y[i], z[j] - z[i]};
    const double share = even_shear_share(k, a);
    const forms::BondAction f = anharmonic
                                    ? forms::window_bond(&k, share, a, separation, fi, fj, bond_twist_angle(fi, fj))
                                    : forms::harmonic_bond(&k, share, a, separation, fi, fj);
    fx[i] = f.force_j.x, fy[i] = f.force_j.y, fz[i] = f.force_j.z;
    ix[i] = f.torque_i.x, iy[i] = f.torque_i.y, iz[i] = f.torque_i.z;
    jx[i] = f.torque_j.x, jy[i] = f.torque_j.y, jz[i] = f.torque_j.z;
    stretch += f.energy.stretch;
    shear += f.energy.shear;
    bend += f.energy.bend;
    twist += f.energy.twist;
    smallest = std::min(smallest, forms::twist_cosine(fi, fj));
  }
  slips = smallest;
  return {stretch, shear, bend, twist};
}

__attribute__((flatten)) BondEnergy harmonic_forces(const TubeType& type, const Vec3Array& position,
                                                    const FrameArray& frames, const BondRange& bonds,
                                                    BondArray& out, double& slips) {
  return bond_forces<false>(type, position, frames, bonds, out, slips);
}

__attribute__((flatten)) BondEnergy anharmonic_forces(const TubeType& type, const Vec3Array& position,
                                                      const FrameArray& frames, const BondRange& bonds,
                                                      BondArray& out, double& slips) {
  return bond_forces<true>(type, position, frames, bonds, out, slips);
}

// Bonds with a natural shape or two stiffnesses of bending, else as harmonic_forces().
__attribute__((flatten)) BondEnergy shaped_forces(const TubeType& type, const Vec3Array& position,
                                                  const FrameArray& frames, const BondRange& bonds, BondArray& out,
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
  const BondShape shape = bond_shape(k, a);
  double stretch = 0, shear = 0, bend = 0, twist = 0, smallest = 1;
#pragma GCC ivdep
  for (std::ptrdiff_t i = from; i < to; ++i) {
    const std::ptrdiff_t j = i + 1;
    const forms::BodyFrame fi = forms::frame_turned(
        {{ax[i], ay[i], az[i]}, {bx[i], by[i], bz[i]}, {tx[i], ty[i], tz[i]}}, shape.turn);
    const forms::BodyFrame fj = forms::frame_turned_back(
        {{ax[j], ay[j], az[j]}, {bx[j], by[j], bz[j]}, {tx[j], ty[j], tz[j]}}, shape.turn);
    const forms::Vec separation{x[j] - x[i], y[j] - y[i], z[j] - z[i]};
    const forms::BondAction f = forms::shaped_bond(&k, shape.share, shape.shear_difference, a, separation, fi, fj);
    fx[i] = f.force_j.x, fy[i] = f.force_j.y, fz[i] = f.force_j.z;
    ix[i] = f.torque_i.x, iy[i] = f.torque_i.y, iz[i] = f.torque_i.z;
    jx[i] = f.torque_j.x, jy[i] = f.torque_j.y, jz[i] = f.torque_j.z;
    stretch += f.energy.stretch;
    shear += f.energy.shear;
    bend += f.energy.bend;
    twist += f.energy.twist;
    smallest = std::min(smallest, forms::twist_cosine(fi, fj));
  }
  slips = smallest;
  return {stretch, shear, bend, twist};
}

// A loop of its own, so that bonds within the window have the bits of the loop above.
double largest_strain(const TubeType& type, const Vec3Array& position, const FrameArray& frames,
                      const BondRange& bonds) {
  const double *x = position.x.data() + bonds.begin, *y = position.y.data() + bonds.begin,
               *z = position.z.data() + bonds.begin;
  const double *tx = frames.t.x.data(), *ty = frames.t.y.data(), *tz = frames.t.z.data();
  const double a = type.element_length;
  double largest = -1;
#pragma GCC ivdep
  for (std::ptrdiff_t i = bonds.from; i < bonds.to; ++i) {
    const std::ptrdiff_t j = i + 1;
    const double length = std::sqrt(forms::vec_norm2({x[j] - x[i], y[j] - y[i], z[j] - z[i]}));
    const forms::BodyFrame fi{{}, {}, {tx[i], ty[i], tz[i]}}, fj{{}, {}, {tx[j], ty[j], tz[j]}};  // axes alone
    largest = std::max(largest, forms::arc_strain(a, length, fi, fj));
  }
  return largest;
}

// Adds to these bonds what the law of stretch adds beyond its window, where few are; returns the energy.
double add_beyond(const TubeType& type, const Vec3Array& position, const FrameArray& frames, const BondRange& bonds,
                  BondArray& out) {
  double energy = 0;
  for (std::ptrdiff_t i = bonds.from; i < bonds.to; ++i) {
    const auto at = static_cast<std::size_t>(i), from = static_cast<std::size_t>(bonds.begin + i);
    const forms::BondAction f =
        forms::bond_beyond(&type.bond, type.element_length, plain(position[from + 1] - position[from]),
                           plain(frames[at]), plain(frames[at + 1]));
    out.force_j.add(at, vector(f.force_j));
    out.torque_i.add(at, vector(f.torque_i));
    out.torque_j.add(at, vector(f.torque_j));
    energy += f.energy.stretch;
  }
  return energy;
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
  const double rate = damping.rate, mass = type.mass, inertia = type.inertia;
#pragma GCC ivdep
  for (std::ptrdiff_t i = from; i < to; ++i) {
    const std::ptrdiff_t j = i + 1;
    const forms::PairDamping d =
        forms::bond_damping(rate, mass, inertia, {x[j] - x[i], y[j] - y[i], z[j] - z[i]}, {vx[i], vy[i], vz[i]},
                            {wx[i], wy[i], wz[i]}, {vx[j], vy[j], vz[j]}, {wx[j], wy[j], wz[j]});
    fx[i] += d.force_j.x, fy[i] += d.force_j.y, fz[i] += d.force_j.z;
    ix[i] += d.torque_i.x, iy[i] += d.torque_i.y, iz[i] += d.torque_i.z;
    jx[i] += d.torque_j.x, jy[i] += d.torque_j.y, jz[i] += d.torque_j.z;
    power += d.power;
  }
  return power;
}

// Collects the action of `bonds` bonds of a tube on the elements from .. to - 1, numbered from the first bond's
// element: bond i acts on the elements i and i + 1.
void collect_bonds(const Column& on_i, double sign_i, const Column& on_j, std::ptrdiff_t bonds, std::ptrdiff_t from,
                   std::ptrdiff_t to, double* out) {
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
