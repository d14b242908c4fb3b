#include "contact/integral.hpp"

#include <gsl/gsl_chebyshev.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "contact/quadrature.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr std::size_t chebyshev_order = 96;  // terms of the Chebyshev series

// Distances R above `from` at which E' has a kink or ends: the two circles then touch at the cutoff.
std::vector<double> parts(const AtomLaw& law, const Shell& i, const Shell& j, double from) {
  std::vector<double> edges = {from};
  const double sum = i.radius + j.radius, difference = std::fabs(i.radius - j.radius);
  if (law.cutoff == infinite) {
    const double far = sum + 8 * law.sigma;  // beyond it the well is a power law
    if (far > from) edges.push_back(far);
    edges.push_back(infinite);
    return edges;
  }
  for (const double R : {law.cutoff - sum, law.cutoff - difference, law.cutoff + difference, law.cutoff + sum})
    if (R > edges.back() + 1e-6) edges.push_back(R);
  return edges;
}

// int_from^inf f(R, sqrt(R^2 - from^2)) dR, in parts; `from` is the first edge. The substitution R = from /
// cos(angle) removes the root at `from`.
template <class F>
double integrate_outwards(const std::vector<double>& edges, F f) {
  double sum = 0;
  const double from = edges.front();
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const auto at = [&](double angle) {
      const double c = std::cos(angle);
      return c > 1e-6 ? f(from / c, from * std::tan(angle)) * from * std::sin(angle) / (c * c) : 0.0;
    };
    sum += integrate_both_ends(at, std::acos(from / edges[k]), std::acos(from / edges[k + 1]));
  }
  return sum;
}

// Maps a coordinate in a part (0 to 1) to a distance and back. Points are dense at both ends of a part; an infinite
// part is stretched.
struct Part {
  double from, to, contact;
  double distance(double x) const {
    if (to == infinite) return contact + (from - contact) / std::max(x, 1e-3);
    return from + (to - from) * x * x * (3 - 2 * x);
  }
  double coordinate(double R) const {
    if (to == infinite) return (from - contact) / (R - contact);
    const double y = std::clamp((R - from) / (to - from), 0.0, 1.0);
    return 0.5 - std::sin(std::asin(1 - 2 * y) / 3);
  }
};

double tail_weight(double gap) { return std::pow(gap, 6); }

}  // namespace

double abel_inverse(const AtomLaw& law, const Shell& i, const Shell& j, double rho,
                    const std::function<double(double)>& slope) {
  if (rho >= law.cutoff + i.radius + j.radius) return 0;
  const auto f = [&](double R, double root) { return slope(R) / root; };
  return -integrate_outwards(parts(law, i, j, rho), f) / units::pi;
}

PairIntegral::PairIntegral(const AtomLaw& law, const Shell& i, const Shell& j, double nearest)
    : law_(law), i_(i), j_(j), contact_(i.radius + j.radius) {
  edges_ = parts(law, i, j, contact_ + (nearest > 0 ? nearest : 0.4 * law.sigma));
  if (edges_.size() < 2)
    throw std::invalid_argument("van der Waals: the cutoff of " + std::to_string(law.cutoff) +
                                " nm ends before the tubes attract each other");
  struct Task {
    const PairIntegral& self;
    Part part;
  };
  // The integrand may throw through gsl_cheb_init(), so that the series needs an owner.
  const std::unique_ptr<gsl_cheb_series, void (*)(gsl_cheb_series*)> series(gsl_cheb_alloc(chebyshev_order),
                                                                            gsl_cheb_free);
  for (std::size_t k = 0; k + 1 < edges_.size(); ++k) {
    Task task{*this, {edges_[k], edges_[k + 1], contact_}};
    gsl_function f;
    f.function = [](double x, void* data) {
      const Task& t = *static_cast<Task*>(data);
      const double R = t.part.distance(x);
      return parallel_energy_derivative(t.self.law_, t.self.i_, t.self.j_, R) * tail_weight(R - t.self.contact_);
    };
    f.params = &task;
    gsl_cheb_init(series.get(), &f, 0, 1);
    series_.emplace_back(series->c, series->c + chebyshev_order + 1);
  }
}

double PairIntegral::slope(double distance) const {
  if (distance >= edges_.back()) return 0;
  std::size_t k = 0;
  while (k + 2 < edges_.size() && distance >= edges_[k + 1]) ++k;
  const double x = 2 * Part{edges_[k], edges_[k + 1], contact_}.coordinate(distance) - 1;
  const std::vector<double>& c = series_[k];
  double b1 = 0, b2 = 0;  // Clenshaw's sum
  for (std::size_t n = chebyshev_order; n > 0; --n) {
    const double b = 2 * x * b1 - b2 + c[n];
    b2 = b1;
    b1 = b;
  }
  return (x * b1 - b2 + 0.5 * c[0]) / tail_weight(distance - contact_);
}

