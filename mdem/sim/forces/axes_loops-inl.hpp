// Axes of the elements. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

void axes_of(const QuaternionArray& q, std::ptrdiff_t begin, std::ptrdiff_t end, Vec3Array& out) {
  const double *qw = q.w.data(), *qx = q.x.data(), *qy = q.y.data(), *qz = q.z.data();
  double *tx = out.x.data(), *ty = out.y.data(), *tz = out.z.data();
#pragma GCC ivdep
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    const forms::Vec t = forms::turn_axis({qw[i], qx[i], qy[i], qz[i]});
    tx[i] = t.x, ty[i] = t.y, tz[i] = t.z;
  }
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
