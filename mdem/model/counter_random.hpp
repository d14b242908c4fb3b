// Random numbers that are a function of a counter: no state to keep, and any of them at any time, by any thread.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "model/units.hpp"

namespace ropewalk {

// Philox-4x32-10: 128 random bits of a 128-bit counter and a 64-bit key. J. K. Salmon, M. A. Moraes, R. O. Dror,
// D. E. Shaw, SC11 (2011), DOI 10.1145/2063384.2063405.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c, std::uint64_t key) {
  auto k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * c[0], b = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(b >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(b),
         static_cast<std::uint32_t>(a >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(a)};
    k0 += 0x9E3779B9;
    k1 += 0xBB67AE85;
  }
  return c;
}

// The key for other numbers of the same seed, one for each lineage; the seed itself for none, 0.
inline std::uint64_t lineage_key(std::uint64_t seed, std::uint64_t lineage) {
  if (lineage == 0) return seed;
  const auto bits =
      philox({static_cast<std::uint32_t>(lineage), static_cast<std::uint32_t>(lineage >> 32), 0, 0}, seed);
  return bits[0] | std::uint64_t{bits[1]} << 32;
}

// In (0, 1): the middles of 2^32 equal steps.
inline double unit_interval(std::uint32_t bits) { return (bits + 0.5) * 0x1p-32; }

// Two independent normal numbers of variance 1, by Box and Muller.
inline std::array<double, 2> normal_pair(std::uint32_t a, std::uint32_t b) {
  const double length = std::sqrt(-2 * std::log(unit_interval(a))), angle = 2 * units::pi * unit_interval(b);
  return {length * std::cos(angle), length * std::sin(angle)};
}

}  // namespace ropewalk
