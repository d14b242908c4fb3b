// The kernel's polynomials against the law that they stand for.
#include "sim/contact/line/radial_table.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "unit/support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

struct Read {
  double energy = 0, force = 0;  // eV/nm^2, eV/nm^3
};

// Reads the table as the kernel does, but for the order of its sums, one distance at a time.
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

// And where it takes the pieces of the table of which these are.
template <class T, int degree, class Table>
Read read(const RadialPieces<T, degree>& t, const Table& of, double rho) {
  const T at = static_cast<T>(rho / static_cast<double>(of.unit)), X = at * at;
  if (X >= of.cutoff2) return {};
  const int edges = (X < t.edge[0]) + (X < t.edge[1]) + (X < t.edge[2]);
  const auto k = static_cast<std::size_t>(-edges & 3);
  const T w = t.width / (X - t.pole), s = w - t.middle[k];
  T u = t.c[degree][k], slope = t.d[degree - 1][k];
  for (int m = degree - 1; m >= 0; --m) u = u * s + t.c[m][k];
  for (int m = degree - 2; m >= 0; --m) slope = slope * s + t.d[m][k];
  return {static_cast<double>(u),
          static_cast<double>(of.force * slope * w * w) * rho / static_cast<double>(of.unit)};
}

// From the core, where u is a hundred times the well, to beyond the cutoff.
template <class F>
void expect_close(const LineDensity& law, double tolerance, double of_force, const F& read_at) {
  const double well = std::fabs(law.energy(line_parallel_well(law).distance));
  for (double rho = law.contact + law.core_gap + 1e-6; rho < law.cutoff() + 0.2; rho += 1.7e-4) {
    const RadialTerms t = law.terms(rho);
    const Read r = read_at(rho);
    ASSERT_NEAR(r.energy, t.energy, tolerance * (well + std::fabs(t.energy))) << rho;
    ASSERT_NEAR(r.force, -t.derivative, of_force * (20 * well + std::fabs(t.derivative))) << rho;
  }
}

template <class Table, class Bits>
void expect_table_close(const LineDensity& law, double unit, double tolerance) {
  const Table table(law, unit);
  expect_close(law, tolerance, 10 * tolerance, [&](double rho) { return read<Table, Bits>(table, rho); });
  for (double rho = law.contact + law.core_gap + 1e-6; rho < law.cutoff() + 0.2; rho += 1.7e-4) {
    const auto at = static_cast<typename Table::Value>(rho / unit);
    ASSERT_EQ(static_cast<double>(table.energy(at * at)), (read<Table, Bits>(table, rho).energy)) << rho;
  }
}

// Laws of thin, usual, unlike and wide tubes, and one with a nearer cutoff.
std::vector<LineDensity> laws() {
  const LineDensity usual = test::line_density();
  return {test::line_density(0.34, 0.34), usual, test::line_density(1.36, 0.34), test::line_density(1.4, 1.4),
          with_cutoff(usual, usual.contact + 0.8)};
}

TEST(RadialTable, FollowsTheLaw) {
  for (const auto& [a, b] : {std::pair(0.34, 0.34), std::pair(0.6785, 0.6785), std::pair(1.36, 0.34)}) {
    const LineDensity law = test::line_density(a, b);
    expect_table_close<MixedTable, std::uint32_t>(law, std::exp2(-22), 2e-5);
    expect_table_close<FullTable, std::uint64_t>(law, 1, 1e-11);
  }
}

TEST(RadialTable, PiecesFollowTheLaw) {
  for (const LineDensity& law : laws()) {
    const MixedTable table(law, std::exp2(-22));
    expect_close(law, 2e-5, 1.5e-5, [&](double rho) { return read(table.pieces, table, rho); });
    // Without the digits of single precision.
    const FullTable full(law, 1);
    const RadialPieces<double, MixedTable::degree> pieces(law, 1, full.scale);
    expect_close(law, 4e-6, 4e-6, [&](double rho) { return read(pieces, full, rho); });
  }
}

// The force is the derivative of the energy of the polynomials themselves, also where that is off the law.
template <class F>
void expect_own_derivative(const LineDensity& law, const F& read_at) {
  for (double rho = law.contact + law.core_gap + 1e-3; rho < law.cutoff() - 1e-3; rho += 1.3e-3) {
    const auto energy = [&](double h) { return read_at(rho + h).energy; };
    const double force = read_at(rho).force;
    ASSERT_NEAR(force, -test::derivative(energy, 1e-5), 1e-6 * (1 + std::fabs(force))) << rho;
  }
}

TEST(RadialTable, ForceIsItsOwnDerivative) {
  const LineDensity law = test::line_density();
  const FullTable table(law, 1);
  expect_own_derivative(law, [&](double rho) { return read<FullTable, std::uint64_t>(table, rho); });
  const RadialPieces<double, MixedTable::degree> pieces(law, 1, table.scale);
  expect_own_derivative(law, [&](double rho) { return read(pieces, table, rho); });
}

// u has no step where pieces meet, nor at the cutoff.
TEST(RadialTable, PiecesMeet) {
  for (const LineDensity& law : laws()) {
    const FullTable table(law, 1);
    const RadialPieces<double, MixedTable::degree> pieces(law, 1, table.scale);
    for (const double at : {pieces.edge[0], pieces.edge[1], pieces.edge[2], table.cutoff2}) {
      const double rho = std::sqrt(at), within = read(pieces, table, rho * (1 - 1e-13)).energy,
                   beyond = read(pieces, table, rho * (1 + 1e-13)).energy;
      EXPECT_NEAR(within, beyond, 1e-9 * (1 + std::fabs(within))) << rho;
    }
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
