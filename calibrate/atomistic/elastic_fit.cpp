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
  // How far the value of a window of no width lies from the first, by a window and two thirds of it, if
  // errors fall with the square of the window, 1/(1 - 4/9) times their difference.
  double to_no_window() const { return 1.8 * 2 * half(); }
  bool wide() const { return to_no_window() > 0.005 * std::abs(0.5 * (low + high)); }
};

// Square root of the sum of squares: error of the fit, and half of the spread over windows.
double both(double fit, double spread) { return std::hypot(std::isfinite(fit) ? fit : 0, spread); }

// A fit that ends at the edge of its box, or that the energies do not determine, has no errors to be known by.
void refuse_undetermined(const FitResult& fit, const char* table) {
  if (fit.at_bound.empty() && fit.undetermined.empty()) return;
  throw InputError({"", 0, table}, fmt::format("the energies do not determine the stiffnesses: {}", fit.message),
                   "check the potential, or give more cells in a wider window");
}

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
  if (range.wide())
    out.warnings.push_back(fmt::format(
        "{} depends on the fit window: {:.5g} to {:.5g} ({:.1f} % apart); the spread is in its standard error",
        what, range.low, range.high, 100 * 2 * range.half() / std::abs(middle)));
}

// --- Stretch and twist ---

// The points within `part` of the window in strain and twist, with a margin so that points on its edge are
// included.
std::vector<EnergyPoint> points_within(const std::vector<AtomisticRow*>& rows, const StretchTwistWindow& w,
                                       double part) {
  std::vector<EnergyPoint> points;
  for (const AtomisticRow* row : rows) {
    const EnergyPoint p{row->strain / w.strain, row->twist / w.twist, row->energy / row->length / w.energy};
    if (std::abs(p.u) <= part + 0.02 && std::abs(p.v) <= part + 0.02) points.push_back(p);
  }
  return points;
}

// The bounded fit in energy, strain and twist of the minimum, and the Taylor coefficients from second order on.
struct TaylorFit {
  std::vector<Power> powers;  // power k belongs to parameter 3 + k
  FitResult fit;
  StretchTwistWindow window;

  // The parameter of u^i v^j; 0 where there is none.
  std::size_t place(int i, int j) const {
    for (std::size_t k = 0; k < powers.size(); ++k)
      if (powers[k].u == i && powers[k].v == j) return 3 + k;
    return 0;
  }
  // Energy terms in eV and nm; `times` is a factor.
  Measured term(int i, int j, double times = 1) const {
    const std::size_t at = place(i, j);
    if (at == 0) return {};
    const double unit = times * window.energy / (raised(window.strain, i) * raised(window.twist, j));
    return {fit.value[at] * unit, fit.standard_error[at] * unit};
  }
};

TaylorFit fit_taylor(const std::vector<EnergyPoint>& all, const Polynomial& polynomial, const Minimum& minimum,
                     const StretchTwistWindow& window, std::vector<double>& left) {
  TaylorFit out;
  out.window = window;
  std::vector<FitParameter> parameters;
  const double spread = std::max(1e-3, polynomial.coefficients.cwiseAbs().maxCoeff());
  const auto add = [&](const std::string& name, double start, double half_box) {
    parameters.push_back({name, start, start - half_box, start + half_box, true});
  };
  add("energy", polynomial(minimum.u, minimum.v), 0.5 * spread);
  add("strain", minimum.u, 1);
  add("twist", minimum.v, 1);
  for (const Power& p : polynomial.powers) {
    if (p.u + p.v < 2) continue;
    out.powers.push_back(p);
    add(fmt::format("c{}{}", p.u, p.v), polynomial.taylor(p.u, p.v, minimum.u, minimum.v), 2 * spread);
  }
  const Residuals residuals = [&](const std::vector<double>& p, std::vector<double>& r) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      double y = p[0];
      for (std::size_t k = 0; k < out.powers.size(); ++k)
        y += p[3 + k] * raised(all[i].u - p[1], out.powers[k].u) * raised(all[i].v - p[2], out.powers[k].v);
      r[i] = y - all[i].y;
    }
  };
  FitOptions options;
  options.starts = 2;
  out.fit = fit_least_squares(parameters, all.size(), residuals, options);
  left.resize(all.size());
  residuals(out.fit.value, left);
  return out;
}

// The same constants from parts of the window, and from tension and compression alone.
struct Windows {
  Interval EA, GJ, coupling, twist, strain, sides, cusp;
  std::string text;
};

