#include "contact/fit_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contact/line_targets.hpp"

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

constexpr double right_angle = 0.5 * units::pi;

double density() { return graphene_density(0.1421 * std::sqrt(3.0)); }
Shell shell(double radius) { return {radius, density()}; }

// Every fitted density, whatever its parameters, must be stiff and monotonic down to full overlap, deepest
// near the gap of graphite, without a second minimum, and smooth to its end.
void expect_sound(const LineDensity& d) {
  EXPECT_GT(d.core_gap + d.c, 0);
  EXPECT_GT(d.p, d.q);
  double stiffness = std::numeric_limits<double>::infinity();
  for (double rho = 0.01; rho < d.contact + d.core_gap; rho += 0.01) {
    const RadialTerms t = d.terms(rho);
    EXPECT_LT(t.derivative, 0) << rho;
    EXPECT_LE(-t.derivative, stiffness * (1 + 1e-12)) << rho;
    stiffness = -t.derivative;
  }
  int turns = 0;
  for (double rho = d.contact + 0.1; rho < d.cutoff() - 0.002; rho += 0.002)
    turns += d.terms(rho).derivative < 0 && d.terms(rho + 0.002).derivative >= 0;
  EXPECT_EQ(turns, 1);
  EXPECT_NEAR(d.energy(d.cutoff()), 0, 1e-30);
}

void expect_near_integral(const LineFit& f, double error) {
  EXPECT_TRUE(f.fit.usable()) << f.fit.message;
  EXPECT_TRUE(f.fit.undetermined.empty()) << f.fit.message;
  EXPECT_LT(f.error, error);
  EXPECT_NEAR(f.line_parallel.distance / f.parallel.distance, 1, 1e-3);
  EXPECT_NEAR(f.line_parallel.energy / f.parallel.energy, 1, 5e-3);
  EXPECT_NEAR(f.line_crossed.distance / f.crossed.distance, 1, 1e-3);
  EXPECT_NEAR(f.line_crossed.energy / f.crossed.energy, 1, 1e-2);
  expect_sound(f.density);
}

class LineFitAt : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(LineFitAt, IsTheIntegral) {
  const auto [ri, rj] = GetParam();
  FitOptions options;
  options.starts = 3;
  const LineFit f = fit_line({}, shell(ri), shell(rj), options);
  // For (4,4), with a radius of 0.27 nm, and thinner tubes the kinks of the cutoff lie in the tail of the law.
  expect_near_integral(f, ri + rj < 0.67 ? 2.5e-3 : 2e-3);
  EXPECT_EQ(f.density.contact, ri + rj);
  for (const double e : f.fit.standard_error) EXPECT_GT(e, 0);
}

INSTANTIATE_TEST_SUITE_P(Radii, LineFitAt,
                         testing::Values(std::pair{0.2, 0.2}, std::pair{0.3, 0.3}, std::pair{0.6785, 0.6785},
                                         std::pair{1.4, 1.4}, std::pair{0.34, 0.9}));

double fine_crossed_energy(const LineDensity& d, double distance) {
  constexpr int points = 40000;
  const double step = (d.cutoff() - distance) / points;
  double sum = 0;
  for (int k = 0; k < points; ++k) {
    const double rho = distance + (k + 0.5) * step;
    sum += rho * d.energy(rho);
  }
  return 2 * units::pi * step * sum;
}

