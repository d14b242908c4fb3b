// The elastic constants from a table of energies.
//
// The energy per length is a polynomial in scaled strain u and twist v. Its coefficients follow from linear least
// squares, its minimum from Newton steps; the Taylor series about the minimum gives the constants. They are the
// start of the bounded fit in the physical parameters, which gives the standard errors and the verdict.
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

struct Power {
  int u, v;
};

std::vector<Power> powers_up_to(int degree) {
  std::vector<Power> powers;
  for (int order = 0; order <= degree; ++order)
    for (int v = 0; v <= order; ++v) powers.push_back({order - v, v});
  return powers;
}

double raised(double x, int power) {
  double result = 1;
  for (int i = 0; i < power; ++i) result *= x;
  return result;
}

double binomial(int n, int k) {
  double result = 1;
  for (int i = 0; i < k; ++i) result *= static_cast<double>(n - i) / (i + 1);
  return result;
}

struct EnergyPoint {
  double u, v, y;
};

struct Polynomial {
  std::vector<Power> powers;
  Vector coefficients;

  double operator()(double u, double v) const {
    double y = 0;
    for (std::size_t k = 0; k < powers.size(); ++k)
      y += coefficients[static_cast<Eigen::Index>(k)] * raised(u, powers[k].u) * raised(v, powers[k].v);
    return y;
  }
  // The coefficient of (u-u0)^i (v-v0)^j about (u0, v0).
  double taylor(int i, int j, double u0, double v0) const {
    double sum = 0;
    for (std::size_t k = 0; k < powers.size(); ++k) {
      const Power p = powers[k];
      if (p.u >= i && p.v >= j)
        sum += coefficients[static_cast<Eigen::Index>(k)] * binomial(p.u, i) * binomial(p.v, j) *
               raised(u0, p.u - i) * raised(v0, p.v - j);
    }
    return sum;
  }
};

// Different values among the points: n of them carry powers up to n - 1.
int different(const std::vector<EnergyPoint>& points, double EnergyPoint::*coordinate) {
  std::vector<double> values;
  for (const EnergyPoint& p : points) {
    const auto same = [&](double x) { return std::abs(x - p.*coordinate) < 0.02; };
    if (std::none_of(values.begin(), values.end(), same)) values.push_back(p.*coordinate);
  }
  return static_cast<int>(values.size());
}

// False where the points do not determine the polynomial. Powers for which there are too few different values
// keep the coefficients of `base`, where that is given.
bool fit_polynomial(const std::vector<EnergyPoint>& points, int degree, Polynomial& fit,
                    const Polynomial* base = nullptr) {
  const int max_u = different(points, &EnergyPoint::u) - 1, max_v = different(points, &EnergyPoint::v) - 1;
  fit.powers.clear();
  Polynomial kept;
  for (const Power& p : powers_up_to(degree)) {
    if (base && (p.u > max_u || p.v > max_v))
      kept.powers.push_back(p);
    else
      fit.powers.push_back(p);
  }
  kept.coefficients = Vector::Zero(static_cast<Eigen::Index>(kept.powers.size()));
  for (std::size_t k = 0; k < kept.powers.size(); ++k)
    for (std::size_t l = 0; l < base->powers.size(); ++l)
      if (base->powers[l].u == kept.powers[k].u && base->powers[l].v == kept.powers[k].v)
        kept.coefficients[static_cast<Eigen::Index>(k)] = base->coefficients[static_cast<Eigen::Index>(l)];

  const Eigen::Index rows = static_cast<Eigen::Index>(points.size());
  const Eigen::Index columns = static_cast<Eigen::Index>(fit.powers.size());
  if (rows < columns + 2) return false;
  Matrix a(rows, columns);
  Vector b(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const EnergyPoint& p = points[static_cast<std::size_t>(i)];
    b[i] = p.y - kept(p.u, p.v);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const Power power = fit.powers[static_cast<std::size_t>(k)];
      a(i, k) = raised(p.u, power.u) * raised(p.v, power.v);
    }
  }
  Eigen::ColPivHouseholderQR<Matrix> qr(a);
  qr.setThreshold(1e-7);
  if (qr.rank() < columns) return false;
  Vector all(columns + kept.coefficients.size());
  all << qr.solve(b), kept.coefficients;
  fit.coefficients = all;
  fit.powers.insert(fit.powers.end(), kept.powers.begin(), kept.powers.end());
  return true;
}

