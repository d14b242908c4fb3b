// Random numbers of a normal distribution. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// normal_pair() in loops that the compiler vectorises. Where sine and cosine of an angle stand in one loop, GCC takes
// both from one function that it has for single numbers alone.
void to_normals(const double (&radial)[3][group], const double (&angular)[3][group], Normals& out) {
  for (int pair = 0; pair < 3; ++pair) {
    double length[group], angle[group];
#pragma omp simd
    for (int k = 0; k < group; ++k) {
      length[k] = std::sqrt(-2 * std::log(radial[pair][k]));
      angle[k] = 2 * units::pi * angular[pair][k];
    }
#pragma omp simd
    for (int k = 0; k < group; ++k) out.of[2 * pair][k] = length[k] * std::cos(angle[k]);
#pragma omp simd
    for (int k = 0; k < group; ++k) out.of[2 * pair + 1][k] = length[k] * std::sin(angle[k]);
  }
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
