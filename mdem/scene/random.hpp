// Random numbers that are the same with every standard library: std::mt19937_64 is specified to the bit, the
// distributions of <random> are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "model/units.hpp"

namespace ropewalk {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // In (0, 1): the middles of 2^53 equal steps.
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
  double uniform(double least, double most) { return least + (most - least) * uniform(); }

  // Normal with variance 1, by Box and Muller.
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double length = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * units::pi * uniform();
    spare_ = length * std::sin(angle);
    has_spare_ = true;
    return length * std::cos(angle);
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace ropewalk