// The figures of the fit are those that the program computes with, from independent sums.
TEST(LineFit, ErrorAndCurvesAreThoseOfTheLaw) {
  const LineFit f = fit_line({}, shell(0.4), shell(0.4));
  double largest = 0;
  for (const ContactPoint& p : f.parallel_curve) {
    EXPECT_NEAR(p.integral, parallel_energy({}, shell(0.4), shell(0.4), p.distance), 1e-6);
    EXPECT_NEAR(p.fit, line_parallel_energy(f.density, p.distance), 1e-5 * (1 + std::fabs(p.integral)));
    if (p.distance >= f.parallel.distance - 0.05 - 1e-9)
      largest = std::max(largest, std::fabs((p.fit - p.integral) / f.parallel.energy));
  }
  for (const ContactPoint& p : f.crossed_curve) {
    EXPECT_EQ(p.angle, right_angle);
    EXPECT_NEAR(p.fit, fine_crossed_energy(f.density, p.distance), 1e-5 * (1 + std::fabs(p.integral)));
    if (p.distance >= f.crossed.distance - 0.05 - 1e-9)
      largest = std::max(largest, std::fabs((p.fit - p.integral) / f.crossed.energy));
  }
  EXPECT_NEAR(f.error, largest, 1e-9);
  EXPECT_FALSE(f.u.empty());
}

TEST(LineFit, OtherCutoffs) {
  expect_near_integral(fit_line({2.84e-3, 0.34, 1.0}, shell(0.6785), shell(0.6785)), 6e-3);
  expect_near_integral(fit_line({2.4e-3, 0.33, 1.5}, shell(0.6785), shell(0.6785)), 6e-3);
}

// Without a cutoff the law's own lies 3 nm out.
TEST(LineFit, WithoutCutoff) {
  const LineFit f =
      fit_line({2.84e-3, 0.34, std::numeric_limits<double>::infinity()}, shell(0.6785), shell(0.6785));
  EXPECT_NEAR(f.parallel.energy, -1.1114, 2e-4);
  EXPECT_NEAR(f.line_parallel.energy / f.parallel.energy, 1, 2e-3);
  EXPECT_LT(f.error, 2e-3);
  expect_sound(f.density);
}

TEST(LineFit, SameTwice) {
  FitOptions options;
  options.starts = 2;
  const LineFit a = fit_line({}, shell(0.5), shell(0.5), options),
                b = fit_line({}, shell(0.5), shell(0.5), options);
  EXPECT_EQ(a.fit.value, b.fit.value);
}

TEST(LineFit, RefusesWhatHasNoWell) {
  EXPECT_THROW(fit_line({2.84e-3, 0.34, 0.2}, shell(0.5), shell(0.5)), std::invalid_argument);
  EXPECT_THROW(fit_line({2.84e-3, -0.34, 1.2}, shell(0.5), shell(0.5)), std::invalid_argument);
  EXPECT_THROW(fit_line({}, shell(0), shell(0.5)), std::invalid_argument);
}

// --- One law for all --------------------------------------------------------------------------------------

// Few radii, so that the test is short; asked at others.
TEST(UniversalFit, HoldsBetweenItsRadii) {
  const UniversalFit u = fit_universal({}, {{0.3, 0.3},
                                            {0.38, 0.38},
                                            {0.5, 0.5},
                                            {0.3, 0.7},
                                            {0.7, 0.7},
                                            {0.38, 1.0},
                                            {0.3, 1.4},
                                            {0.7, 1.4},
                                            {1.4, 1.4}});
  EXPECT_TRUE(u.fit.usable()) << u.fit.message;
  EXPECT_LT(u.error, 3.5e-3);
  ASSERT_EQ(u.pairs.size(), 9u);
  for (const UniversalFit::PairCheck& p : u.pairs) {
    EXPECT_LT(p.direct_error, 2.5e-3) << p.r_i << " " << p.r_j;
    EXPECT_LT(std::fabs(p.spacing_error), 1e-3) << p.r_i << " " << p.r_j;
    EXPECT_LT(std::fabs(p.depth_error), 5e-3) << p.r_i << " " << p.r_j;
  }
  for (const auto& [ri, rj] : {std::pair{0.34, 0.34}, {0.6, 0.6}, {0.6, 0.8}, {1.2, 1.2}, {0.34, 1.4}}) {
    const LineTargets targets(WallsIntegral({}, shell(ri), shell(rj)), ri + rj, line_gaps({}));
    const LineDensity d = u.law.density(ri, density(), rj, density());
    EXPECT_LT(targets.error(d), 4e-3) << ri << " " << rj;
    expect_sound(d);
    const LineWell crossed = line_crossed_well(d, right_angle);
    EXPECT_NEAR(crossed.energy / targets.crossed_well.energy, 1, 1e-2) << ri << " " << rj;
  }
  // Lengths scale with sigma, energies with epsilon and both densities.
  const LineDensity a = u.law.density(0.5, 38, 0.7, 38), b = u.law.density(0.7, 19, 0.5, 38);
  EXPECT_NEAR(b.K / a.K, 0.5, 1e-12);
  EXPECT_EQ(a.p, b.p);
}

