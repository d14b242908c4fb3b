#include <algorithm>
#include <cmath>

#include "contact/fit_contact.hpp"
#include "contact/line_targets.hpp"
#include "io/clocks.hpp"

namespace ropewalk::calibrate {
namespace {

Well well(const LineWell& w) { return {w.distance, w.energy}; }

void add_curves(const WallsIntegral& integral, const LineTargets& targets, LineFit& fit) {
  const double right = 0.5 * units::pi;
  std::vector<double> parallel, crossed;
  targets.energies(fit.density, parallel, crossed);
  for (std::size_t k = 0; k < targets.distances().size(); ++k) {
    const double R = targets.distances()[k];
    fit.u.push_back({R, 0, 0, integral.line_density(R), fit.density.energy(R)});
    fit.parallel_curve.push_back({R, 0, 0, targets.parallel()[k], parallel[k]});
    fit.crossed_curve.push_back({R, right, 0, targets.crossed()[k], crossed[k]});
  }
}

}  // namespace

void set_form(const std::vector<double>& p, LineDensity& d) {
  d.K = p[0], d.s = p[1], d.c = p[2], d.p = p[3], d.q = p[4];
}

FitResult fit_density(const LineTargets& targets, const AtomLaw& law, double unit, const FitOptions& options,
                      LineDensity& density) {
  // The core begins at 0.59 sigma, so that h + c stays above 0.1 sigma. p and q must differ, or K diverges.
  const double sigma = law.sigma;
  const std::vector<FitParameter> box = {{"K", 6 * unit, 0.5 * unit, 60 * unit},
                                         {"s", 0.8 * sigma, 0.3 * sigma, 3 * sigma},
                                         {"c", 0, -0.45 * sigma, 1.5 * sigma},
                                         {"p", 9, 5.6, 20},
                                         {"q", 4.2, 2, 5.4}};
  const auto residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    set_form(p, density);
    targets.residuals(density, r.data());
  };
  const FitResult fit = fit_least_squares(box, targets.size(), residuals, options);
  set_form(fit.value, density);
  return fit;
}

LineFit fit_line(const AtomLaw& law, const std::vector<Shell>& i, const std::vector<Shell>& j,
                 const FitOptions& options) {
  LineFit out;
  const double begin = steady_seconds();
  const WallsIntegral integral(law, i, j);
  const double contact = i.back().radius + j.back().radius;
  const LineTargets targets(integral, contact, line_gaps(law));
  out.seconds_integral = seconds_since(begin);

  const double fit_begin = steady_seconds();
  out.density = with_gaps(line_gaps(law), contact);
  out.fit = fit_density(targets, law, unit_of_K(law, i.back(), j.back()), options, out.density);
  out.seconds_fit = seconds_since(fit_begin);

  out.parallel = targets.parallel_well;
  out.crossed = targets.crossed_well;
  out.line_parallel = well(line_parallel_well(out.density));
  out.line_crossed = well(line_crossed_well(out.density, 0.5 * units::pi));
  out.error = targets.error(out.density);
  add_curves(integral, targets, out);
  return out;
}

}  // namespace ropewalk::calibrate