// GJ from the unstretched cells alone: energies of the twist t to t^2, with a term t^4 or with |t|^3. A potential
// with knots has the second, and its stiffness goes linearly with the window, which a polynomial does not see. 0:
// there are too few twists.
double twist_of_slice(const std::vector<EnergyPoint>& all, const Minimum& minimum, bool cusp,
                      const StretchTwistWindow& w) {
  std::vector<EnergyPoint> slice;
  for (const EnergyPoint& p : all)
    if (std::abs(p.u) < 0.02) slice.push_back(p);
  if (slice.size() < 5) return 0;
  Matrix a(static_cast<Eigen::Index>(slice.size()), 4);
  Vector b(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const EnergyPoint& p = slice[static_cast<std::size_t>(i)];
    const double t = p.v - minimum.v;
    a.row(i) << 1, t, t * t, cusp ? std::abs(t * t * t) : raised(t, 4);
    b[i] = p.y;
  }
  return 2 * a.colPivHouseholderQr().solve(b)[2] * w.energy / (w.twist * w.twist);
}

Windows over_windows(const std::vector<AtomisticRow*>& rows, const StretchTwistWindow& w, int degree,
                     const Polynomial& polynomial, const Minimum& minimum) {
  Windows out;
  // An order less in the same window would be off by the terms that the fit has: no measure of its error.
  for (const double part : {1.0, 2.0 / 3.0}) {
    const Harmonic h = harmonic_of(points_within(rows, w, part), degree, w, polynomial);
    if (!h.found) continue;
    out.EA.add(h.EA);
    out.GJ.add(h.GJ);
    out.coupling.add(h.coupling);
    out.twist.add(h.twist);
    out.strain.add(h.strain);
    out.text += fmt::format(
        "  window {:.0f} %, order {}: EA {:.6g} eV/nm, GJ {:.6g} eV nm, C {:.4g} eV, natural twist "
        "{:.5g} rad/nm\n",
        100 * part, degree, h.EA, h.GJ, h.coupling, h.twist);
  }
  if (out.EA.wide() || out.GJ.wide()) {
    for (const bool cusp : {false, true})
      if (const double GJ = twist_of_slice(points_within(rows, w, 1), minimum, cusp, w)) {
        out.cusp.add(GJ);
        out.text += fmt::format("  twist alone, with a term {}: GJ {:.6g} eV nm\n", cusp ? "|t|^3" : "t^4", GJ);
      }
  }
  // Each extrapolated to zero strain: a potential with a knot there has two EA.
  for (const double side : {1.0, -1.0}) {
    std::vector<EnergyPoint> half;
    for (const EnergyPoint& p : points_within(rows, w, 1))
      if (side * (p.u - minimum.u) >= -0.02) half.push_back(p);
    const Harmonic h = harmonic_of(half, std::min(degree, 3), w, polynomial);
    if (!h.found) continue;
    out.sides.add(h.EA);
    out.text += fmt::format("  {} alone: EA {:.6g} eV/nm\n", side > 0 ? "tension" : "compression", h.EA);
  }
  return out;
}

// Correlations of EA, GJ, coupling and natural twist. The spread over windows is a separate part of the errors: it
// weakens the correlations.
std::vector<std::vector<double>> correlation_of(const TaylorFit& taylor, const Stiffness& s) {
  const std::size_t of[] = {taylor.place(2, 0), taylor.place(0, 2), taylor.place(1, 1), 2};
  const double fitted[] = {taylor.term(2, 0, 2).standard_error, taylor.term(0, 2, 2).standard_error,
                           taylor.term(1, 1).standard_error, taylor.fit.standard_error[2] * taylor.window.twist};
  const double whole[] = {s.EA.standard_error, s.GJ.standard_error, s.coupling.standard_error,
                          s.natural_twist.standard_error};
  std::vector<std::vector<double>> out(4, std::vector<double>(4, 0));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const bool known = std::isfinite(fitted[i] * fitted[j]) && whole[i] * whole[j] > 0;
      const double share = known ? fitted[i] * fitted[j] / (whole[i] * whole[j]) : 0;
      out[i][j] = i == j ? 1 : share * taylor.fit.correlation[of[i]][of[j]];
    }
  return out;
}

// --- Bend ---

struct BendPair {
  double k, y;  // y = 2 (E_long - E_short)/(L_long - L_short)/k^2, which is EI + 2 k4 k^2
  AtomisticRow* row;
  double unit;  // energy of the longer tube per y
};