TEST(UniversalFit, NeedsAPair) { EXPECT_THROW(fit_universal({}, {}), std::invalid_argument); }

// --- The published form -----------------------------------------------------------------------------------

// The limits of the reader of parameter sets.
void expect_readable(const PaperContact& k) {
  EXPECT_GT(k.repulsion, 0);
  EXPECT_GT(k.attraction, 0);
  EXPECT_GT(k.alpha, k.beta);
  EXPECT_GE(k.beta, 1);
  EXPECT_LE(k.alpha, 100);
  EXPECT_GE(k.crossing, 0);
  EXPECT_LE(std::max({k.crossing, k.repulsion, k.attraction}), 1e6);
  EXPECT_LE(k.delta, 0);
  for (const double c : k.angular) EXPECT_LE(std::fabs(c), 1);
  const double lowest = std::pow(k.alpha * k.repulsion / (k.beta * k.attraction), 1 / (k.alpha - k.beta));
  EXPECT_LT(lowest + 2, k.switch_start);
  EXPECT_LT(k.core_gap, lowest);
  for (int degree = 0; degree <= 90; ++degree) {
    double theta = 1;
    for (int i = 1; i <= 5; ++i)
      theta += k.angular[static_cast<std::size_t>(i - 1)] *
               ((i % 2 ? 1 : -1) + std::cos(2 * i * degree * units::degree));
    EXPECT_GT(theta, 0.05) << degree;
  }
}

TEST(PaperFit, ParallelIsGoodCrossingIsNot) {
  const double length = 1.356;
  const PaperFit f = fit_paper({}, shell(0.6785), length);
  EXPECT_TRUE(f.fit.usable()) << f.fit.message;
  ASSERT_EQ(f.fit.value.size(), 11u);
  expect_readable(f.law);
  const Well parallel = parallel_well({}, shell(0.6785), shell(0.6785));
  const Well crossed = crossed_well({}, shell(0.6785), shell(0.6785), right_angle);
  EXPECT_NEAR(f.parallel.distance / parallel.distance, 1, 5e-3);
  EXPECT_NEAR(f.parallel.energy / parallel.energy, 1, 0.03);
  EXPECT_NEAR(f.crossed.energy / crossed.energy, 1, 0.15);
  EXPECT_LT(f.error, 0.3);
  EXPECT_GT(f.error, 10 * fit_line({}, shell(0.6785), shell(0.6785)).error);

  // The well that is told is that of rows of elements.
  double row = 0;
  for (int k = -4; k <= 4; ++k)
    for (const double shift : {0.0, 0.25, 0.5, 0.75})
      row += f.law.energy({f.parallel.distance, 0, (k + shift) * length}, {0, 0, 1}, {0, 0, 1}) / (4 * length);
  EXPECT_NEAR(row, f.parallel.energy, 1e-9);
}

TEST(PaperFit, ThinTube) {
  const PaperFit f = fit_paper({}, shell(0.34), 0.68);
  EXPECT_TRUE(f.fit.usable()) << f.fit.message;
  expect_readable(f.law);
  const Well parallel = parallel_well({}, shell(0.34), shell(0.34));
  EXPECT_NEAR(f.parallel.energy / parallel.energy, 1, 0.03);
}

TEST(PaperFit, NeedsALength) { EXPECT_THROW(fit_paper({}, shell(0.6785), 0), std::invalid_argument); }

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