struct Minimum {
  double u = 0, v = 0;
  bool found = false;
};

Minimum minimum_of(const Polynomial& p) {
  Minimum m;
  for (int step = 0; step < 50; ++step) {
    const double gu = p.taylor(1, 0, m.u, m.v), gv = p.taylor(0, 1, m.u, m.v);
    const double a = 2 * p.taylor(2, 0, m.u, m.v), b = p.taylor(1, 1, m.u, m.v), c = 2 * p.taylor(0, 2, m.u, m.v);
    const double determinant = a * c - b * b;
    if (!(determinant > 0 && a > 0)) return m;
    const double du = (b * gv - c * gu) / determinant, dv = (b * gu - a * gv) / determinant;
    m.u += du;
    m.v += dv;
    if (std::abs(m.u) > 2 || std::abs(m.v) > 2) return m;
    if (std::abs(du) + std::abs(dv) < 1e-14) break;
  }
  m.found = true;
  return m;
}

struct Interval {
  double low = 1e300, high = -1e300;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  double half() const { return high > low ? 0.5 * (high - low) : 0; }
  // Of values from a window and from two thirds of it: what a window of no width would be away from the first, if
  // errors fall with the square of the window, 1/(1 - 4/9) times their difference.
  double to_no_window() const { return 1.8 * 2 * half(); }
};

// Square root of the sum of squares: error of the fit, and half of the spread over windows.
double both(double fit, double spread) { return std::hypot(std::isfinite(fit) ? fit : 0, spread); }

struct StretchTwistWindow {
  double strain = 0, twist = 0;  // largest, the scales of u and v
  double energy = 0;             // eV/nm, the scale of y
};

constexpr int max_degree = 4;

struct Harmonic {
  double EA, GJ, coupling, twist, strain;
  bool found = false;
};

Harmonic harmonic_of(const std::vector<EnergyPoint>& points, int degree, const StretchTwistWindow& w,
                     const Polynomial& base) {
  Harmonic h{};
  Polynomial p;
  if (!fit_polynomial(points, degree, p, &base)) return h;
  const Minimum m = minimum_of(p);
  if (!m.found) return h;
  h.EA = 2 * p.taylor(2, 0, m.u, m.v) * w.energy / (w.strain * w.strain);
  h.coupling = p.taylor(1, 1, m.u, m.v) * w.energy / (w.strain * w.twist);
  h.GJ = 2 * p.taylor(0, 2, m.u, m.v) * w.energy / (w.twist * w.twist);
  h.strain = m.u * w.strain;
  h.twist = m.v * w.twist;
  h.found = true;
  return h;
}

