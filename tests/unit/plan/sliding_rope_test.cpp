// The theory of the helix against the theory of rods and against a solution by finite differences in time.
#include "plan/sliding_rope.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "observe/centre_line.hpp"
#include "plan/forecast.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

// Length, stiffness and mass are one, so that a moment is its ratio to B/L.
SlidingRope rod(double slip = 0) { return {1, 1, 1, slip}; }

TEST(SlidingRope, FreeRodGrowsFromTheMomentOfTheClampedOne) {
  const double critical = 8.986818916;  // 2 x with tan x = x
  EXPECT_NEAR(rod().static_moment(), critical, 1e-8);
  EXPECT_EQ(rod().growth(0.9999 * critical, 1), 0);
  EXPECT_EQ(rod().windings(0.9999 * critical, 1), 0);
  const double little = rod().growth(1.0001 * critical, 1), more = rod().growth(1.0004 * critical, 1);
  EXPECT_GT(little, 0);
  EXPECT_NEAR(more / little, 2, 0.01) << "the square of an undamped rate is straight there";
  // Three other rods by the units alone.
  const SlidingRope real{67.8, 2237, 20.2, 0};
  EXPECT_NEAR(real.static_moment(), critical * 2237 / 67.8, 1e-6);
  EXPECT_NEAR(real.growth(12 * 2237 / 67.8, 1), rod().growth(12, 1) / (67.8 * 67.8 * std::sqrt(20.2 / 2237)),
              1e-12);
}

// q'''' - i mu q''' + rate^2 q = 0 with q = q' = 0 at 0 and 1: the determinant of its four exponentials.
double clamped(double mu, double rate) {
  Eigen::Matrix4cd companion = Eigen::Matrix4cd::Zero();
  companion(0, 3) = -rate * rate;
  companion(3, 3) = Complex(0, mu);
  for (int k = 1; k < 4; ++k) companion(k, k - 1) = 1;
  const Eigen::Vector4cd k = companion.eigenvalues();
  Eigen::Matrix4cd ends;
  for (int j = 0; j < 4; ++j) ends.col(j) << 1, k(j), std::exp(k(j)), k(j) * std::exp(k(j));
  for (int j = 0; j < 4; ++j) ends.col(j).normalize();
  return std::abs(ends.determinant());
}

TEST(SlidingRope, RatesWithoutSlipAreThoseOfTheClampedRodsEquation) {
  for (const double mu : {9.5, 12.0, 20.0, 40.0}) {
    const double rate = rod().growth(mu, 0.3);
    EXPECT_GT(rate, 0) << mu;
    const double there = clamped(mu, rate), beside = std::min(clamped(mu, 0.98 * rate), clamped(mu, 1.02 * rate));
    EXPECT_LT(there, 1e-3 * beside) << mu;
    EXPECT_EQ(rate, rod().growth(mu, 0.9)) << "winding matters by its slip alone";
  }
}

// A rod of points, stepped in time by the midpoint rule, from a plane wave.
struct Grown {
  double rate = 0, windings = 0;
};
Grown grown_by_steps(double mu, double slip, double winding, double time) {
  constexpr int n = 96;
  const double h = 1.0 / n, dt = time / 3000;
  const auto full = [](int rows) { return MatrixXcd::Zero(rows, n + 1); };
  MatrixXcd bend = full(n - 1), tilt = full(n - 1), shift = full(n);
  for (int j = 1; j < n; ++j) {
    bend(j - 1, j - 1) = bend(j - 1, j + 1) = 1 / (h * h);
    bend(j - 1, j) = -2 / (h * h);
    tilt(j - 1, j + 1) = 1 / (2 * h);
    tilt(j - 1, j - 1) = -1 / (2 * h);
  }
  // Neighbours shift between the points, and the curvature at a point adds to it.
  for (int j = 1; j < n; ++j)
    shift.row(j) = shift.row(j - 1) + h * std::exp(Complex(0, -mu * winding * j * h)) * bend.row(j - 1);
  shift.rowwise() -= (shift.colwise().sum() / double{n}).eval();
  Eigen::VectorXd mass = Eigen::VectorXd::Constant(n + 1, h);
  mass(0) = mass(n) = 0.5 * h;
  const auto inverse = mass.cwiseInverse().cast<Complex>().asDiagonal();
  const MatrixXcd stiffness = inverse * (h * bend.adjoint() * (bend - Complex(0, mu) * tilt));
  const MatrixXcd damping = inverse * (slip * h * shift.adjoint() * shift);
  const Eigen::PartialPivLU<MatrixXcd> step(MatrixXcd::Identity(n + 1, n + 1) + 0.5 * dt * damping +
                                            0.25 * dt * dt * stiffness);
  VectorXcd u(n + 1), v = VectorXcd::Zero(n + 1);
  for (int j = 0; j <= n; ++j) u(j) = std::sin(3.14159265358979 * j * h);
  double before = 0;
  for (int k = 0; k < 3000; ++k) {
    if (k == 2000) before = (bend * u).norm();
    const VectorXcd middle = step.solve(v - 0.5 * dt * (stiffness * u));
    u += dt * middle;
    v = 2 * middle - v;
  }
  std::vector<Vector3> line;
  const double largest = u.cwiseAbs().maxCoeff();
  for (int j = 0; j <= n; ++j) line.emplace_back(1e-3 * u(j).real() / largest, 1e-3 * u(j).imag() / largest, j * h);
  return {std::log((bend * u).norm() / before) / (1000 * dt), helix_of(line).windings};
}