// Rows of two kinds with the same curvature, energies above the straight tubes; sorted by curvature.
std::vector<BendPair> bend_pairs(std::vector<AtomisticRow>& table, const char* longer, const char* shorter) {
  const auto straight = [&](const char* kind) {
    for (const AtomisticRow& row : table)
      if (row.kind == kind && row.curvature == 0) return row.energy;
    return 0.0;
  };
  const double longer_zero = straight(longer), shorter_zero = straight(shorter);
  std::vector<BendPair> found;
  for (AtomisticRow& l : table)
    for (const AtomisticRow& s : table) {
      const double k = l.curvature, length = l.length - s.length;
      if (l.kind != longer || s.kind != shorter || k == 0 || length == 0) continue;
      if (std::abs(k - s.curvature) > 1e-9 * std::abs(k)) continue;
      const double unit = 0.5 * length * k * k;
      found.push_back({std::abs(k), ((l.energy - longer_zero) - (s.energy - shorter_zero)) / unit, &l, unit});
    }
  std::sort(found.begin(), found.end(), [](const BendPair& a, const BendPair& b) { return a.k < b.k; });
  return found;
}

// A straight line in (k / largest)^2 over pairs first .. last: value at zero and slope.
std::pair<double, double> line_of(const std::vector<BendPair>& pairs, double largest, std::size_t first,
                                  std::size_t last) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const double q = raised(pairs[i].k / largest, 2);
    n += 1;
    x += q;
    y += pairs[i].y;
    xx += q * q;
    xy += q * pairs[i].y;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return {(y - slope * x) / n, slope};
}

}  // namespace

void fit_stretch_twist(std::vector<AtomisticRow>& table, Stiffness& out) {
  std::vector<AtomisticRow*> rows;
  StretchTwistWindow w;
  for (AtomisticRow& row : table) {
    if (row.kind != "stretch-twist") continue;
    rows.push_back(&row);
    w.strain = std::max(w.strain, std::abs(row.strain));
    w.twist = std::max(w.twist, std::abs(row.twist));
    w.energy = std::max(w.energy, std::abs(row.energy / row.length));
  }
  const auto not_enough = [&] {
    return InputError({"", 0, "stretch-twist"},
                      fmt::format("{} rows do not determine EA, GJ and the natural twist", rows.size()),
                      "give at least three strains at each of three twists, both signs");
  };
  if (!(w.strain > 0 && w.twist > 0 && w.energy > 0)) throw not_enough();
  const std::vector<EnergyPoint> all = points_within(rows, w, 1);
  Polynomial polynomial;
  int degree = max_degree;
  while (degree >= 2 && !fit_polynomial(all, degree, polynomial)) --degree;
  if (degree < 2) throw not_enough();
  const Minimum minimum = minimum_of(polynomial);
  if (!minimum.found)
    throw InputError({"", 0, "stretch-twist"}, "the energies have no minimum near zero strain and twist",
                     "widen the window, or check the potential");
  std::vector<double> left;
  const TaylorFit taylor = fit_taylor(all, polynomial, minimum, w, left);
  const FitResult& fit = taylor.fit;
  if (fit.verdict == FitResult::Verdict::nothing_finite) throw not_enough();
  refuse_undetermined(fit, "stretch-twist");
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]->residual = -left[i] * w.energy * rows[i]->length;

  const Windows windows = over_windows(rows, w, degree, polynomial, minimum);
  const auto with_spread = [](const Measured& m, const Interval& spread) {
    return Measured{m.value, both(m.standard_error, spread.to_no_window())};
  };
  out.EA = with_spread(taylor.term(2, 0, 2), windows.EA);
  // Any value between the two sides is equally likely: the standard deviation of a uniform distribution.
  out.EA.standard_error = both(out.EA.standard_error, windows.sides.half() / std::sqrt(3.0));
  out.GJ = with_spread(taylor.term(0, 2, 2), windows.GJ);
  out.GJ.standard_error = both(out.GJ.standard_error, 2 * windows.cusp.half());
  out.coupling = with_spread(taylor.term(1, 1), windows.coupling);
  out.natural_twist = with_spread({fit.value[2] * w.twist, fit.standard_error[2] * w.twist}, windows.twist);
  out.correlation = correlation_of(taylor, out);
  out.stretch_cubic = taylor.term(3, 0);
  out.twist_cubic = taylor.term(0, 3);
  out.twist_quartic = taylor.term(0, 4);

  const double strain0 = fit.value[1] * w.strain;
  out.energy_offset = fit.value[0] * w.energy;
  double atoms_per_length = 0;
  for (const AtomisticRow* row : rows) atoms_per_length += row->atoms / row->length;
  atoms_per_length /= static_cast<double>(rows.size()) * (1 + strain0);
  out.atoms_per_length = {atoms_per_length,
                          atoms_per_length * both(fit.standard_error[1] * w.strain, windows.strain.half())};
  fit_radius(rows, strain0, out.natural_twist.value, out);

  out.fit_report += fmt::format(
      "stretch and twist: {} cells, |strain| <= {:.3g}, |twist| <= {:.4g} rad/nm (shear {:.3g}), order {}; rms "
      "residual {:.2g} and largest {:.2g} of the largest energy; {} evaluations; {}\n{}",
      rows.size(), w.strain, w.twist, w.twist * out.radius.value, degree, fit.rms, fit.largest, fit.evaluations,
      fit.message, windows.text);
  if (!fit.usable()) out.warnings.push_back("the fit of stretch and twist: " + fit.message);
  warn_of_spread("EA", windows.EA, out);
  if (windows.sides.half() > 0.005 * out.EA.value)
    out.warnings.push_back(fmt::format(
        "EA is {:.5g} eV/nm on one side of zero strain and {:.5g} on the other: the potential has a knot "
        "there, and the value given lies between; the spread is in its standard error",
        windows.sides.low, windows.sides.high));
  warn_of_spread("GJ", windows.GJ, out);
}

