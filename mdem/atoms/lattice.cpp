#include "atoms/lattice.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace ropewalk {
namespace {

using units::pi;

void check(Chirality c) {
  if (c.n < 0 || c.m < 0 || c.n + c.m == 0 || c.n > 10000 || c.m > 10000)
    throw std::invalid_argument("a chirality needs 0 <= n, m <= 10000, not both zero");
}

long floor_div(long a, long b) { return a / b - ((a % b != 0) && ((a < 0) != (b < 0)) ? 1 : 0); }
long ceil_div(long a, long b) { return -floor_div(-a, b); }

long height(Chirality c, long p, long q) { return c.n * q - c.m * p; }
long arc(Chirality c, long p, long q) { return p * (2L * c.n + c.m) + q * (2L * c.m + c.n); }
long full_arc(Chirality c) { return arc(c, c.n, c.m); }  // 2 (n^2 + n m + m^2)

// x, y with n x + m y = gcd(n, m).
void bezout(long n, long m, long& x, long& y) {
  long x0 = 1, y0 = 0, x1 = 0, y1 = 1;
  while (m != 0) {
    const long quotient = n / m;
    std::swap(n -= quotient * m, m);
    std::swap(x0 -= quotient * x1, x1);
    std::swap(y0 -= quotient * y1, y1);
  }
  x = x0;
  y = y0;
}

}  // namespace

LatticeVector translation_vector(Chirality c) {
  check(c);
  const int d = std::gcd(2 * c.n + c.m, 2 * c.m + c.n);
  return {-(2 * c.m + c.n) / d, (2 * c.n + c.m) / d};
}

long cell_hexagons(Chirality c, LatticeVector period) { return std::abs(height(c, period.p, period.q)); }

double period_turns(Chirality c, LatticeVector period) {
  const long whole = full_arc(c);
  long part = arc(c, period.p, period.q);
  part -= whole * ceil_div(2 * part - whole, 2 * whole);
  return static_cast<double>(part) / static_cast<double>(whole);
}

LatticeVector vector_of_height(Chirality c, long hexagons) {
  check(c);
  const long g = std::gcd(c.n, c.m);
  if (hexagons % g != 0) throw std::invalid_argument("the height of a lattice vector is a multiple of gcd(n,m)");
  long x = 0, y = 0;
  bezout(c.n, c.m, x, y);
  long p = -y * (hexagons / g), q = x * (hexagons / g);
  const long turns = floor_div(arc(c, p, q), full_arc(c));  // keeps the numbers small
  p -= turns * c.n;
  q -= turns * c.m;
  return {static_cast<int>(p), static_cast<int>(q)};
}

SiteRows::SiteRows(Chirality c) : c_(c) {
  check(c);
  g_ = std::gcd(c.n, c.m);
  bezout(c.n, c.m, x_, y_);
}

void SiteRows::between(long from, long to, const std::function<void(const SiteRow&)>& visit) const {
  for (const bool second : {false, true}) {
    // Heights in thirds, where the second atom is a whole number: 3 (n j - m i) + (n - m).
    const long offset = second ? c_.n - c_.m : 0;
    for (long k = ceil_div(from - offset, 3 * g_); k < ceil_div(to - offset, 3 * g_); ++k) {
      long i = -y_ * k, j = x_ * k;
      const long turns = floor_div(arc(c_, i, j), full_arc(c_));  // bring it next to the seam
      i -= turns * c_.n;
      j -= turns * c_.m;
      visit({{static_cast<int>(i), static_cast<int>(j), second}, 3 * g_ * k + offset, static_cast<int>(g_)});
    }
  }
}

long SiteRows::sites_between(long from, long to) const {
  long rows = 0;
  for (const long offset : {0L, static_cast<long>(c_.n - c_.m)})
    rows += ceil_div(to - offset, 3 * g_) - ceil_div(from - offset, 3 * g_);
  return rows * g_;
}

std::vector<Site> strip_sites(Chirality c, long hexagons) {
  check(c);
  const long g = std::gcd(c.n, c.m);
  if (hexagons <= 0 || hexagons % g != 0)
    throw std::invalid_argument("the hexagons of a strip must be a positive multiple of gcd(n,m)");
  std::vector<Site> sites;
  sites.reserve(static_cast<std::size_t>(2 * hexagons));
  SiteRows(c).between(0, 3 * hexagons, [&](const SiteRow& row) {
    for (int k = 0; k < row.sites; ++k) {
      Site site = row.first;
      site.i += k * static_cast<int>(c.n / g);
      site.j += k * static_cast<int>(c.m / g);
      const long turns = floor_div(arc(c, site.i, site.j), full_arc(c));
      site.i -= static_cast<int>(turns) * c.n;
      site.j -= static_cast<int>(turns) * c.m;
      sites.push_back(site);
    }
  });
  return sites;
}

TubeShape rolled_shape(Chirality c, double a) {
  check(c);
  TubeShape shape;
  shape.radius = tube_radius(c, a);
  shape.length_per_hexagon = 0.5 * std::sqrt(3.0) * a * a / circumference(c, a);
  return shape;
}

long height_in_thirds(Chirality c, const Site& site) {
  return 3 * height(c, site.i, site.j) + (site.second ? c.n - c.m : 0);
}

