#include "contact/line_targets.hpp"

#include <algorithm>
#include <cmath>

#include "contact/quadrature.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr double inside = 0.05;   // nm inside of the minimum: the error is evaluated from here outwards
constexpr double deepest = 0.1;   // nm inside of the minimum: the fit uses distances from here outwards
constexpr std::size_t order = 5;  // nodes between two distances of the grid

// Nodes of Gauss and Legendre on [0, 1], and the polynomials that are 1 at one of them and 0 at the others.
struct Panel {
  double abscissa[order], weight[order];

  Panel() {
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(order);
    for (std::size_t k = 0; k < order; ++k) gsl_integration_glfixed_point(0, 1, k, &abscissa[k], &weight[k], table);
    gsl_integration_glfixed_table_free(table);
  }
  double basis(std::size_t k, double x) const {
    double product = 1;
    for (std::size_t l = 0; l < order; ++l)
      if (l != k) product *= (x - abscissa[l]) / (abscissa[k] - abscissa[l]);
    return product;
  }
};

// Weight 1 where the energy is negative, less at the repulsive wall, where a small shift makes a large difference.
double weight(double energy, double well) { return 1 / (std::fabs(well) + 2 * std::max(energy, 0.0)); }

}  // namespace

LineGaps line_gaps(const AtomLaw& law) {
  const double core = 0.59 * law.sigma;
  if (!std::isfinite(law.cutoff)) return {core, 2.7, 3.0};
  return {core, 0.5, 1.21 * law.cutoff};
}

LineDensity with_gaps(const LineGaps& gaps, double contact) {
  LineDensity d;
  d.contact = contact;
  d.core_gap = gaps.core;
  d.switch_gap = gaps.switching;
  d.cutoff_gap = gaps.cutoff;
  return d;
}

double unit_of_K(const AtomLaw& law, const Shell& i, const Shell& j) {
  return law.epsilon * i.density * j.density * law.sigma * law.sigma;
}

LineTargets::LineTargets(const WallsIntegral& integral, double contact, const LineGaps& gaps)
    : parallel_well(integral.parallel_well()), crossed_well(integral.crossed_well()) {
  // The grid contains the smallest distance at which the error is evaluated, since the error is steepest there.
  const double end = contact + gaps.cutoff, judged = parallel_well.distance - inside;
  const double outer = std::ceil((end - judged) / 0.02), step = (end - judged) / outer;
  const double inner = std::ceil((judged - crossed_well.distance + deepest) / step);
  const std::size_t panels = static_cast<std::size_t>(inner + outer);
  for (std::size_t k = 0; k < panels; ++k) {
    const double R = judged + step * (static_cast<double>(k) - inner);
    distance_.push_back(R);
    parallel_.push_back(integral.parallel(R));
    crossed_.push_back(integral.crossed(R));
    const bool near = R < parallel_well.distance - deepest;
    weight_parallel_.push_back(near ? 0 : weight(parallel_.back(), parallel_well.energy));
    weight_crossed_.push_back(weight(crossed_.back(), crossed_well.energy));
  }
  add_nodes(end);
}

// E(R) = 2 int_R u(rho) rho drho / sqrt(rho^2 - R^2) and X(R) = 2 pi int_R u rho drho, exact for a u that is a
// polynomial between two distances of the grid.
void LineTargets::add_nodes(double end) {
  const Panel panel;
  const std::size_t panels = distance_.size();
  const double step = (end - distance_.front()) / static_cast<double>(panels);
  for (std::size_t k = 0; k < panels; ++k)
    for (std::size_t n = 0; n < order; ++n) {
      node_.push_back(distance_[k] + step * panel.abscissa[n]);
      node_crossed_.push_back(2 * units::pi * node_.back() * step * panel.weight[n]);
    }
  node_parallel_.assign(panels * node_.size(), 0.0);
  for (std::size_t row = 0; row < panels; ++row) {
    const double R = distance_[row];
    for (std::size_t k = row; k < panels; ++k)
      for (std::size_t n = 0; n < order; ++n)
        // The substitution t = sqrt(rho^2 - R^2) removes the root.
        node_parallel_[row * node_.size() + k * order + n] =
            2 *
            integrate_both_ends([&](double t) { return panel.basis(n, (std::hypot(R, t) - distance_[k]) / step); },
                                std::sqrt(std::max(0.0, square(distance_[k]) - R * R)),
                                std::sqrt(square(distance_[k] + step) - R * R));
  }
}

void LineTargets::energies(const LineDensity& density, std::vector<double>& parallel,
                           std::vector<double>& crossed) const {
  const std::size_t n = node_.size(), rows = distance_.size();
  std::vector<double> u(n);
  for (std::size_t k = 0; k < n; ++k) u[k] = density.energy(node_[k]);
  parallel.resize(rows);
  crossed.resize(rows);
  double beyond = 0;
  for (std::size_t row = rows; row-- > 0;) {
    const double* w = &node_parallel_[row * n];
    double sum = 0;
    for (std::size_t k = row * order; k < n; ++k) sum += w[k] * u[k];
    for (std::size_t k = row * order; k < (row + 1) * order; ++k) beyond += node_crossed_[k] * u[k];
    parallel[row] = sum;
    crossed[row] = beyond;
  }
}

void LineTargets::residuals(const LineDensity& density, double* out) const {
  std::vector<double> parallel, crossed;
  energies(density, parallel, crossed);
  const std::size_t rows = distance_.size();
  for (std::size_t k = 0; k < rows; ++k) {
    out[k] = weight_parallel_[k] * (parallel[k] - parallel_[k]);
    out[rows + k] = weight_crossed_[k] * (crossed[k] - crossed_[k]);
  }
}

double LineTargets::error(const LineDensity& density) const {
  std::vector<double> parallel, crossed;
  energies(density, parallel, crossed);
  double largest = 0;
  for (std::size_t k = 0; k < distance_.size(); ++k) {
    if (distance_[k] >= parallel_well.distance - inside - 1e-9)
      largest = std::max(largest, std::fabs((parallel[k] - parallel_[k]) / parallel_well.energy));
    if (distance_[k] >= crossed_well.distance - inside - 1e-9)
      largest = std::max(largest, std::fabs((crossed[k] - crossed_[k]) / crossed_well.energy));
  }
  return largest;
}

}  // namespace ropewalk::calibrate
