// The terms of the energy beyond Hooke's law, from cells up to the limits of a tube.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "atomistic/stiffness.hpp"
#include "fit/least_squares.hpp"

namespace ropewalk::calibrate {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// A linear problem: energies per length (eV/nm), what Hooke's law leaves of them, and the powers that each term has
// there. Energies count relative to themselves, small ones relative to a twentieth of the largest.
struct Samples {
  std::vector<double> energy, left;
  std::vector<std::vector<double>> powers;
  std::vector<AtomisticRow*> rows;
};

struct Solution {
  Vector terms, errors;
  double largest = 0;  // relative error of an energy
};

Solution solve(const Samples& s, const char* what) {
  const auto rows = static_cast<Eigen::Index>(s.left.size());
  const auto terms = rows > 0 ? static_cast<Eigen::Index>(s.powers.front().size()) : 0;
  if (rows < terms + 2)
    throw InputError({"", 0, what}, fmt::format("{} energies do not determine {} terms", rows, terms),
                     "give more strains, twists or curvatures");
  const double floor = 0.05 * *std::max_element(s.energy.begin(), s.energy.end());
  Matrix a(rows, terms);
  Vector b(rows), weight(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    weight[i] = 1 / std::max(s.energy[k], floor);
    b[i] = weight[i] * s.left[k];
    for (Eigen::Index j = 0; j < terms; ++j) a(i, j) = weight[i] * s.powers[k][static_cast<std::size_t>(j)];
  }
  const Eigen::ColPivHouseholderQR<Matrix> qr(a);
  if (qr.rank() < terms)
    throw InputError({"", 0, what}, "the energies do not determine the terms beyond Hooke's law",
                     "give more strains, twists or curvatures");
  Solution out;
  out.terms = qr.solve(b);
  const Vector off = a * out.terms - b;
  out.largest = off.cwiseAbs().maxCoeff();
  const double variance = off.squaredNorm() / static_cast<double>(rows - terms);
  out.errors = (variance * (a.transpose() * a).inverse().diagonal()).cwiseSqrt();
  for (Eigen::Index i = 0; i < rows; ++i) {
    AtomisticRow& row = *s.rows[static_cast<std::size_t>(i)];
    row.residual = -off[i] / weight[i] * row.length;
  }
  return out;
}

}  // namespace

Anharmonic AnharmonicFit::law(double radius, double coupling) const {
  Anharmonic h;
  if (terms.empty()) return h;
  h.used = true;
  h.radius = radius;
  h.coupling = coupling;
  for (std::size_t k = 0; k < terms.size(); ++k) h.*anharmonic_terms[k].value = terms[k].value;
  h.min_strain = min_strain;
  h.max_strain = max_strain;
  h.max_shear = max_shear;
  h.max_bend = max_bend;
  return h;
}

