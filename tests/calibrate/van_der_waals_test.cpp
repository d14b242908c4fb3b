#include "contact/van_der_waals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "contact/integral.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double right_angle = 0.5 * units::pi;

// Graphite: bonds of 0.1421 nm.
double density() { return graphene_density(0.1421 * std::sqrt(3.0)); }
Shell shell(double radius) { return {radius, density()}; }
AtomLaw with_cutoff(double cutoff) { return {2.84e-3, 0.34, cutoff}; }
const AtomLaw uncut = with_cutoff(infinite);

// An armchair tube: n hexagons around, in pairs of rings half a lattice constant apart.
AtomColumn armchair(int n, double radius) {
  AtomColumn column;
  column.period = 0.1421 * std::sqrt(3.0);
  for (int k = 0; k < n; ++k)
    for (const auto& [turn, z] : {std::array{0.0, 0.0}, {1.0 / 3, 0.0}, {0.5, 0.5}, {5.0 / 6, 0.5}}) {
      const double phi = 2 * units::pi * (k + turn) / n;
      column.atoms.emplace_back(radius * std::cos(phi), radius * std::sin(phi), z * column.period);
    }
  return column;
}

TEST(AtomLaw, IsTruncatedLennardJones) {
  const AtomLaw law;
  EXPECT_NEAR(law.energy(0.34), 0, 1e-15);
  EXPECT_NEAR(law.energy(0.34 * std::pow(2, 1.0 / 6)), -2.84e-3, 1e-15);
  EXPECT_LT(law.energy(1.1999), 0);
  EXPECT_EQ(law.energy(1.2), 0);
}

// --- The (10,10) tube of the literature's figures -----------------------------------------------------

TEST(VanDerWaals, WellsOfTenTen) {
  const Shell s = shell(0.6785);
  const Well parallel = parallel_well(uncut, s, s), crossed = crossed_well(uncut, s, s, right_angle);
  EXPECT_NEAR(parallel.distance, 1.6710, 1e-4);
  EXPECT_NEAR(parallel.energy, -1.1114, 2e-4);
  EXPECT_NEAR(crossed.distance, 1.6474, 1e-4);
  EXPECT_NEAR(crossed.energy, -1.671, 1e-3);
}

TEST(VanDerWaals, CutoffOf12AngstromKeeps95PerCent) {
  const Shell s = shell(0.6785);
  EXPECT_NEAR(parallel_well(AtomLaw{}, s, s).energy / parallel_well(uncut, s, s).energy, 0.956, 2e-3);
}

TEST(VanDerWaals, EnergyGoesWithBothDensities) {
  const Shell i = shell(0.5), j = shell(0.7);
  const Shell half{0.5, 0.5 * density()};
  EXPECT_NEAR(parallel_energy({}, half, j, 1.6) / parallel_energy({}, i, j, 1.6), 0.5, 1e-10);
  EXPECT_NEAR(parallel_energy({}, i, j, 1.6) / parallel_energy({}, j, i, 1.6), 1, 1e-8);
  EXPECT_NEAR(crossed_energy({}, i, j, 1.6, 0.7) / crossed_energy({}, j, i, 1.6, 0.7), 1, 1e-7);
}

// Two thin tubes far apart are two lines of atoms: E = -n n' 4 eps sigma^6 3 pi/(8 R^5).
TEST(VanDerWaals, FarApartTheTubesAreLines) {
  const Shell s = shell(0.05);
  const double R = 20, per_length = 2 * units::pi * s.radius * s.density;
  const double line = -4 * uncut.epsilon * std::pow(uncut.sigma, 6) * 3 * units::pi / (8 * std::pow(R, 5));
  EXPECT_NEAR(parallel_energy(uncut, s, s, R) / (per_length * per_length * line), 1, 1e-3);
}

// The same by brute force: midpoint sums over both circles and along the tube.
double parallel_by_brute_force(const AtomLaw& law, const Shell& i, const Shell& j, double R) {
  constexpr int around = 96, along = 400;
  double sum = 0;
  for (int a = 0; a < around; ++a)
    for (int b = 0; b < around; ++b) {
      const double pa = 2 * units::pi * (a + 0.5) / around, pb = 2 * units::pi * (b + 0.25) / around;
      const double x = R + j.radius * std::cos(pb) - i.radius * std::cos(pa);
      const double y = j.radius * std::sin(pb) - i.radius * std::sin(pa), across = x * x + y * y;
      if (across >= law.cutoff * law.cutoff) continue;
      const double half = std::sqrt(law.cutoff * law.cutoff - across), step = 2 * half / along;
      for (int k = 0; k < along / 2; ++k) {
        const double z = (k + 0.5) * step;
        sum += 2 * step * law.energy(std::sqrt(across + z * z));
      }
    }
  const double element = 4 * units::pi * units::pi / (around * around);
  return sum * element * i.radius * j.radius * i.density * j.density;
}

