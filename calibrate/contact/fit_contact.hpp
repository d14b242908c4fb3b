// Fits of the two contact laws of mdem/model, and of the universal one, to the surface integral.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "contact/van_der_waals.hpp"
#include "fit/least_squares.hpp"
#include "model/contact/line.hpp"
#include "model/contact/paper.hpp"

namespace ropewalk::calibrate {

// A point of the integral with the fit, for tables and plots.
struct ContactPoint {
  double distance = 0;  // nm: rho, R
  double angle = 0;     // rad; crossing angle, 0: parallel
  double theta = 0;     // rad; paper form only: line of centres against the axes' bisector
  double integral = 0;  // eV/nm^2, eV/nm or eV
  double fit = 0;
};

struct LineFit {
  LineDensity density;
  FitResult fit;                     // parameters K, s, c, p, q in this order
  Well parallel, crossed;            // minima of the integral; crossed at 90 degrees
  Well line_parallel, line_crossed;  // minima of the fitted density
  double error = 0;                  // largest |fit - integral| of parallel and crossed over the well, from
                                     // 0.05 nm inside of the minimum outwards
  std::vector<ContactPoint> u, parallel_curve, crossed_curve;
  double seconds_integral = 0, seconds_fit = 0;
};
// `i`, `j`: the walls of both tubes, inside first.
LineFit fit_line(const AtomLaw& law, const std::vector<Shell>& i, const std::vector<Shell>& j,
                 const FitOptions& options = {});
inline LineFit fit_line(const AtomLaw& law, const Shell& i, const Shell& j, const FitOptions& options = {}) {
  return fit_line(law, std::vector{i}, std::vector{j}, options);
}

// The universal law, fitted to all pairs of radii of the range, equal and unequal.
struct UniversalFit {
  UniversalLine law;
  FitResult fit;  // the rows one after the other
  UniversalLine::Row se_log_K{}, se_s{}, se_c{}, se_p{}, se_q{};
  double error = 0;  // largest over all pairs, as LineFit::error
  struct PairCheck {
    double r_i = 0, r_j = 0, direct_error = 0, error = 0, spacing_error = 0, depth_error = 0;
  };
  std::vector<PairCheck> pairs;
};
UniversalFit fit_universal(const AtomLaw& law, const std::vector<std::pair<double, double>>& radii);

// The published form (11 free parameters: epsilon A, epsilon B, alpha, beta, C1..C5, C_gamma, delta) for elements
// of the given length, to the integrated energies of parallel rows and crossed tubes.
inline constexpr const char* paper_parameters[] = {
    "A", "B", "alpha", "beta", "C1", "C2", "C3", "C4", "C5", "C_gamma", "delta"};  // the order of the fit
struct PaperFit {
  PaperContact law;
  FitResult fit;
  Well parallel, crossed;  // minima of the fitted law between rows of elements
  double error = 0;        // as LineFit::error
  std::vector<ContactPoint> points;
};
PaperFit fit_paper(const AtomLaw& law, const Shell& shell, double element_length, const FitOptions& options = {});

// The constants of a law from the parameters of its fit, in the fit's order.
void set_form(const std::vector<double>& p, LineDensity& law);
void set_form(const std::vector<double>& p, PaperContact& law);

}  // namespace ropewalk::calibrate
