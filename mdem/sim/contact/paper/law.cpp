#include "sim/contact/paper/law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "model/error.hpp"

namespace ropewalk {
namespace {

// Between two points that bracket a minimum.
template <class F>
double golden_section(F f, double a, double b, double tolerance) {
  const double part = 0.5 * (std::sqrt(5.0) - 1);
  double x1 = b - part * (b - a), x2 = a + part * (b - a);
  double f1 = f(x1), f2 = f(x2);
  while (b - a > tolerance) {
    if (f1 < f2) {
      b = x2;
      x2 = x1;
      f2 = f1;
      x1 = b - part * (b - a);
      f1 = f(x1);
    } else {
      a = x1;
      x1 = x2;
      f1 = f2;
      x2 = a + part * (b - a);
      f2 = f(x2);
    }
  }
  return 0.5 * (a + b);
}

// The distance at which two tubes bind best, their energy given. `key` is what to type where they do not bind.
template <class F>
double lowest(const PaperContact& contact, const char* key, F energy) {
  // The well is found on a grid first: beyond it the energy is not convex.
  constexpr int grid = 400;
  const double from = 2 * contact.radius, step = (contact.cutoff() - from) / grid;
  std::vector<double> at;
  for (int k = 0; k <= grid; ++k) at.push_back(energy(from + k * step));
  const auto well = static_cast<int>(std::min_element(at.begin(), at.end()) - at.begin());
  if (well == 0 || well == grid || at[static_cast<std::size_t>(well)] >= 0)
    throw InputError({"", 0, "contact.paper"}, "does not bind two tubes", std::string("type ") + key);
  return golden_section(energy, from + (well - 1) * step, from + (well + 1) * step, 1e-9);
}

}  // namespace

double pair_spacing(const PaperContact& contact, double element_length) {
  return lowest(contact, "rope.spacing_nm",
                [&](double spacing) { return paper_parallel_energy(contact, element_length, spacing); });
}

PaperWells paper_wells(const PaperContact& contact, double element_length) {
  PaperWells out;
  out.spacing = pair_spacing(contact, element_length);
  out.parallel = paper_parallel_energy(contact, element_length, out.spacing);
  out.crossed_deepest = std::numeric_limits<double>::infinity();
  out.crossed_shallowest = -out.crossed_deepest;
  constexpr int parts = 4;  // parts of half an element; the other half mirrors it
  for (int i = 0; i <= parts; ++i)
    for (int j = 0; j <= i; ++j) {
      const auto energy = [&](double distance) {
        return paper_crossed_energy(contact, element_length, distance, 0.5 * units::pi, 0.5 * i / parts,
                                    0.5 * j / parts);
      };
      double well = std::numeric_limits<double>::infinity();
      for (double d = 2 * contact.radius; d < 1.5 * out.spacing; d += 0.01 * contact.radius)
        well = std::min(well, energy(d));
      out.crossed_deepest = std::min(out.crossed_deepest, well);
      out.crossed_shallowest = std::max(out.crossed_shallowest, well);
    }
  return out;
}

double PaperLaw::parallel_distance(TypePair, double length) const { return pair_spacing(contact, length); }

double PaperLaw::crossed_distance(TypePair, double length) const {
  return lowest(contact, "film.spacing_nm",
                [&](double spacing) { return paper_crossed_energy(contact, length, spacing, 0.5 * units::pi); });
}

double PaperLaw::binding(TypePair, double length) const {
  double deepest = 0;
  for (double d = 2 * contact.radius; d < contact.cutoff(); d += 0.005 * contact.radius)
    deepest = std::min(deepest, paper_parallel_energy(contact, length, d));
  return -deepest;
}

}  // namespace ropewalk