void fit_radius(const std::vector<AtomisticRow*>& rows, double strain0, double twist0, Stiffness& out) {
  std::vector<const AtomisticRow*> known;
  for (const AtomisticRow* row : rows)
    if (row->radius > 0) known.push_back(row);
  const Eigen::Index n = static_cast<Eigen::Index>(known.size());
  constexpr Eigen::Index terms = 6;
  if (n < terms + 2) return;
  // ln r to second order in strain and twist, about the relaxed tube.
  double strain_scale = 0, twist_scale = 0;
  for (const AtomisticRow* row : known) {
    strain_scale = std::max(strain_scale, std::abs(row->strain - strain0));
    twist_scale = std::max(twist_scale, std::abs(row->twist - twist0));
  }
  Matrix a(n, terms);
  Vector b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const AtomisticRow& row = *known[static_cast<std::size_t>(i)];
    const double u = (row.strain - strain0) / strain_scale, v = (row.twist - twist0) / twist_scale;
    a.row(i) << 1, u, v, u * u, u * v, v * v;
    b[i] = std::log(row.radius);
  }
  Eigen::ColPivHouseholderQR<Matrix> qr(a);
  qr.setThreshold(1e-7);
  if (qr.rank() < terms) return;
  const Vector x = qr.solve(b);
  const double variance = (a * x - b).squaredNorm() / static_cast<double>(n - terms);
  const Matrix covariance = variance * (a.transpose() * a).inverse();
  out.radius = {std::exp(x[0]), std::exp(x[0]) * std::sqrt(covariance(0, 0))};
  // d ln r / d ln L is taken at the relaxed tube, where L = L0.
  out.poisson = {-x[1] / strain_scale, std::sqrt(covariance(1, 1)) / strain_scale};
}

void warn_of_spread(const char* what, const Interval& range, Stiffness& out) {
  const double middle = 0.5 * (range.low + range.high);
  if (range.to_no_window() > 0.005 * std::abs(middle))
    out.warnings.push_back(fmt::format(
        "{} depends on the fit window: {:.5g} to {:.5g} ({:.1f} % apart); the spread is in its standard error",
        what, range.low, range.high, 100 * 2 * range.half() / std::abs(middle)));
}

}  // namespace

