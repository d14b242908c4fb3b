#include "fit/least_squares.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <thread>

namespace ropewalk::calibrate {
namespace {
namespace UNIT {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Verdict = FitResult::Verdict;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// sum_k a_k x^k at equidistant x of [-0.02, 0.03], with the scatter given.
struct Polynomial {
  std::vector<double> x, y;
  std::size_t terms;

  Polynomial(const std::vector<double>& a, double scatter) : terms(a.size()) {
    std::mt19937_64 random(5);
    for (int k = 0; k <= 40; ++k) {
      x.push_back(-0.02 + 0.00125 * k);
      const double noise = static_cast<double>(random() % 2001) / 1000.0 - 1;
      y.push_back(value(a, x.back()) + scatter * noise);
    }
  }
  static double value(const std::vector<double>& a, double x) {
    double sum = 0;
    for (std::size_t k = a.size(); k-- > 0;) sum = sum * x + a[k];
    return sum;
  }
  Residuals residuals() const {
    return [this](const std::vector<double>& p, std::vector<double>& r) {
      for (std::size_t k = 0; k < x.size(); ++k) r[k] = value(p, x[k]) - y[k];
    };
  }
  Eigen::MatrixXd design() const {
    Eigen::MatrixXd a(x.size(), terms);
    for (std::size_t k = 0; k < x.size(); ++k)
      for (std::size_t t = 0; t < terms; ++t) a(k, t) = std::pow(x[k], static_cast<double>(t));
    return a;
  }
};

const std::vector<double> energy_terms = {-160.5, 0.031, 740.0, -2500.0};  // as a tube under strain

std::vector<FitParameter> energy_box() {
  return {{"E0", -100, -300, 100}, {"linear", 0, -10, 10}, {"square", 100, 0, 5000}, {"cube", 0, -1e5, 1e5}};
}

TEST(LeastSquares, ExactPolynomialIsFound) {
  const Polynomial data(energy_terms, 0);
  const FitResult f = fit_least_squares(energy_box(), data.x.size(), data.residuals());
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(f.value[k] / energy_terms[k], 1, 1e-8) << k << " " << f.message;
  EXPECT_LT(f.largest, 1e-10);
}

TEST(LeastSquares, NoisyPolynomialIsTheLinearRegression) {
  const Polynomial data(energy_terms, 1e-3);
  const FitResult f = fit_least_squares(energy_box(), data.x.size(), data.residuals());
  ASSERT_EQ(f.verdict, Verdict::converged) << f.message;

  const Eigen::MatrixXd a = data.design();
  const Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(data.y.data(), a.rows());
  const Eigen::VectorXd best = a.colPivHouseholderQr().solve(y);
  const double s2 = (a * best - y).squaredNorm() / static_cast<double>(a.rows() - a.cols());
  const Eigen::MatrixXd covariance = s2 * (a.transpose() * a).inverse();
  for (int k = 0; k < 4; ++k) {
    const double error = std::sqrt(covariance(k, k));
    EXPECT_NEAR(f.value[static_cast<std::size_t>(k)], best[k], 1e-5 * error) << k;
    EXPECT_NEAR(f.standard_error[static_cast<std::size_t>(k)] / error, 1, 1e-5) << k;
  }
  EXPECT_NEAR(f.chi2 / (a * best - y).squaredNorm(), 1, 1e-10);
  EXPECT_THAT(f.at_bound, IsEmpty());
  EXPECT_THAT(f.undetermined, IsEmpty());
}

// Intercept and slope of a straight line through points at x = 1, 2, 3 have the covariance s^2 (X^T X)^-1, so that
// their correlation is -sum x / sqrt(n sum x^2).
TEST(LeastSquares, CorrelationIsThatOfTheLinearRegression) {
  const std::vector<double> y = {1.1, 1.9, 3.2};
  const auto residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    for (int k = 0; k < 3; ++k) r[k] = p[0] + p[2] * (k + 1) - y[k];
  };
  const FitResult fit =
      fit_least_squares({{"a", 0, -5, 5, true}, {"fixed", 3, 0, 5, false}, {"b", 0, -5, 5, true}}, 3, residuals);
  ASSERT_TRUE(fit.usable()) << fit.message;
  EXPECT_NEAR(fit.correlation[0][2], -6 / std::sqrt(3 * 14.0), 1e-6);
  EXPECT_EQ(fit.correlation[0][2], fit.correlation[2][0]);
  EXPECT_EQ(fit.correlation[1][1], 1);
  EXPECT_EQ(fit.correlation[0][1], 0) << "one that is not fitted";
}

TEST(LeastSquares, FixedParameterKeepsItsStart) {
  const Polynomial data(energy_terms, 1e-3);
  auto box = energy_box();
  box[1].free = false;
  const FitResult f = fit_least_squares(box, data.x.size(), data.residuals());
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_EQ(f.value[1], 0.0);
  EXPECT_EQ(f.standard_error[1], 0.0);
  EXPECT_GT(f.standard_error[2], 0.0);
}

TEST(LeastSquares, NothingFree) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) { out[0] = p[0] - 1; };
  const FitResult f = fit_least_squares({{"a", 3, 0, 5, false}}, 1, r);
  EXPECT_EQ(f.verdict, Verdict::converged);
  EXPECT_EQ(f.value[0], 3.0);
  EXPECT_EQ(f.chi2, 4.0);
}

