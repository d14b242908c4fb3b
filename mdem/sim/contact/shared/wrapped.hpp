// Coordinates of the kernels in single precision: whole numbers of a unit (nm), modulo 2^32. Only differences
// between elements near each other are used. They are exact, however large the scene is and wherever it lies.
#pragma once

#include <cstdint>

namespace ropewalk {

// x + rounds_to_whole has the whole number nearest to x in front of the last bits_behind_point bits of its
// mantissa, for |x| < 2^49: 1.5 * 2^50, and a half since the bits behind the point are cut off.
inline constexpr int bits_behind_point = 2;
inline constexpr double rounds_to_whole = 0x1.8p50 + 0.5;

// nm: coordinates beyond do not fit, in units of 2^-24 nm.
inline constexpr double farthest_coordinate = 0x1p25;

inline std::int32_t wrapped_difference(std::int32_t to, std::int32_t from) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}
inline double wrapped_difference(double to, double from) { return to - from; }

}  // namespace ropewalk