Polar polar(Chirality c, const Site& site, const TubeShape& shape) {
  const long third = site.second ? 1 : 0;
  const double arc_thirds = static_cast<double>(3 * arc(c, site.i, site.j) + third * 3 * (c.n + c.m));
  const double z0 = static_cast<double>(height_in_thirds(c, site)) / 3.0 * shape.length_per_hexagon;
  Polar at{2.0 * pi * arc_thirds / (3.0 * static_cast<double>(full_arc(c))) + shape.twist * z0, z0};
  if (site.second) {
    at.phi += shape.arc_shift;
    at.z += shape.height_shift;
  }
  return at;
}

double radius_of(const Site& site, const TubeShape& shape) {
  return shape.radius + (site.second ? 0.5 : -0.5) * shape.lift;
}

Vector3 place(Chirality c, const Site& site, const TubeShape& shape) {
  const Polar at = polar(c, site, shape);
  const double r = radius_of(site, shape);
  return {r * std::cos(at.phi), r * std::sin(at.phi), at.z};
}

std::vector<Vector3> tube_atoms(Chirality c, const TubeShape& shape, long hexagons, double turn, double bottom) {
  const Eigen::AngleAxisd rotation(turn, Vector3::UnitZ());
  std::vector<Vector3> atoms;
  for (const Site& site : strip_sites(c, hexagons))
    atoms.push_back(rotation * place(c, site, shape) + Vector3(0, 0, bottom));
  return atoms;
}

TubeCell tube_cell(Chirality c, LatticeVector period, double a) {
  check(c);
  const long hexagons = cell_hexagons(c, period);
  if (hexagons == 0) throw std::invalid_argument("the period of a tube must not be parallel to its circumference");
  if (height(c, period.p, period.q) < 0) period = {-period.p, -period.q};

  TubeShape shape = rolled_shape(c, a);
  TubeCell cell;
  cell.radius = shape.radius;
  cell.length = static_cast<double>(hexagons) * shape.length_per_hexagon;
  cell.twist = shape.twist = -2.0 * pi * period_turns(c, period) / cell.length;
  cell.atoms = tube_atoms(c, shape, hexagons);
  return cell;
}

TwistedCell twisted_cell_near(Chirality c, const TubeShape& shape, const std::vector<LatticeVector>& periods,
                              double twist) {
  const auto cell_of = [&](const LatticeVector& period) {
    TwistedCell cell{period, cell_hexagons(c, period)};
    cell.length = static_cast<double>(cell.hexagons) * shape.length_per_hexagon;
    cell.twist = -2 * pi * period_turns(c, period) / cell.length;
    return cell;
  };
  const auto cost = [&](const TwistedCell& cell) {
    const double off = std::abs(cell.twist / twist - 1);
    return off < 0.02 ? cell.length : 1e6 * off;
  };
  TwistedCell best = cell_of(periods.front());
  for (const LatticeVector& period : periods)
    if (const TwistedCell cell = cell_of(period); cost(cell) < cost(best)) best = cell;
  return best;
}

std::vector<LatticeVector> twisted_periods(Chirality c, double min_length, double max_length, double max_shear,
                                           double a) {
  check(c);
  const TubeShape shape = rolled_shape(c, a);
  const long g = std::gcd(c.n, c.m);
  long x = 0, y = 0;
  bezout(c.n, c.m, x, y);

  struct Candidate {
    LatticeVector period;
    long hexagons, arc;  // twist goes as -arc / hexagons
  };
  std::vector<Candidate> candidates;
  const long whole = full_arc(c);
  const long first = static_cast<long>(std::ceil(min_length / (shape.length_per_hexagon * static_cast<double>(g))));
  const long last = static_cast<long>(std::floor(max_length / (shape.length_per_hexagon * static_cast<double>(g))));
  for (long k = std::max(1L, first); k <= last; ++k) {
    // One vector of this height, then its g copies around the tube; the arc is brought next to zero.
    for (long turn = 0; turn < g; ++turn) {
      long p = -y * k + turn * (c.n / g), q = x * k + turn * (c.m / g);
      const long turns = ceil_div(2 * arc(c, p, q) - whole, 2 * whole);
      p -= turns * c.n;
      q -= turns * c.m;
      const double length = static_cast<double>(k * g) * shape.length_per_hexagon;
      const double shear =
          2.0 * pi * shape.radius * static_cast<double>(arc(c, p, q)) / (static_cast<double>(whole) * length);
      if (std::abs(shear) <= max_shear)
        candidates.push_back({{static_cast<int>(p), static_cast<int>(q)}, k * g, arc(c, p, q)});
    }
  }
  // Equal twists are equal fractions arc / hexagons: compared by integers.
  const auto order = [](const Candidate& s, const Candidate& t) {
    const long left = -s.arc * t.hexagons, right = -t.arc * s.hexagons;
    return left != right ? left < right : s.hexagons < t.hexagons;
  };
  std::sort(candidates.begin(), candidates.end(), order);
  std::vector<LatticeVector> periods;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool repeated =
        i > 0 && candidates[i].arc * candidates[i - 1].hexagons == candidates[i - 1].arc * candidates[i].hexagons;
    if (!repeated) periods.push_back(candidates[i].period);
  }
  return periods;
}

}  // namespace ropewalk