// --- Curved valleys -----------------------------------------------------------------------------------

// Rosenbrock's valley as two residuals.
void rosenbrock(const std::vector<double>& p, std::vector<double>& r) {
  r[0] = 10 * (p[1] - p[0] * p[0]);
  r[1] = 1 - p[0];
}

TEST(LeastSquares, CurvedValley) {
  const FitResult f = fit_least_squares({{"a", -1.2, -5, 5}, {"b", 1, -5, 20}}, 2, rosenbrock);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 1, 1e-8);
  EXPECT_NEAR(f.value[1], 1, 1e-8);
}

TEST(LeastSquares, TwoExponentialsNearlyDegenerate) {
  const auto model = [](const std::vector<double>& p, double t) {
    return p[0] * std::exp(-p[1] * t) + p[2] * std::exp(-p[3] * t);
  };
  const std::vector<double> truth = {1.0, 1.0, 0.5, 1.3};
  const auto r = [&](const std::vector<double>& p, std::vector<double>& out) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double t = 0.1 * static_cast<double>(k);
      out[k] = model(p, t) - model(truth, t) - 1e-5 * std::sin(7.3 * t);
    }
  };
  const FitResult f =
      fit_least_squares({{"a", 2, 0, 5}, {"k", 0.5, 0.01, 1.15}, {"b", 1, 0, 5}, {"l", 3, 1.15, 9}}, 60, r);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_GT(f.condition, 1e4);
  EXPECT_LT(f.rms, 1.1e-5);
}

TEST(LeastSquares, StartAtTheOptimum) {
  const FitResult f = fit_least_squares({{"a", 1, -5, 5}, {"b", 1, -5, 20}}, 2, rosenbrock);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 1, 1e-8);
  EXPECT_LT(f.chi2, 1e-16);
}

TEST(LeastSquares, SameSeedSameResult) {
  const Polynomial data(energy_terms, 1e-3);
  const FitResult a = fit_least_squares(energy_box(), data.x.size(), data.residuals());
  const FitResult b = fit_least_squares(energy_box(), data.x.size(), data.residuals());
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_EQ(a.message, b.message);
}

// Two minima; the start lies in the basin of the worse one.
TEST(LeastSquares, StartsFindTheLowerMinimum) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    const double x = p[0];
    out[0] = (x - 3) * (x + 2);
    out[1] = 0.5 * (x - 3);
  };
  FitOptions one;
  one.starts = 1;
  EXPECT_NEAR(fit_least_squares({{"x", -3, -5, 5}}, 2, r).value[0], 3, 1e-8);
  EXPECT_LT(fit_least_squares({{"x", -3, -5, 5}}, 2, r, one).value[0], 0);
}

// --- What goes wrong ----------------------------------------------------------------------------------