TEST(VanDerWaals, ParallelEnergyAgainstBruteForce) {
  for (const double R : {1.35, 1.6, 2.0})
    EXPECT_NEAR(
        parallel_energy({}, shell(0.4), shell(0.6), R) / parallel_by_brute_force({}, shell(0.4), shell(0.6), R), 1,
        1e-3)
        << R;
}

TEST(VanDerWaals, SlopeIsTheDerivative) {
  for (const double cutoff : {infinite, 1.2, 0.9})
    for (const double rj : {0.3, 0.6785})
      for (const double gap : {0.25, 0.31, 0.4, 0.71, 0.85}) {
        const AtomLaw law = with_cutoff(cutoff);
        const Shell i = shell(0.6785), j = shell(rj);
        const double R = i.radius + j.radius + gap, h = 1e-4;
        const double numeric = (8 * (parallel_energy(law, i, j, R + h) - parallel_energy(law, i, j, R - h)) -
                                (parallel_energy(law, i, j, R + 2 * h) - parallel_energy(law, i, j, R - 2 * h))) /
                               (12 * h);
        const double slope = parallel_energy_derivative(law, i, j, R);
        EXPECT_NEAR(slope, numeric, 1e-5 * std::max(1.0, std::fabs(slope))) << cutoff << " " << rj << " " << gap;
      }
}

TEST(VanDerWaals, NothingBeyondTheCutoff) {
  const Shell s = shell(0.5);
  EXPECT_EQ(parallel_energy({}, s, s, 2.2), 0);
  EXPECT_EQ(parallel_energy_derivative({}, s, s, 2.3), 0);
  EXPECT_EQ(crossed_energy({}, s, s, 2.2, 0.5), 0);
  EXPECT_EQ(line_density({}, s, s, 2.2), 0);
  EXPECT_LT(parallel_energy({}, s, s, 2.19), 0);
}

// --- The theorem: one line density for all angles -----------------------------------------------------

TEST(VanDerWaals, CrossedEnergyTimesSineIsConstant) {
  const Shell i = shell(0.6785), j = shell(0.45);
  const double R = i.radius + j.radius + 0.3;
  const double at_90 = crossed_energy({}, i, j, R, right_angle);
  for (const double degrees : {10.0, 20.0, 45.0, 70.0})
    EXPECT_NEAR(crossed_energy({}, i, j, R, degrees * units::degree) * std::sin(degrees * units::degree) / at_90, 1,
                1e-6)
        << degrees;
}

// Both energies as line integrals of u, here by plain midpoint sums of the exact Abel inverse.
void expect_theorem(const AtomLaw& law, const Shell& i, const Shell& j, double R) {
  const PairIntegral integral(law, i, j);
  const double end = std::isinf(law.cutoff) ? 40 : law.cutoff + i.radius + j.radius;
  constexpr int points = 3000;
  double parallel = 0, crossed = 0;
  // rho = R cosh x, t = R sinh x
  const double last = std::acosh(end / R);
  for (int k = 0; k < points; ++k) {
    const double x = (k + 0.5) * last / points, rho = R * std::cosh(x), u = integral.line_density(rho);
    parallel += 2 * u * rho * last / points;
    crossed += 2 * units::pi * u * rho * R * std::sinh(x) * last / points;
  }
  EXPECT_NEAR(parallel, parallel_energy(law, i, j, R), 2e-5);
  for (const double angle : {0.3, 1.0, right_angle})
    EXPECT_NEAR(crossed / std::sin(angle), crossed_energy(law, i, j, R, angle), 5e-5 / std::sin(angle)) << angle;
}

TEST(VanDerWaals, LineDensityGivesParallelAndCrossed) { expect_theorem({}, shell(0.6785), shell(0.6785), 1.66); }
TEST(VanDerWaals, LineDensityOfUnequalTubes) { expect_theorem({}, shell(0.3), shell(0.9), 1.55); }
TEST(VanDerWaals, LineDensityWithoutCutoff) { expect_theorem(uncut, shell(0.3), shell(0.6785), 1.3); }

// --- The table ------------------------------------------------------------------------------------------

// Shells so thin that the cutoff leaves kinks within the well, and wide ones.
TEST(PairIntegral, IsTheIntegral) {
  for (const double cutoff : {infinite, 1.2, 0.8})
    for (const double rj : {0.2, 0.35, 1.4}) {
      const AtomLaw law = with_cutoff(cutoff);
      const Shell i = shell(0.35), j = shell(rj);
      const PairIntegral table(law, i, j);
      const double contact = i.radius + j.radius;
      for (double gap = 0.21; gap < 1.3; gap += 0.274) {
        const double R = contact + gap;
        EXPECT_NEAR(table.parallel(R), parallel_energy(law, i, j, R), 1e-7) << cutoff << " " << rj << " " << gap;
        EXPECT_NEAR(table.slope(R), parallel_energy_derivative(law, i, j, R), 1e-6) << cutoff << " " << gap;
        EXPECT_NEAR(table.line_density(R), line_density(law, i, j, R), 1e-6) << cutoff << " " << rj << " " << gap;
      }
      const double R = contact + 0.33;
      EXPECT_NEAR(table.crossed(R), crossed_energy(law, i, j, R, right_angle), 1e-6) << cutoff << " " << rj;
    }
}

