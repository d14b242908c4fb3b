// Kick, drift and how far elements have come. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

void kick_elements(const Vec3Array& force, double by, Vec3Array& velocity, std::ptrdiff_t begin,
                   std::ptrdiff_t end) {
  const double *fx = force.x.data(), *fy = force.y.data(), *fz = force.z.data();
  double *vx = velocity.x.data(), *vy = velocity.y.data(), *vz = velocity.z.data();
#pragma omp simd
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    vx[i] += by * fx[i];
    vy[i] += by * fy[i];
    vz[i] += by * fz[i];
  }
}

void move_elements(State& s, double dt, std::ptrdiff_t begin, std::ptrdiff_t end) {
  double *x = s.position.x.data(), *y = s.position.y.data(), *z = s.position.z.data();
  double *qw = s.orientation.w.data(), *qx = s.orientation.x.data(), *qy = s.orientation.y.data(),
         *qz = s.orientation.z.data();
  const double *vx = s.velocity.x.data(), *vy = s.velocity.y.data(), *vz = s.velocity.z.data();
  const double *wx = s.angular_velocity.x.data(), *wy = s.angular_velocity.y.data(),
               *wz = s.angular_velocity.z.data();
#pragma omp simd
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    x[i] += dt * vx[i];
    y[i] += dt * vy[i];
    z[i] += dt * vz[i];
    const forms::Turn q = forms::turned({wx[i], wy[i], wz[i]}, dt, {qw[i], qx[i], qy[i], qz[i]});
    qw[i] = q.w, qx[i] = q.x, qy[i] = q.y, qz[i] = q.z;
  }
}

Fastest fastest(const State& s, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const double *vx = s.velocity.x.data(), *vy = s.velocity.y.data(), *vz = s.velocity.z.data();
  const double *wx = s.angular_velocity.x.data(), *wy = s.angular_velocity.y.data(),
               *wz = s.angular_velocity.z.data();
  double speed2 = 0, spin2 = 0, sum = 0;
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double v2 = vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i];
    const double w2 = wx[i] * wx[i] + wy[i] * wy[i] + wz[i] * wz[i];
    speed2 = std::max(speed2, v2);
    spin2 = std::max(spin2, w2);
    sum += v2 + w2;
  }
  return {speed2, spin2, sum};
}

Change largest_change(const State& state, const Vec3Array& position, const Vec3Array& axis, double lever,
                      const TwistOfAll& twist, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const double *x = state.position.x.data(), *y = state.position.y.data(), *z = state.position.z.data();
  const double *rx = position.x.data(), *ry = position.y.data(), *rz = position.z.data();
  const double *qw = state.orientation.w.data(), *qx = state.orientation.x.data(), *qy = state.orientation.y.data(),
               *qz = state.orientation.z.data();
  const double *nx = axis.x.data(), *ny = axis.y.data(), *nz = axis.z.data();
  const TwistOfAll by = twist;
  double moved = 0, sum = 0, spin = 0, spin_z = 0;
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double px = rx[i] - by.x, py = ry[i] - by.y, pz = rz[i] - by.middle;
    const double s = std::max(-by.most, std::min(by.sine + by.slope * pz, by.most)), c = std::sqrt(1 - s * s);
    const double vx = x[i] - by.x, vy = y[i] - by.y;
    const double dx = vx - (c * px - s * py), dy = vy - (s * px + c * py), dz = z[i] - rz[i];
    const forms::Vec n = forms::turn_axis({qw[i], qx[i], qy[i], qz[i]});
    const double ax = n.x - (c * nx[i] - s * ny[i]), ay = n.y - (s * nx[i] + c * ny[i]), az = n.z - nz[i];
    const double turn = std::sqrt(ax * ax + ay * ay + az * az);
    const double d = std::sqrt(dx * dx + dy * dy + dz * dz) + lever * turn;
    const double product = px * vy - py * vx;
    moved = std::max(moved, d);
    sum += d;
    spin += product;
    spin_z += pz * product;
  }
  return {moved, sum, spin, spin_z};
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