void fit_stretch_twist(std::vector<AtomisticRow>& table, Stiffness& out) {
  std::vector<AtomisticRow*> rows;
  for (AtomisticRow& row : table)
    if (row.kind == "stretch-twist") rows.push_back(&row);

  StretchTwistWindow w;
  for (const AtomisticRow* row : rows) {
    w.strain = std::max(w.strain, std::abs(row->strain));
    w.twist = std::max(w.twist, std::abs(row->twist));
    w.energy = std::max(w.energy, std::abs(row->energy / row->length));
  }
  const auto not_enough = [&] {
    return InputError({"", 0, "stretch-twist"},
                      fmt::format("{} rows do not determine EA, GJ and the natural twist", rows.size()),
                      "give at least three strains at each of three twists, both signs");
  };
  if (!(w.strain > 0 && w.twist > 0 && w.energy > 0)) throw not_enough();

  // The points within `part` of the window in strain and twist, with a margin so that points on its edge are
  // included.
  const auto points_within = [&](double part) {
    std::vector<EnergyPoint> points;
    for (const AtomisticRow* row : rows) {
      const EnergyPoint p{row->strain / w.strain, row->twist / w.twist, row->energy / row->length / w.energy};
      if (std::abs(p.u) <= part + 0.02 && std::abs(p.v) <= part + 0.02) points.push_back(p);
    }
    return points;
  };
  const std::vector<EnergyPoint> all = points_within(1);
  Polynomial polynomial;
  int degree = max_degree;
  while (degree >= 2 && !fit_polynomial(all, degree, polynomial)) --degree;
  if (degree < 2) throw not_enough();
  const Minimum minimum = minimum_of(polynomial);
  if (!minimum.found)
    throw InputError({"", 0, "stretch-twist"}, "the energies have no minimum near zero strain and twist",
                     "widen the window, or check the potential");

  // Parameters: energy, strain and twist of the minimum, then the Taylor coefficients from second order on.
  std::vector<FitParameter> parameters;
  std::vector<Power> powers;
  const double spread = std::max(1e-3, polynomial.coefficients.cwiseAbs().maxCoeff());
  const auto add = [&](const std::string& name, double start, double half_box) {
    parameters.push_back({name, start, start - half_box, start + half_box, true});
  };
  add("energy", polynomial(minimum.u, minimum.v), 0.5 * spread);
  add("strain", minimum.u, 1);
  add("twist", minimum.v, 1);
  for (const Power& p : polynomial.powers) {
    if (p.u + p.v < 2) continue;
    powers.push_back(p);
    add(fmt::format("c{}{}", p.u, p.v), polynomial.taylor(p.u, p.v, minimum.u, minimum.v), 2 * spread);
  }
  const Residuals residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      double y = p[0];
      for (std::size_t k = 0; k < powers.size(); ++k)
        y += p[3 + k] * raised(all[i].u - p[1], powers[k].u) * raised(all[i].v - p[2], powers[k].v);
      r[i] = y - all[i].y;
    }
  };
  FitOptions options;
  options.starts = 2;
  options.max_seconds = 5;
  const FitResult fit = fit_least_squares(parameters, all.size(), residuals, options);
  if (fit.verdict == FitResult::Verdict::nothing_finite) throw not_enough();

  std::vector<double> left(all.size());
  residuals(fit.value, left);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]->residual = -left[i] * w.energy * rows[i]->length;

  // The same constants from the inner part of the window.
  Interval EA, GJ, coupling, twist, strain;
  std::string windows;
  const auto fit_window = [&](double part, int order) {
    const Harmonic h = harmonic_of(points_within(part), order, w, polynomial);
    if (!h.found) return;
    EA.add(h.EA);
    GJ.add(h.GJ);
    coupling.add(h.coupling);
    twist.add(h.twist);
    strain.add(h.strain);
    windows += fmt::format(
        "  window {:.0f} %, order {}: EA {:.6g} eV/nm, GJ {:.6g} eV nm, C {:.4g} eV, natural twist "
        "{:.5g} rad/nm\n",
        100 * part, order, h.EA, h.GJ, h.coupling, h.twist);
  };
  // An order less in the same window would be off by the terms that the fit has: no measure of its error.
  fit_window(1, degree);
  fit_window(2.0 / 3.0, degree);

  // Tension and compression apart, each extrapolated to zero strain: a potential with a knot there has two EA.
  Interval sides;
  for (const double side : {1.0, -1.0}) {
    std::vector<EnergyPoint> half;
    for (const EnergyPoint& p : all)
      if (side * (p.u - minimum.u) >= -0.02) half.push_back(p);
    const Harmonic h = harmonic_of(half, std::min(degree, 3), w, polynomial);
    if (!h.found) continue;
    sides.add(h.EA);
    windows += fmt::format("  {} alone: EA {:.6g} eV/nm\n", side > 0 ? "tension" : "compression", h.EA);
  }

  const auto term = [&](int i, int j) {
    for (std::size_t k = 0; k < powers.size(); ++k)
      if (powers[k].u == i && powers[k].v == j) {
        const double unit = w.energy / (raised(w.strain, i) * raised(w.twist, j));
        return Measured{fit.value[3 + k] * unit, fit.standard_error[3 + k] * unit};
      }
    return Measured{};
  };
  const Measured c20 = term(2, 0), c11 = term(1, 1), c02 = term(0, 2);
  // Any value between the two is equally likely: the standard deviation of a uniform distribution.
  out.EA = {2 * c20.value, both(both(2 * c20.standard_error, EA.to_no_window()), sides.half() / std::sqrt(3.0))};
  out.GJ = {2 * c02.value, both(2 * c02.standard_error, GJ.to_no_window())};
  out.coupling = {c11.value, both(c11.standard_error, coupling.to_no_window())};
  out.natural_twist = {fit.value[2] * w.twist, both(fit.standard_error[2] * w.twist, twist.to_no_window())};
  // The spread over windows is added to the errors as a part of its own: it weakens the correlations.
  const auto place = [&](int i, int j) {
    for (std::size_t k = 0; k < powers.size(); ++k)
      if (powers[k].u == i && powers[k].v == j) return 3 + k;
    return std::size_t{0};
  };
  const std::size_t of[] = {place(2, 0), place(0, 2), place(1, 1), 2};
  const double fitted[] = {2 * c20.standard_error, 2 * c02.standard_error, c11.standard_error,
                           fit.standard_error[2] * w.twist};
  const double whole[] = {out.EA.standard_error, out.GJ.standard_error, out.coupling.standard_error,
                          out.natural_twist.standard_error};
  out.correlation.assign(4, std::vector<double>(4, 0));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const double share = std::isfinite(fitted[i] * fitted[j]) && whole[i] * whole[j] > 0
                               ? fitted[i] * fitted[j] / (whole[i] * whole[j])
                               : 0;
      out.correlation[i][j] = i == j ? 1 : share * fit.correlation[of[i]][of[j]];
    }
  out.stretch_cubic = term(3, 0);
  out.twist_cubic = term(0, 3);
  out.twist_quartic = term(0, 4);

  const double strain0 = fit.value[1] * w.strain;
  out.energy_offset = fit.value[0] * w.energy;
  double atoms_per_length = 0;
  for (const AtomisticRow* row : rows) atoms_per_length += row->atoms / row->length;
  atoms_per_length /= static_cast<double>(rows.size()) * (1 + strain0);
  out.atoms_per_length = {atoms_per_length,
                          atoms_per_length * both(fit.standard_error[1] * w.strain, strain.half())};
  fit_radius(rows, strain0, out.natural_twist.value, out);

  out.fit_report += fmt::format(
      "stretch and twist: {} cells, |strain| <= {:.3g}, |twist| <= {:.4g} rad/nm (shear {:.3g}), order {}; rms "
      "residual {:.2g} and largest {:.2g} of the largest energy; {} evaluations; {}\n{}",
      rows.size(), w.strain, w.twist, w.twist * out.radius.value, degree, fit.rms, fit.largest, fit.evaluations,
      fit.message, windows);
  if (!fit.usable()) out.warnings.push_back("the fit of stretch and twist: " + fit.message);
  warn_of_spread("EA", EA, out);
  if (sides.half() > 0.005 * out.EA.value)
    out.warnings.push_back(fmt::format(
        "EA is {:.5g} eV/nm on one side of zero strain and {:.5g} on the other: the potential has a knot "
        "there, and the value given lies between; the spread is in its standard error",
        sides.low, sides.high));
  warn_of_spread("GJ", GJ, out);
}

