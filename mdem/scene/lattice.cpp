#include "scene/lattice.hpp"

#include <cmath>

namespace ropewalk {
namespace {

long hexagonal_number(long shells) { return 1 + 3 * shells * (shells + 1); }

}  // namespace

std::pair<int, int> nearest_hexagonal(int tubes) {
  long shells = 0;
  while (hexagonal_number(shells + 1) <= tubes) ++shells;
  const long below = hexagonal_number(shells);
  return {static_cast<int>(below), static_cast<int>(below == tubes ? below : hexagonal_number(shells + 1))};
}

std::vector<std::pair<double, double>> hexagonal_lattice(int tubes, double spacing) {
  const double h = 0.5 * std::sqrt(3.0);
  // Unit steps, at 0, 60, ..., 300 degrees.
  const std::pair<double, double> step[6] = {{1, 0}, {0.5, h}, {-0.5, h}, {-1, 0}, {-0.5, -h}, {0.5, -h}};
  std::vector<std::pair<double, double>> places = {{0.0, 0.0}};
  for (int shell = 1; static_cast<int>(places.size()) < tubes; ++shell)
    for (int side = 0; side < 6; ++side)
      for (int k = 0; k < shell; ++k) {
        // Steps from the corner of this side towards the next.
        const auto& corner = step[side];
        const auto& along = step[(side + 2) % 6];
        places.emplace_back(spacing * (shell * corner.first + k * along.first),
                            spacing * (shell * corner.second + k * along.second));
      }
  return places;
}

int whole_elements(double length, double element_length) {
  return static_cast<int>(std::lround(length / element_length));
}

}  // namespace ropewalk