void fit_anharmonic(std::vector<AtomisticRow>& table, Chirality c, Stiffness& out) {
  const bool chiral = c.chiral();
  const double r = out.radius.value;
  AnharmonicFit& fit = out.anharmonic;
  fit.terms.assign(std::size(anharmonic_terms), {});

  // Powers (of strain, of shear) of the terms e3 .. s4; odd powers of the shear belong to chiral tubes.
  constexpr int powers[][2] = {{3, 0}, {2, 1}, {1, 2}, {0, 3}, {4, 0}, {3, 1}, {2, 2}, {1, 3}, {0, 4}};
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < std::size(powers); ++k)
    if (chiral || powers[k][1] % 2 == 0) used.push_back(k);
  Samples straight;
  for (AtomisticRow& row : table) {
    if (row.kind != "wide-stretch-twist") continue;
    const double e = row.strain, t = row.twist - out.natural_twist.value, s = r * t,
                 energy = row.energy / row.length;
    straight.rows.push_back(&row);
    straight.energy.push_back(energy);
    straight.left.push_back(energy - 0.5 * out.EA.value * e * e - 0.5 * out.GJ.value * t * t -
                            out.coupling.value * e * t);
    std::vector<double> at;
    for (const std::size_t k : used) at.push_back(std::pow(e, powers[k][0]) * std::pow(s, powers[k][1]));
    straight.powers.push_back(at);
    fit.min_strain = std::min(fit.min_strain, e);
    fit.max_strain = std::max(fit.max_strain, e);
    fit.max_shear = std::max(fit.max_shear, std::abs(s));
  }
  const Solution stretch = solve(straight, "wide-stretch-twist");
  for (std::size_t k = 0; k < used.size(); ++k)
    fit.terms[used[k]] = {stretch.terms[static_cast<Eigen::Index>(k)],
                          stretch.errors[static_cast<Eigen::Index>(k)]};
  fit.stretch_twist_error = stretch.largest;

  Samples bent;
  for (AtomisticRow& l : table)
    for (const AtomisticRow& s : table) {
      const double k2 = l.curvature * l.curvature, length = l.length - s.length;
      if (l.kind != "wide-bend-long" || s.kind != "wide-bend-short" || k2 == 0 ||
          std::abs(l.curvature - s.curvature) > 1e-9 * l.curvature)
        continue;
      const double energy = (l.energy - s.energy) / length;
      bent.rows.push_back(&l);
      bent.energy.push_back(energy);
      bent.left.push_back(energy - 0.5 * out.EI.value * k2);
      bent.powers.push_back({r * r * r * r * k2 * k2});
      fit.max_bend = std::max(fit.max_bend, r * l.curvature);
    }
  const Solution bend = solve(bent, "wide-bend");
  fit.terms.back() = {bend.terms[0], bend.errors[0]};
  fit.bend_error = bend.largest;

  out.fit_report += fmt::format(
      "beyond Hooke's law: {} cells, strain {:.3g} to {:.3g}, shear <= {:.3g}: largest error {:.2g} of an energy; "
      "{} bends, radius times curvature <= {:.3g}: {:.2g}\n",
      straight.rows.size(), fit.min_strain, fit.max_strain, fit.max_shear, fit.stretch_twist_error,
      bent.rows.size(), fit.max_bend, fit.bend_error);
  // The tube holds up to the kink, and the quartic term with it.
  fit.max_bend = std::max(fit.max_bend, r * out.envelope.kink_curvature.value);
  constexpr double tolerable = 0.02;
  if (std::max(fit.stretch_twist_error, fit.bend_error) < tolerable) return;
  out.warnings.push_back(
      fmt::format("the terms beyond Hooke's law miss energies by up to {:.1f} % (stretch and twist) and {:.1f} % "
                  "(bending), as where "
                  "the potential has a knot or the tube kinks early: the set has harmonic bonds alone",
                  100 * fit.stretch_twist_error, 100 * fit.bend_error));
  fit = {};
}

void fit_collapse(std::vector<AtomisticRow>& table, Stiffness& out) {
  AnharmonicFit& fit = out.anharmonic;
  const double r = out.radius.value;
  std::vector<AtomisticRow*> rows;
  double largest = 0;
  for (AtomisticRow& row : table) {
    if (row.kind != "collapse-twist") continue;
    rows.push_back(&row);
    largest = std::max(largest, r * std::abs(row.twist - out.natural_twist.value));
  }
  Anharmonic law = fit.law(r, out.coupling.value);
  const Residuals residuals = [&](const std::vector<double>& p, std::vector<double>& left) {
    law.max_shear = p[0] * fit.max_shear;
    for (std::size_t i = 0; i < rows.size(); ++i)
      left[i] = twist_energy(law, out.GJ.value, rows[i]->twist - out.natural_twist.value).energy /
                    (rows[i]->energy / rows[i]->length) -
                1;
  };
  FitOptions options;
  options.starts = 2;
  const FitResult found = fit_least_squares({{"edge", 0.8, 0.2, 2, true}}, rows.size(), residuals, options);
  if (found.verdict != FitResult::Verdict::converged) {
    out.warnings.push_back("the collapse: " + found.message + "; the set says nothing about endless tubes");
    return;
  }
  std::vector<double> left(rows.size());
  residuals(found.value, left);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    fit.collapse_error = std::max(fit.collapse_error, std::abs(left[i]));
    rows[i]->residual = -left[i] * rows[i]->energy;
  }
  constexpr double tolerable = 0.05;
  if (fit.collapse_error > tolerable) {
    out.warnings.push_back(
        fmt::format("a torque that is constant beyond the collapse misses energies by up to {:.0f} %, as of wide "
                    "tubes, which stay "
                    "round for a while where a ribbon has less energy: the set says nothing about endless tubes",
                    100 * fit.collapse_error));
    return;
  }
  fit.collapse_shear = largest;
  out.envelope.endless_collapse = {law.max_shear, found.standard_error[0] * fit.max_shear};
  out.fit_report += fmt::format(
      "collapse: torque constant beyond a shear of {:.4g}; {} cells up to {:.3g}: largest error {:.2g} of "
      "an energy; {}\n",
      law.max_shear, rows.size(), largest, fit.collapse_error, found.message);
}

}  // namespace ropewalk::calibrate
