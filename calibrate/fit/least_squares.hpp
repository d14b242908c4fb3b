// Bounded nonlinear least squares by NLopt, with checks:
//
//   minimise  chi2(p) = sum_k residual_k(p)^2   over the free parameters, lower <= p <= upper.
//
// There are several starts (the given one first, the others drawn in the box from a fixed seed) and two algorithms,
// which must agree. If a residual is not finite, the optimiser gets a large value instead. Evaluations and wall
// time are limited, so that every run ends. The standard errors are those of the linearised model at the minimum,
// s^2 (J^T J)^-1 with s^2 = chi2 / (residuals - free parameters). Source: S. G. Johnson, The NLopt
// nonlinear-optimization package.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace ropewalk::calibrate {

struct FitParameter {
  std::string name;
  double start = 0;
  double lower = 0, upper = 0;
  bool free = true;  // a parameter that is not free keeps its start
};

// Writes the (weighted) residuals at p; the size of r is that given to fit_least_squares.
using Residuals = std::function<void(const std::vector<double>& p, std::vector<double>& r)>;

struct FitOptions {
  int starts = 8;
  int max_evaluations = 20000;  // of the residuals, over all starts and algorithms
  // None, unless somebody asks: what a fit gives must not depend on the speed of the machine.
  double max_seconds = std::numeric_limits<double>::infinity();
  double tolerance = 1e-10;  // relative, of chi2 and of the parameters in units of their box
  double agreement = 1e-4;   // relative difference of chi2 up to which the two algorithms agree
  std::uint64_t seed = 1;
};

struct FitResult {
  enum class Verdict { converged, at_bound, disagreement, limit_reached, nothing_finite };
  Verdict verdict = Verdict::nothing_finite;
  std::string message;                 // one line for a person: the verdict and what to do
  std::vector<double> value;           // all parameters, in their order
  std::vector<double> standard_error;  // 0 for a fixed parameter, NaN for one that the data do not determine
  // Correlation matrix of the parameters' errors. A parameter that is fixed, or that the data do not determine, has
  // 1 on the diagonal and 0 elsewhere.
  std::vector<std::vector<double>> correlation;
  std::vector<std::string> at_bound;  // names
  std::vector<std::string> undetermined;
  double chi2 = 0;
  double rms = 0;      // sqrt(chi2 / number of residuals)
  double largest = 0;  // |residual|
  int evaluations = 0, not_finite = 0;
  double condition = 0;  // condition number of the scaled J^T J
  bool usable() const { return verdict == Verdict::converged || verdict == Verdict::at_bound; }
};

// Throws std::invalid_argument for an empty or inverted box, a start outside of it, or fewer residuals than free
// parameters. The verdict reports all other failures.
FitResult fit_least_squares(const std::vector<FitParameter>& parameters, std::size_t residuals,
                            const Residuals& function, const FitOptions& options = {});

}  // namespace ropewalk::calibrate