double PairIntegral::parallel(double distance) const {
  if (distance >= edges_.back()) return 0;
  return -integrate_outwards(parts(law_, i_, j_, distance), [&](double R, double) { return slope(R); });
}

double PairIntegral::crossed(double distance) const {
  if (distance >= edges_.back()) return 0;
  const auto f = [&](double R, double root) { return slope(R) * root; };
  return -2 * integrate_outwards(parts(law_, i_, j_, distance), f);
}

double PairIntegral::line_density(double rho) const {
  return abel_inverse(law_, i_, j_, rho, [&](double R) { return slope(R); });
}

namespace {

// The smallest distance at which the slope changes from negative to positive.
double rising_zero(const std::function<double(double)>& slope, double nearest, double end, double farthest);

}  // namespace

Well PairIntegral::parallel_well() const {
  const double at = rising_zero([&](double R) { return slope(R); }, nearest(), end(), contact_ + 10 * law_.sigma);
  return {at, parallel(at)};
}

// dX/dR = -2 pi R u(R)
Well PairIntegral::crossed_well() const {
  const double at =
      rising_zero([&](double R) { return -line_density(R); }, nearest(), end(), contact_ + 10 * law_.sigma);
  return {at, crossed(at)};
}

namespace {

double rising_zero(const std::function<double(double)>& slope, double nearest, double end, double farthest) {
  constexpr double step = 0.02;
  double a = nearest, b = a + step;
  while (slope(a) < 0 && slope(b) < 0) {
    a = b;
    b += step;
    if (b >= end || b > farthest) break;
  }
  if (!(slope(a) < 0 && slope(b) >= 0 && b < end))
    throw std::invalid_argument("van der Waals: this pair of tubes has no well within the cutoff");
  gsl_function f;
  f.function = [](double R, void* data) { return (*static_cast<const std::function<double(double)>*>(data))(R); };
  f.params = const_cast<std::function<double(double)>*>(&slope);
  const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> owner(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  gsl_root_fsolver* solver = owner.get();
  gsl_root_fsolver_set(solver, &f, a, b);
  for (int k = 0; k < 60 && gsl_root_fsolver_x_upper(solver) - gsl_root_fsolver_x_lower(solver) > 1e-11; ++k)
    gsl_root_fsolver_iterate(solver);
  return gsl_root_fsolver_root(solver);
}

}  // namespace

WallsIntegral::WallsIntegral(const AtomLaw& law, const std::vector<Shell>& i, const std::vector<Shell>& j)
    : law_(law), contact_(i.back().radius + j.back().radius) {
  const double nearest = contact_ + 0.4 * law.sigma;
  for (auto a = i.rbegin(); a != i.rend(); ++a)
    for (auto b = j.rbegin(); b != j.rend(); ++b) {
      const double contact = a->radius + b->radius;
      const bool outer = a == i.rbegin() && b == j.rbegin();
      if (outer)
        pairs_.emplace_back(law, *a, *b);
      else if (contact + law.cutoff > nearest + 0.01)
        pairs_.emplace_back(law, *a, *b, nearest - contact);
    }
}

double WallsIntegral::parallel(double distance) const {
  double sum = 0;
  for (const PairIntegral& pair : pairs_) sum += pair.parallel(distance);
  return sum;
}

double WallsIntegral::crossed(double distance) const {
  double sum = 0;
  for (const PairIntegral& pair : pairs_) sum += pair.crossed(distance);
  return sum;
}

double WallsIntegral::line_density(double rho) const {
  double sum = 0;
  for (const PairIntegral& pair : pairs_) sum += pair.line_density(rho);
  return sum;
}

Well WallsIntegral::parallel_well() const {
  const auto slope = [&](double R) {
    double sum = 0;
    for (const PairIntegral& pair : pairs_) sum += pair.slope(R);
    return sum;
  };
  const PairIntegral& outer = pairs_.front();
  const double at = rising_zero(slope, outer.nearest(), outer.end(), contact_ + 10 * law_.sigma);
  return {at, parallel(at)};
}

Well WallsIntegral::crossed_well() const {
  const PairIntegral& outer = pairs_.front();
  const double at = rising_zero([&](double R) { return -line_density(R); }, outer.nearest(), outer.end(),
                                contact_ + 10 * law_.sigma);
  return {at, crossed(at)};
}

}  // namespace ropewalk::calibrate
