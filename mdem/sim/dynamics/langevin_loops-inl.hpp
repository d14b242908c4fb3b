// Random numbers of a normal distribution. Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

// normal_pair() in loops that the compiler vectorises.
void to_normals(const double (&radial)[3][group], const double (&angular)[3][group], Normals& out) {
  for (int pair = 0; pair < 3; ++pair)
#pragma omp simd
    for (int k = 0; k < group; ++k) {
      const double length = std::sqrt(-2 * std::log(radial[pair][k])), angle = 2 * units::pi * angular[pair][k];
      out.of[2 * pair][k] = length * std::cos(angle);
      out.of[2 * pair + 1][k] = length * std::sin(angle);
    }
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
