// Quadrature by GSL: adaptive, and with fixed nodes for integrands that are smooth except at the ends.
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

#include "model/units.hpp"

namespace ropewalk::calibrate {

inline double square(double x) { return x * x; }

// Gauss-Legendre nodes on [0, 1], quadratically dense towards both ends, so that roots and logarithms at the ends
// are integrated to many digits.
class Nodes {
 public:
  static const Nodes& get() {
    static const Nodes nodes;
    return nodes;
  }
  static constexpr std::size_t count = 64;
  double abscissa[count], weight[count];  // towards 1 only
  double both_abscissa[count], both_weight[count];

 private:
  Nodes() {
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(count);
    for (std::size_t k = 0; k < count; ++k) {
      double t = 0, w = 0;
      gsl_integration_glfixed_point(0, 1, k, &t, &w, table);
      abscissa[k] = std::sin(0.5 * units::pi * t);
      weight[k] = w * 0.5 * units::pi * std::cos(0.5 * units::pi * t);
      both_abscissa[k] = t * t * (3 - 2 * t);
      both_weight[k] = w * 6 * t * (1 - t);
    }
    gsl_integration_glfixed_table_free(table);
  }
};

template <class F>
double integrate_to_end(F f, double a, double b) {
  const Nodes& n = Nodes::get();
  double sum = 0;
  for (std::size_t k = 0; k < Nodes::count; ++k) sum += n.weight[k] * f(a + (b - a) * n.abscissa[k]);
  return (b - a) * sum;
}

template <class F>
double integrate_both_ends(F f, double a, double b) {
  const Nodes& n = Nodes::get();
  double sum = 0;
  for (std::size_t k = 0; k < Nodes::count; ++k) sum += n.both_weight[k] * f(a + (b - a) * n.both_abscissa[k]);
  return (b - a) * sum;
}

// Adaptive quadrature on [a, b], accurate to 1e-9 of the result or to `absolute`.
class Quadrature {
 public:
  Quadrature() : work_(gsl_integration_workspace_alloc(limit), gsl_integration_workspace_free) {}

  template <class F>
  double operator()(F f, double a, double b, double absolute) {
    gsl_function g;
    g.function = [](double x, void* data) { return (*static_cast<F*>(data))(x); };
    g.params = &f;
    double result = 0, error = 0;
    gsl_error_handler_t* handler = gsl_set_error_handler_off();
    const int status = gsl_integration_qags(&g, a, b, absolute, 1e-9, limit, work_.get(), &result, &error);
    gsl_set_error_handler(handler);
    // Rounding may prevent the last digits; a larger error is a failure.
    if (status != GSL_SUCCESS && error > 1e3 * absolute + 1e-6 * std::fabs(result))
      throw std::runtime_error(std::string("van der Waals integral: quadrature failed (") + gsl_strerror(status) +
                               ")");
    return result;
  }

 private:
  static constexpr std::size_t limit = 200;
  std::unique_ptr<gsl_integration_workspace, void (*)(gsl_integration_workspace*)> work_;
};

}  // namespace ropewalk::calibrate