void fit_bend(std::vector<AtomisticRow>& table, Stiffness& out) {
  const std::vector<BendPair> pairs = bend_pairs(table, "bend-long", "bend-short");
  const auto not_enough = [&] {
    return InputError({"", 0, "bend"}, fmt::format("{} pairs of bent tubes do not determine EI", pairs.size()),
                      "give bend-short and bend-long rows at three or more equal curvatures");
  };
  if (pairs.size() < 3) throw not_enough();
  const double largest = pairs.back().k;
  const std::size_t last = pairs.size() - 1;
  const auto [scale, start_slope] = line_of(pairs, largest, 0, last);
  if (!(scale > 0)) throw not_enough();

  const double slope = start_slope / scale;
  const Residuals residuals = [&pairs, largest, unit = scale](const std::vector<double>& p,
                                                              std::vector<double>& r) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      r[i] = p[0] + p[1] * raised(pairs[i].k / largest, 2) - pairs[i].y / unit;
  };
  FitOptions options;
  options.starts = 2;
  const FitResult fit = fit_least_squares(
      {{"EI", 1, 0.5, 1.5, true}, {"k4", slope, slope - 0.5, slope + 0.5, true}}, pairs.size(), residuals, options);
  if (fit.verdict == FitResult::Verdict::nothing_finite) throw not_enough();
  refuse_undetermined(fit, "bend");
  std::vector<double> left(pairs.size());
  residuals(fit.value, left);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].row->residual = -left[i] * scale * pairs[i].unit;

  Interval EI;
  std::string windows;
  std::vector<std::pair<std::size_t, std::size_t>> ranges = {{0, last}};
  if (pairs.size() > 3) ranges.insert(ranges.end(), {{0, last - 1}, {1, last}});
  for (const auto& [first, to] : ranges) {
    const double value = line_of(pairs, largest, first, to).first;
    EI.add(value);
    windows +=
        fmt::format("  curvature {:.4g} to {:.4g} /nm: EI {:.6g} eV nm\n", pairs[first].k, pairs[to].k, value);
  }
  // The lower and the upper half of the additional length apart: what the ends of the specimens still do.
  Interval halves;
  for (const auto& half :
       {bend_pairs(table, "bend-middle", "bend-short"), bend_pairs(table, "bend-long", "bend-middle")}) {
    if (half.size() < 3) continue;
    const double value = line_of(half, largest, 0, half.size() - 1).first;
    halves.add(value);
    windows += fmt::format("  {} half of the additional length: EI {:.6g} eV nm\n",
                           half.front().row->kind == "bend-middle" ? "lower" : "upper", value);
  }
  const double k4_unit = 0.5 * scale / (largest * largest);
  out.EI = {fit.value[0] * scale, both(both(fit.standard_error[0] * scale, EI.half()), halves.half())};
  out.bend_quartic = {fit.value[1] * k4_unit, fit.standard_error[1] * k4_unit};
  const auto length_of = [&](const char* kind) {
    return std::find_if(table.begin(), table.end(), [&](const AtomisticRow& r) { return r.kind == kind; })->length;
  };
  out.fit_report += fmt::format(
      "bend: {} pairs of tubes of {:.4g} and {:.4g} nm, curvature <= {:.4g} /nm; rms residual {:.2g} and largest "
      "{:.2g} of EI; {} evaluations; {}\n{}",
      pairs.size(), length_of("bend-short"), length_of("bend-long"), largest, fit.rms, fit.largest, fit.evaluations,
      fit.message, windows);
  if (!fit.usable()) out.warnings.push_back("the fit of bending: " + fit.message);
  warn_of_spread("EI", EI, out);
}

}  // namespace ropewalk::calibrate