void fit_bend(std::vector<AtomisticRow>& table, Stiffness& out) {
  struct BendPair {
    double k, y;  // y = 2 (E_long - E_short)/(L_long - L_short)/k^2, which is EI + 2 k4 k^2
    AtomisticRow* row;
    double unit;  // energy of the longer tube per y
  };
  std::vector<AtomisticRow*> short_rows, middle_rows, long_rows;
  for (AtomisticRow& row : table) {
    if (row.kind == "bend-short") short_rows.push_back(&row);
    if (row.kind == "bend-middle") middle_rows.push_back(&row);
    if (row.kind == "bend-long") long_rows.push_back(&row);
  }
  const auto straight = [](const std::vector<AtomisticRow*>& rows) {
    for (const AtomisticRow* row : rows)
      if (row->curvature == 0) return row->energy;
    return 0.0;
  };
  const double short_zero = straight(short_rows), long_zero = straight(long_rows);
  const auto pairs_of = [](const std::vector<AtomisticRow*>& longer, double longer_zero,
                           const std::vector<AtomisticRow*>& shorter, double shorter_zero) {
    std::vector<BendPair> found;
    for (AtomisticRow* l : longer)
      for (const AtomisticRow* s : shorter) {
        const double k = l->curvature, length = l->length - s->length;
        if (k == 0 || std::abs(k - s->curvature) > 1e-9 * std::abs(k) || length == 0) continue;
        const double unit = 0.5 * length * k * k;
        found.push_back({std::abs(k), ((l->energy - longer_zero) - (s->energy - shorter_zero)) / unit, l, unit});
      }
    std::sort(found.begin(), found.end(), [](const BendPair& a, const BendPair& b) { return a.k < b.k; });
    return found;
  };
  const std::vector<BendPair> pairs = pairs_of(long_rows, long_zero, short_rows, short_zero);
  const auto not_enough = [&] {
    return InputError({"", 0, "bend"}, fmt::format("{} pairs of bent tubes do not determine EI", pairs.size()),
                      "give bend-short and bend-long rows at three or more equal curvatures");
  };
  if (pairs.size() < 3) throw not_enough();
  const double largest = pairs.back().k;

  // A straight line in (k / largest)^2 over pairs first .. last, for the start values and the smaller windows.
  const auto line_of = [largest](const std::vector<BendPair>& points, std::size_t first, std::size_t last) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = first; i <= last; ++i) {
      const double q = raised(points[i].k / largest, 2);
      n += 1;
      x += q;
      y += points[i].y;
      xx += q * q;
      xy += q * points[i].y;
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    return std::pair<double, double>{(y - slope * x) / n, slope};
  };
  const auto line = [&](std::size_t first, std::size_t last) { return line_of(pairs, first, last); };
  const std::size_t last = pairs.size() - 1;
  const auto start = line(0, last);
  if (!(start.first > 0)) throw not_enough();

  const double scale = start.first;
  const std::vector<FitParameter> parameters{
      {"EI", 1, 0.5, 1.5, true},
      {"k4", start.second / scale, start.second / scale - 0.5, start.second / scale + 0.5, true}};
  const Residuals residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      r[i] = p[0] + p[1] * raised(pairs[i].k / largest, 2) - pairs[i].y / scale;
  };
  FitOptions options;
  options.starts = 2;
  options.max_seconds = 2;
  const FitResult fit = fit_least_squares(parameters, pairs.size(), residuals, options);
  if (fit.verdict == FitResult::Verdict::nothing_finite) throw not_enough();
  std::vector<double> left(pairs.size());
  residuals(fit.value, left);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].row->residual = -left[i] * scale * pairs[i].unit;

  Interval EI;
  std::string windows;
  const auto fit_range = [&](std::size_t first, std::size_t to) {
    const double value = line(first, to).first;
    EI.add(value);
    windows +=
        fmt::format("  curvature {:.4g} to {:.4g} /nm: EI {:.6g} eV nm\n", pairs[first].k, pairs[to].k, value);
  };
  fit_range(0, last);
  if (pairs.size() > 3) {
    fit_range(0, last - 1);
    fit_range(1, last);
  }
  // The lower and the upper half of the additional length apart: what the ends of the specimens still do.
  Interval halves;
  const double middle_zero = straight(middle_rows);
  for (const auto& half : {pairs_of(middle_rows, middle_zero, short_rows, short_zero),
                           pairs_of(long_rows, long_zero, middle_rows, middle_zero)}) {
    if (half.size() < 3) continue;
    const double value = line_of(half, 0, half.size() - 1).first;
    halves.add(value);
    windows += fmt::format("  {} half of the additional length: EI {:.6g} eV nm\n",
                           half.front().row->kind == "bend-middle" ? "lower" : "upper", value);
  }
  const double k4_unit = 0.5 * scale / (largest * largest);
  out.EI = {fit.value[0] * scale, both(both(fit.standard_error[0] * scale, EI.half()), halves.half())};
  out.bend_quartic = {fit.value[1] * k4_unit, fit.standard_error[1] * k4_unit};
  out.fit_report += fmt::format(
      "bend: {} pairs of tubes of {:.4g} and {:.4g} nm, curvature <= {:.4g} /nm; rms residual {:.2g} and largest "
      "{:.2g} of EI; {} evaluations; {}\n{}",
      pairs.size(), short_rows.front()->length, long_rows.front()->length, largest, fit.rms, fit.largest,
      fit.evaluations, fit.message, windows);
  if (!fit.usable()) out.warnings.push_back("the fit of bending: " + fit.message);
  warn_of_spread("EI", EI, out);
}

}  // namespace ropewalk::calibrate