TEST(LeastSquares, NaNEverywhere) {
  const auto r = [](const std::vector<double>&, std::vector<double>& out) { out[0] = out[1] = nan_value; };
  const FitResult f = fit_least_squares({{"a", 0, -1, 1}, {"b", 0, -1, 1}}, 2, r);
  EXPECT_EQ(f.verdict, Verdict::nothing_finite);
  EXPECT_FALSE(f.usable());
  EXPECT_EQ(f.evaluations, f.not_finite);
  EXPECT_LT(f.evaluations, 100);
  EXPECT_TRUE(std::isnan(f.chi2));
  EXPECT_THAT(f.message, HasSubstr("nothing finite"));
}

// NaN for a < 0.2; the start lies there.
TEST(LeastSquares, NaNInPartOfTheBox) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double x = static_cast<double>(k);
      out[k] = std::sqrt(p[0] - 0.2) * x + p[1] * x * x - (0.3 * x + 0.7 * x * x);
    }
  };
  const FitResult f = fit_least_squares({{"a", -0.5, -1, 1}, {"b", 0, -2, 2}}, 6, r);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 0.29, 1e-8);
  EXPECT_NEAR(f.value[1], 0.7, 1e-8);
  EXPECT_GT(f.not_finite, 0);
  EXPECT_THAT(f.message, HasSubstr("not finite at"));
}

// The lowest point lies at the edge of what is finite.
TEST(LeastSquares, LowestAtTheEdgeOfNaN) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    out[0] = p[0] < 0.2 ? std::numeric_limits<double>::infinity() : p[0];
    out[1] = p[1] - 0.4;
  };
  const FitResult f = fit_least_squares({{"a", 0.6, -1, 1}, {"b", 0, -1, 1}}, 2, r);
  EXPECT_NE(f.verdict, Verdict::nothing_finite);
  EXPECT_TRUE(std::isfinite(f.chi2));
  EXPECT_NEAR(f.value[0], 0.2, 1e-2) << f.message;
}

TEST(LeastSquares, BoundIsHitAndNamed) {
  const Polynomial data(energy_terms, 1e-3);
  auto box = energy_box();
  box[2].upper = 700;
  const FitResult f = fit_least_squares(box, data.x.size(), data.residuals());
  EXPECT_EQ(f.verdict, Verdict::at_bound) << f.message;
  EXPECT_TRUE(f.usable());
  EXPECT_THAT(f.at_bound, ElementsAre("square"));
  EXPECT_EQ(f.value[2], 700.0);
  EXPECT_THAT(f.message, HasSubstr("bound of square"));

  // Given that value, the others are the regression's.
  Eigen::MatrixXd a = data.design();
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(data.y.data(), a.rows());
  y -= 700 * a.col(2);
  Eigen::MatrixXd others(a.rows(), 3);
  others << a.col(0), a.col(1), a.col(3);
  const Eigen::VectorXd best = others.colPivHouseholderQr().solve(y);
  EXPECT_NEAR(f.value[0], best[0], 1e-6);
  EXPECT_NEAR(f.value[1] / best[1], 1, 1e-5);
  EXPECT_NEAR(f.value[3] / best[2], 1, 1e-5);
}

TEST(LeastSquares, StartInACornerLeavesIt) {
  const FitResult f = fit_least_squares({{"a", -5, -5, 5}, {"b", 20, -5, 20}}, 2, rosenbrock);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 1, 1e-8);
}

TEST(LeastSquares, UnreachableTargetShowsItsResidual) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = p[0] - (k % 2 ? 10 : -10);
  };
  const FitResult f = fit_least_squares({{"a", 3, -20, 20}}, 20, r);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 0, 1e-7);
  EXPECT_NEAR(f.rms, 10, 1e-9);
  EXPECT_NEAR(f.largest, 10, 1e-6);
  EXPECT_NEAR(f.standard_error[0], std::sqrt(100.0 / 19), 1e-6);
  EXPECT_THAT(f.message, HasSubstr("rms residual 10"));
}

