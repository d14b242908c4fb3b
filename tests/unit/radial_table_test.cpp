// The kernel's polynomials against the law that they stand for.
#include "sim/radial_table.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "unit/support.hpp"

namespace ropewalk {
namespace {

struct Read {
  double energy = 0, force = 0;  // eV/nm^2, eV/nm^3
};

// What the kernel does, one distance at a time.
template <class Table, class Bits>
Read read(const Table& t, double rho) {
  using T = typename Table::Value;
  const T at = static_cast<T>(rho / static_cast<double>(t.unit)), X = at * at, y = t.scale * X + t.shift;
  if (X >= t.cutoff2) return {};
  Bits bits;
  std::memcpy(&bits, &y, sizeof bits);
  const auto k = static_cast<std::size_t>(bits >> Table::mantissa_left) % Table::segments;
  const Bits start_bits = bits >> Table::mantissa_left << Table::mantissa_left;
  T start;
  std::memcpy(&start, &start_bits, sizeof start);
  const T s = y - start;
  T p = t.c[Table::degree][k], dp = 0;
  for (int m = Table::degree - 1; m >= 0; --m) {
    dp = dp * s + p;
    p = p * s + t.c[m][k];
  }
  return {static_cast<double>(p), static_cast<double>(t.force * dp) * rho / static_cast<double>(t.unit)};
}

template <class Table, class Bits>
void expect_close(double radius_i, double radius_j, double unit, double tolerance) {
  const LineDensity law = test::line_density(radius_i, radius_j);
  const Table table(law, unit);
  const double well = std::fabs(law.energy(line_parallel_well(law).distance));
  // From the core, where u is a hundred times the well, to beyond the cutoff.
  for (double rho = law.contact + law.core_gap + 1e-6; rho < law.cutoff() + 0.2; rho += 1.7e-4) {
    const RadialTerms t = law.terms(rho);
    const Read r = read<Table, Bits>(table, rho);
    ASSERT_NEAR(r.energy, t.energy, tolerance * (well + std::fabs(t.energy))) << rho;
    const auto at = static_cast<typename Table::Value>(rho / unit);
    ASSERT_EQ(static_cast<double>(table.energy(at * at)), r.energy) << rho;
    ASSERT_NEAR(r.force, -t.derivative, 10 * tolerance * (20 * well + std::fabs(t.derivative))) << rho;
  }
}

TEST(RadialTable, FollowsTheLaw) {
  for (const auto& [a, b] : {std::pair(0.34, 0.34), std::pair(0.6785, 0.6785), std::pair(1.36, 0.34)}) {
    expect_close<MixedTable, std::uint32_t>(a, b, std::exp2(-22), 2e-5);
    expect_close<FullTable, std::uint64_t>(a, b, 1, 1e-11);
  }
}

// The force is the derivative of the energy of the table itself, also where that is off the law.
TEST(RadialTable, ForceIsItsOwnDerivative) {
  const LineDensity law = test::line_density();
  const FullTable table(law, 1);
  for (double rho = law.contact + law.core_gap + 1e-3; rho < law.cutoff() - 1e-3; rho += 1.3e-3) {
    const auto energy = [&](double h) { return read<FullTable, std::uint64_t>(table, rho + h).energy; };
    const double force = read<FullTable, std::uint64_t>(table, rho).force;
    ASSERT_NEAR(force, -test::derivative(energy, 1e-5), 1e-6 * (1 + std::fabs(force))) << rho;
  }
}

}  // namespace
}  // namespace ropewalk