TEST(PairIntegral, FiniteJustInsideOfAKink) {
  const PairIntegral table({}, shell(0.34), shell(0.34));
  for (const double R : {1.2 - 1e-3, 1.2 - 1e-7, 1.2 - 1e-12, 1.2, 1.2 + 1e-12, 1.88 - 1e-12}) {
    EXPECT_TRUE(std::isfinite(table.line_density(R))) << R;
    EXPECT_TRUE(std::isfinite(table.parallel(R) + table.crossed(R))) << R;
  }
  EXPECT_NEAR(table.line_density(1.2 - 1e-9), table.line_density(1.2 + 1e-9), 1e-6);
}

// --- Atoms ----------------------------------------------------------------------------------------------

TEST(Atoms, MeanOverRegistryIsTheSurfaceIntegral) {
  const double radius = 0.6785;
  const AtomColumn tube = armchair(10, radius);
  const Shell s{radius, static_cast<double>(tube.atoms.size()) / (2 * units::pi * radius * tube.period)};
  const double R = parallel_well({}, s, s).distance;
  const RegistrySpread spread = registry_spread({}, tube, tube, R);
  RecordProperty("registry_deviation_eV_per_nm", std::to_string(spread.deviation));
  EXPECT_NEAR(spread.mean / parallel_energy({}, s, s, R), 1, 5e-3);
  EXPECT_GT(spread.deviation, 1e-4 * std::fabs(spread.mean));
  EXPECT_LT(spread.deviation, 0.05 * std::fabs(spread.mean));
  EXPECT_LT(spread.least, spread.mean);
  EXPECT_GT(spread.largest, spread.mean);
}

TEST(Atoms, TurnAndShiftByTheirPeriodsChangeNothing) {
  const AtomColumn tube = armchair(6, 0.41);
  const double energy = parallel_energy_of_atoms(AtomLaw(), tube, tube, 1.12, 0.3, 0.05);
  EXPECT_NEAR(parallel_energy_of_atoms(AtomLaw(), tube, tube, 1.12, 0.3 + units::pi / 3, 0.05), energy, 1e-9);
  EXPECT_NEAR(parallel_energy_of_atoms(AtomLaw(), tube, tube, 1.12, 0.3, 0.05 - 3 * tube.period), energy, 1e-9);
  EXPECT_GT(std::fabs(parallel_energy_of_atoms(AtomLaw(), tube, tube, 1.12, 0.3, 0.17) - energy), 1e-6);
}

TEST(Atoms, ADoubledCellIsTheSameTube) {
  const AtomColumn tube = armchair(6, 0.41);
  AtomColumn two = tube;
  two.period *= 2;
  for (const Vector3& a : tube.atoms) two.atoms.push_back(a + Vector3(0, 0, tube.period));
  const double energy = parallel_energy_of_atoms(AtomLaw(), tube, tube, 1.12, 0.2, 0.1);
  EXPECT_NEAR(parallel_energy_of_atoms(AtomLaw(), two, tube, 1.12, 0.2, 0.1), energy, 1e-10);
  EXPECT_NEAR(parallel_energy_of_atoms(AtomLaw(), tube, two, 1.12, 0.2, 0.1), energy, 1e-10);
}

// --- What is refused --------------------------------------------------------------------------------------

TEST(VanDerWaals, WrongInputIsRefused) {
  const Shell s = shell(0.5);
  EXPECT_THROW(parallel_energy({}, s, s, 1.0), std::invalid_argument);
  EXPECT_THROW(parallel_energy({}, s, s, std::nan("")), std::invalid_argument);
  EXPECT_THROW(parallel_energy({}, {0, 38}, s, 1.4), std::invalid_argument);
  EXPECT_THROW(parallel_energy({}, s, {0.5, -1}, 1.4), std::invalid_argument);
  EXPECT_THROW(parallel_energy(with_cutoff(-1), s, s, 1.4), std::invalid_argument);
  EXPECT_THROW(parallel_energy(AtomLaw{0, 0.34, 1.2}, s, s, 1.4), std::invalid_argument);
  EXPECT_THROW(crossed_energy({}, s, s, 1.4, 0), std::invalid_argument);
  EXPECT_THROW(crossed_energy({}, s, s, 1.4, 2), std::invalid_argument);
  EXPECT_THROW(line_density({}, s, s, 0.9), std::invalid_argument);
  EXPECT_THROW(parallel_well(with_cutoff(0.3), s, s), std::invalid_argument);
  EXPECT_THROW(parallel_well(with_cutoff(0.1), s, s), std::invalid_argument);
  const AtomColumn tube = armchair(6, 0.41);
  EXPECT_THROW(parallel_energy_of_atoms(uncut, tube, tube, 1.1, 0, 0), std::invalid_argument);
  EXPECT_THROW(parallel_energy_of_atoms(AtomLaw(), {}, tube, 1.1, 0, 0), std::invalid_argument);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
