// Axes of the elements. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// axis_of() over plain numbers, which the compiler vectorises.
void axes_of(const QuaternionArray& q, std::ptrdiff_t begin, std::ptrdiff_t end, Vec3Array& out) {
  const double *qw = q.w.data(), *qx = q.x.data(), *qy = q.y.data(), *qz = q.z.data();
  double *tx = out.x.data(), *ty = out.y.data(), *tz = out.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const double w = qw[i], x = qx[i], y = qy[i], z = qz[i];
    tx[i] = 2 * (x * z + w * y), ty[i] = 2 * (y * z - w * x), tz[i] = 1 - 2 * (x * x + y * y);
  }
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