// Only a + b and c are seen; d is not.
TEST(LeastSquares, DegenerateParametersAreUndetermined) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      const double x = static_cast<double>(k);
      out[k] = (p[0] + p[1]) + p[2] * x - (2 + 3 * x) + 1e-3 * std::cos(5 * x);
    }
  };
  const std::vector<FitParameter> box = {{"a", 0, -5, 5}, {"b", 0, -5, 5}, {"c", 0, -5, 5}, {"d", 0, -5, 5}};
  const FitResult f = fit_least_squares(box, 10, r);
  EXPECT_TRUE(f.usable()) << f.message;
  EXPECT_THAT(f.undetermined, ElementsAre("a", "b", "d"));
  EXPECT_TRUE(std::isnan(f.standard_error[0]));
  EXPECT_TRUE(std::isnan(f.standard_error[3]));
  EXPECT_GT(f.standard_error[2], 0);
  EXPECT_NEAR(f.value[0] + f.value[1], 2, 1e-3);
  EXPECT_NEAR(f.value[2], 3, 1e-3);
  EXPECT_TRUE(std::isinf(f.condition));
  EXPECT_THAT(f.message, HasSubstr("do not determine a, b, d"));
}

TEST(LeastSquares, SlowFunctionEndsInTime) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    rosenbrock(p, out);
  };
  FitOptions options;
  options.max_seconds = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  const FitResult f = fit_least_squares({{"a", -1.2, -5, 5}, {"b", 1, -5, 20}}, 2, r, options);
  EXPECT_EQ(f.verdict, Verdict::limit_reached) << f.message;
  EXPECT_FALSE(f.usable());
  EXPECT_LT(f.evaluations, 20);
  EXPECT_TRUE(std::isfinite(f.chi2));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(LeastSquares, EvaluationLimitIsKept) {
  FitOptions options;
  options.max_evaluations = 25;
  const FitResult f = fit_least_squares({{"a", -1.2, -5, 5}, {"b", 1, -5, 20}}, 2, rosenbrock, options);
  EXPECT_EQ(f.verdict, Verdict::limit_reached) << f.message;
  EXPECT_LE(f.evaluations, 25);
  EXPECT_THAT(f.message, HasSubstr("limit of 25 evaluations"));
}

// A jump that slopes away: a gradient cannot see what lies behind it.
TEST(LeastSquares, JumpsDoNotCrash) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    out[0] = std::floor(20 * p[0]) / 20 - 0.31;
    out[1] = std::floor(20 * p[1]) / 20 + 0.02 * p[0];
  };
  const FitResult f = fit_least_squares({{"a", 0.9, 0, 1}, {"b", 0.9, -1, 1}}, 2, r);
  EXPECT_TRUE(std::isfinite(f.chi2));
  EXPECT_FALSE(f.message.empty());
}

TEST(LeastSquares, ErrorOfTheCallerPasses) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) {
    if (p[0] > 0.5) throw std::domain_error("mine");
    out[0] = p[0] - 2;
  };
  EXPECT_THROW(fit_least_squares({{"a", 0, -1, 1}}, 1, r), std::domain_error);
}

TEST(LeastSquares, WrongInputIsRefused) {
  const auto r = [](const std::vector<double>&, std::vector<double>& out) { out[0] = 0; };
  EXPECT_THROW(fit_least_squares({{"a", 0, 1, -1}}, 1, r), std::invalid_argument);
  EXPECT_THROW(fit_least_squares({{"a", 0, 0, 0}}, 1, r), std::invalid_argument);
  EXPECT_THROW(fit_least_squares({{"a", 2, -1, 1}}, 1, r), std::invalid_argument);
  EXPECT_THROW(fit_least_squares({{"a", nan_value, -1, 1}}, 1, r), std::invalid_argument);
  EXPECT_THROW(fit_least_squares({{"a", 0, -1, 1}, {"b", 0, -1, 1}}, 1, r), std::invalid_argument);
  EXPECT_THROW(fit_least_squares({}, 0, r), std::invalid_argument);
  FitOptions options;
  options.max_evaluations = 0;
  EXPECT_THROW(fit_least_squares({{"a", 0, -1, 1}}, 1, r, options), std::invalid_argument);
}

TEST(LeastSquares, AsManyDataAsParametersHaveNoError) {
  const auto r = [](const std::vector<double>& p, std::vector<double>& out) { out[0] = p[0] - 0.25; };
  const FitResult f = fit_least_squares({{"a", 0, -1, 1}}, 1, r);
  EXPECT_EQ(f.verdict, Verdict::converged) << f.message;
  EXPECT_NEAR(f.value[0], 0.25, 1e-10);
  EXPECT_TRUE(std::isnan(f.standard_error[0]));
  EXPECT_THAT(f.undetermined, IsEmpty());
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::calibrate
