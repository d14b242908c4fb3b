// Sums of contact buffers. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// Adds a buffer's forces on elements of a tube, element j at j + shift.
template <class T>
__attribute__((always_inline)) inline void add_all(const BufferRange& of, const ContactBuffer<T>& b,
                                                   const ForceRows& sums) {
  const std::vector<T>* const from[6] = {&b.fx, &b.fy, &b.fz, &b.tx, &b.ty, &b.tz};
  Vec3Array &force = sums.force, &torque = sums.torque;
  Column* const to[6] = {&force.x, &force.y, &force.z, &torque.x, &torque.y, &torque.z};
  for (int a = 0; a < 6; ++a) {
    const T* const on = from[a]->data() + of.begin + of.shift;
    double* const sum = to[a]->data() + of.begin - sums.origin;
#pragma omp simd
    for (int i = 0; i < of.end - of.begin; ++i) sum[i] += static_cast<double>(on[i]);
  }
}
void add_floats(const BufferRange& of, const ContactBuffer<float>& b, const ForceRows& sums) {
  add_all(of, b, sums);
}
void add_doubles(const BufferRange& of, const ContactBuffer<double>& b, const ForceRows& sums) {
  add_all(of, b, sums);
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