TEST(SlidingRope, RatesWithSlipAreThoseOfAnotherSolution) {
  for (const auto& [mu, slip, winding] :
       {std::tuple(11.4, 0.42, 0.95), std::tuple(11.4, 0.42, 0.6), std::tuple(18.0, 0.5, 0.9)}) {
    const double rate = rod(slip).growth(mu, winding);
    EXPECT_LT(rate, 0.8 * rod().growth(mu, winding)) << "slip does brake it";
    const Grown seen = grown_by_steps(mu, slip, winding, 24 / rate);
    EXPECT_NEAR(seen.rate, rate, 0.01 * rate) << mu << " " << winding;
    EXPECT_NEAR(seen.windings, rod(slip).windings(mu, winding), 0.05) << mu << " " << winding;
  }
}

TEST(SlidingRope, GainIsTheIntegralOfTheRate) {
  const SlidingRope rope = rod(0.42);
  const double moment = 14, rate = 0.5;
  double sum = 3 * rope.growth(moment, 0.9);
  constexpr int steps = 120;
  for (int k = 0; k < steps; ++k) sum += rope.growth(moment * (k + 0.5) / steps, 0.9) * moment / rate / steps;
  EXPECT_NEAR(rope.gain(moment, 0.9, rate, 3), sum, 0.01 * sum);
  EXPECT_NEAR(rope.gain(rope.moment_of_gain(5, 0.9, rate, 3), 0.9, rate, 3), 5, 0.05);
  EXPECT_NEAR(rope.moment_of_gain(5, 0.9, 0, 1e6), rope.static_moment(), 0.01 * rope.static_moment())
      << "a long wait has the static moment";
}

Scene scene_with(const std::string& twist, const std::string& more = "") {
  const char* rate = twist.find("total") == std::string::npos ? "2" : "38";
  return scene_of_text(
      std::string("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 19\n"
                  "length_nm = 81.36\n[start]\nwave_nm = 0.02\n[twist]\nmoment_nN_nm = 40\nhold_ps = "
                  "300\nrate_nN_nm_per_ps = ") +
          rate + "\n" + twist + more,
      "rope.toml");
}
std::optional<HelixTheory> theory_of(Scene scene) { return helix_theory(scene, prepare(scene)); }

TEST(HelixTheory, IsThatOfTheScene) {
  const auto theory = theory_of(scene_with(""));
  ASSERT_TRUE(theory && theory->grows);
  const double unit = units::nN_nm;
  EXPECT_NEAR(theory->static_moment / unit, 8.986819 * 358.4 / 81.36, 1e-3);
  EXPECT_NEAR(theory->first_amplitude, 0.01, 1e-12);
  // 42 pairs of 19 tubes at 1.713 nm, and elements of 1.356 nm: 0.42 of (m B)^1/2.
  EXPECT_NEAR(theory->rope.slip / std::sqrt(theory->rope.mass * theory->rope.bend), 0.42, 0.02);
  // Seen in such runs: 52.9 +- 0.5 within 300 ps.
  EXPECT_NEAR(theory->moment_to_pass(1, 0.95) / unit, 52.9, 0.05 * 52.9);
  EXPECT_NEAR(theory->winding_of(0.9 * 40 * 81.36 / 358.4, 40 * unit), 0.9, 1e-3);
  const auto total = theory_of(scene_with("reading = \"total\"\n"));
  ASSERT_TRUE(total);
  EXPECT_NEAR(total->static_moment, 19 * theory->static_moment, 1e-9);
  EXPECT_NEAR(total->moment_to_pass(1, 0.95), 19 * theory->moment_to_pass(1, 0.95), 1e-6);
  EXPECT_NEAR(total->growth(19 * 50 * unit, 0.9), theory->growth(50 * unit, 0.9), 1e-9);
  const auto held = theory_of(scene_with("lateral = \"held\"\n"));
  ASSERT_TRUE(held);
  EXPECT_NEAR(held->static_moment / unit, 2 * units::pi * 358.4 / 81.36, 1e-3);
  EXPECT_FALSE(held->grows);
  EXPECT_EQ(held->moment_to_pass(1, 1), 0);
  EXPECT_FALSE(theory_of(scene_with("application = \"tangential\"\n")));
  EXPECT_FALSE(theory_of(scene_with("", "[damping]\npfc_local = 0.1\n"))->grows);
}

TEST(HelixTheory, IsToldBeforeARun) {
  const auto words_of = [](Scene scene) { return helix_ahead(scene, prepare(scene)); };
  Scene above = scene_with("");  // 40 nN nm, of 39.6
  const auto words = words_of(above);
  ASSERT_TRUE(words);
  EXPECT_NE(words->find("from 39.6 nN nm on each tube on. Under 40 nN nm"), std::string::npos) << *words;
  EXPECT_NE(words_of(scene_with("lateral = \"held\"\n"))->find("from 27.7 nN nm on each tube on."),
            std::string::npos);
  EXPECT_FALSE(
      words_of(scene_of_text("format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 19\n"
                             "length_nm = 81.36\n[twist]\nmoment_nN_nm = 39\nrate_nN_nm_per_ps = 2\n",
                             "rope.toml")));
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
