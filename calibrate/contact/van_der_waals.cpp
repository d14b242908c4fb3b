#include "contact/van_der_waals.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "contact/integral.hpp"
#include "contact/quadrature.hpp"
#include "model/units.hpp"

namespace ropewalk::calibrate {
namespace {

using units::pi;

// int over |theta| <= acos(c) of cos^m theta, for even m from 0 to 12.
struct CosinePowers {
  double of[7];  // of[k]: m = 2 k

  explicit CosinePowers(double c) {
    const double s = std::sqrt(std::max(0.0, (1 - c) * (1 + c)));
    of[0] = 2 * std::acos(c);
    double power = c;  // c^(m-1)
    for (int k = 1; k <= 6; ++k, power *= c * c) {
      const double m = 2 * k;
      of[k] = 2 * power * s / m + (m - 1) / m * of[k - 1];
    }
  }
};

// One atom and a straight line of atoms, one per length, at distance d: the integral along the line, with the
// substitution z = d tan theta, cut off where d^2 + z^2 = cutoff^2.
struct AtomAndLine {
  const AtomLaw& law;

  double energy(double d) const {
    if (d >= law.cutoff) return 0;
    const CosinePowers c(d / law.cutoff);
    const double x2 = square(law.sigma / d), x6 = x2 * x2 * x2;
    return 4 * law.epsilon * d * x6 * (x6 * c.of[5] - c.of[2]);
  }

  double derivative(double d) const {
    if (d >= law.cutoff) return 0;
    const CosinePowers c(d / law.cutoff);
    const double x2 = square(law.sigma / d), x6 = x2 * x2 * x2;
    const double inside = -4 * law.epsilon * x6 * (12 * x6 * c.of[6] - 6 * c.of[3]);
    if (law.cutoff == infinite) return inside;
    // The integrand does not vanish at the ends of the line, which move with d.
    return inside - 2 * law.energy(std::nextafter(law.cutoff, 0.0)) * d / std::sqrt(square(law.cutoff) - d * d);
  }
};

// One atom at distance D > r from the axis of a shell: eV.
struct AtomAndShell {
  AtomAndLine line;
  const Shell& shell;

  double reach() const { return line.law.cutoff + shell.radius; }

  // f(distance to the line at angle phi of the shell, phi) over the shell.
  template <class F>
  double over_shell(double D, F f) const {
    const double r = shell.radius, near = D - r;
    if (D >= reach()) return 0;
    double last = pi;
    if (line.law.cutoff < D + r)
      last = 2 * std::asin(std::sqrt((square(line.law.cutoff) - near * near) / (4 * D * r)));
    return 2 * shell.density * r *
           integrate_to_end(
               [&](double phi) {
                 const double s2 = square(std::sin(0.5 * phi));
                 return f(std::sqrt(near * near + 4 * D * r * s2), s2);
               },
               0, last);
  }
  double energy(double D) const {
    return over_shell(D, [&](double d, double) { return line.energy(d); });
  }
  double derivative(double D) const {
    const double r = shell.radius;
    return over_shell(D, [&](double d, double s2) { return line.derivative(d) * (D - r + 2 * r * s2) / d; });
  }
};

void check(const AtomLaw& law, const Shell& i, const Shell& j) {
  if (!(law.epsilon > 0) || !(law.sigma > 0) || !(law.cutoff > 0))
    throw std::invalid_argument("van der Waals: epsilon, sigma and the cutoff must be positive");
  for (const Shell* s : {&i, &j})
    if (!(s->radius > 0) || !(s->density > 0) || !std::isfinite(s->radius * s->density))
      throw std::invalid_argument("van der Waals: a shell needs a positive radius and density");
}

void check(const AtomLaw& law, const Shell& i, const Shell& j, double distance) {
  check(law, i, j);
  if (!(distance > i.radius + j.radius))
    throw std::invalid_argument("van der Waals: at " + std::to_string(distance) +
                                " nm the shells touch or overlap: the distance of the axes must exceed " +
                                std::to_string(i.radius + j.radius) + " nm");
}

// Energies per length below this value are rounding errors. Without a cutoff the value falls with the distance as
// the energy does.
double negligible(const AtomLaw& law, const Shell& i, const Shell& j, double distance) {
  const double gap = distance - i.radius - j.radius;
  const double x = law.cutoff < infinite ? 1 : law.sigma / std::max(law.sigma, gap);
  return 1e-12 * i.density * j.density * law.epsilon * law.sigma * square(law.sigma) * std::pow(x, 6);
}

// Angle on circle i at which its points are D from the other axis; 0 and pi when all are nearer or farther.
double angle_at(double distance, double radius, double D) {
  const double s2 = (D * D - square(distance - radius)) / (4 * distance * radius);
  return 2 * std::asin(std::sqrt(std::clamp(s2, 0.0, 1.0)));
}

// Parts of (0, pi) on circle i between the angles where the potential of shell j has a kink or ends.
std::vector<double> kinks(const AtomLaw& law, const Shell& i, const Shell& j, double distance) {
  std::vector<double> edges = {0.0};
  if (law.cutoff < infinite && law.cutoff > j.radius)
    edges.push_back(angle_at(distance, i.radius, law.cutoff - j.radius));
  edges.push_back(law.cutoff < infinite ? angle_at(distance, i.radius, law.cutoff + j.radius) : pi);
  std::sort(edges.begin(), edges.end());
  return edges;
}

template <class F>
double over_circle(const AtomLaw& law, const Shell& i, const Shell& j, double distance, double absolute, F f) {
  Quadrature quadrature;
  const std::vector<double> edges = kinks(law, i, j, distance);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    if (edges[k + 1] - edges[k] < 1e-9) continue;
    sum += quadrature(
        [&](double phi) {
          const double s2 = square(std::sin(0.5 * phi));
          return f(std::sqrt(square(distance - i.radius) + 4 * distance * i.radius * s2), s2);
        },
        edges[k], edges[k + 1], absolute);
  }
  return 2 * i.density * i.radius * sum;
}

}  // namespace

double AtomLaw::energy(double distance) const {
  if (distance >= cutoff) return 0;
  const double x2 = square(sigma / distance), x6 = x2 * x2 * x2;
  return 4 * epsilon * x6 * (x6 - 1);
}

double graphene_density(double a) { return 4 / (std::sqrt(3.0) * a * a); }

double parallel_energy(const AtomLaw& law, const Shell& i, const Shell& j, double distance) {
  check(law, i, j, distance);
  const AtomAndShell potential{{law}, j};
  return over_circle(law, i, j, distance, negligible(law, i, j, distance),
                     [&](double D, double) { return potential.energy(D); });
}

double parallel_energy_derivative(const AtomLaw& law, const Shell& i, const Shell& j, double distance) {
  check(law, i, j, distance);
  const AtomAndShell potential{{law}, j};
  return over_circle(law, i, j, distance, negligible(law, i, j, distance) / law.sigma, [&](double D, double s2) {
    return potential.derivative(D) * (distance - i.radius + 2 * i.radius * s2) / D;
  });
}

// Axis j along x in the plane z = 0, axis i above it along (cos, sin) of the angle. A point of shell i at s along
// its axis and phi around it lies at distance D from axis j with
//   D^2 = (s sin(angle) + r_i sin phi cos(angle))^2 + (R - r_i cos phi)^2.
double crossed_energy(const AtomLaw& law, const Shell& i, const Shell& j, double distance, double angle) {
  check(law, i, j, distance);
  if (!(angle > 0 && angle <= 0.5 * pi * (1 + 1e-12)))
    throw std::invalid_argument("van der Waals: the crossing angle must lie above 0 and up to pi/2");
  const AtomAndShell potential{{law}, j};
  Quadrature inner, outer;
  const double absolute = negligible(law, i, j, distance) * law.sigma;
  const double sine = std::sin(angle), cosine = std::cos(angle), reach = potential.reach();
  const auto along = [&](double phi) {
    const double height = distance - i.radius * std::cos(phi), offset = i.radius * std::sin(phi) * cosine;
    if (height >= reach) return 0.0;
    const auto at = [&](double s) { return potential.energy(std::hypot(s * sine + offset, height)); };
    // Positions along the axis, relative to the nearest point of the two lines, at which D is that of a kink or the
    // end.
    const double middle = -offset / sine;
    std::vector<double> edges = {middle};
    for (const double D : {law.cutoff - j.radius, reach})
      if (D < infinite && D > height) edges.push_back(middle + std::sqrt(D * D - height * height) / sine);
    double sum = 0;
    for (const double side : {-1.0, 1.0}) {
      for (std::size_t k = 0; k + 1 < edges.size(); ++k)
        sum += inner([&](double s) { return at(middle + side * (s - middle)); }, edges[k], edges[k + 1], absolute);
      if (law.cutoff == infinite)  // s = middle + height tan(t) / sin(angle)
        sum += inner(
            [&](double t) {
              const double c = std::cos(t);
              return c > 1e-8 ? at(middle + side * height * std::tan(t) / sine) * height / (sine * c * c) : 0.0;
            },
            0, 0.5 * pi, absolute);
    }
    return sum;
  };
  // Symmetric under phi -> -phi together with s -> -s. The height passes the two edges at these angles.
  std::vector<double> edges = {0.0};
  for (const double D : {law.cutoff - j.radius, reach})
    if (D < distance + i.radius && D > distance - i.radius) edges.push_back(std::acos((distance - D) / i.radius));
  if (reach > distance + i.radius) edges.push_back(pi);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) sum += outer(along, edges[k], edges[k + 1], absolute);
  return 2 * i.density * i.radius * sum;
}

double line_density(const AtomLaw& law, const Shell& i, const Shell& j, double rho) {
  check(law, i, j, rho);
  return abel_inverse(law, i, j, rho, [&](double R) { return parallel_energy_derivative(law, i, j, R); });
}

Well parallel_well(const AtomLaw& law, const Shell& i, const Shell& j) {
  check(law, i, j);
  return PairIntegral(law, i, j).parallel_well();
}

Well crossed_well(const AtomLaw& law, const Shell& i, const Shell& j, double angle) {
  check(law, i, j);
  const double at = PairIntegral(law, i, j).crossed_well().distance;
  return {at, crossed_energy(law, i, j, at, angle)};
}

double parallel_energy_of_atoms(const AtomLaw& law, const AtomColumn& i, const AtomColumn& j, double distance,
                                double turn, double shift) {
  return parallel_energy_of_atoms(SpeciesLaws{law, law, law}, i, j, distance, turn, shift);
}

double parallel_energy_of_atoms(const SpeciesLaws& laws, const AtomColumn& i, const AtomColumn& j, double distance,
                                double turn, double shift) {
  const double cutoff = laws[0].cutoff;
  if (!(cutoff < infinite))
    throw std::invalid_argument("van der Waals: a sum over atoms needs a finite cutoff");
  if (i.atoms.empty() || j.atoms.empty() || !(i.period > 0) || !(j.period > 0))
    throw std::invalid_argument("van der Waals: a cell needs atoms and a positive period");
  const double c = std::cos(turn), s = std::sin(turn);
  double sum = 0;
  const auto second = [](const AtomColumn& column, std::size_t k) {
    return std::size_t{!column.second.empty() && column.second[k] != 0};
  };
  for (std::size_t l = 0; l < j.atoms.size(); ++l) {
    const Vector3& b = j.atoms[l];
    const double x = distance + c * b.x() - s * b.y(), y = s * b.x() + c * b.y();
    for (std::size_t k = 0; k < i.atoms.size(); ++k) {
      const Vector3& a = i.atoms[k];
      const double across = square(x - a.x()) + square(y - a.y());
      if (across >= square(cutoff)) continue;
      const AtomLaw& law = laws[second(i, k) + second(j, l)];
      const double half = std::sqrt(square(cutoff) - across), dz = b.z() + shift - a.z();
      for (double n = std::ceil((-half - dz) / j.period); dz + n * j.period <= half; ++n)
        sum += law.energy(std::sqrt(across + square(dz + n * j.period)));
    }
  }
  return sum / i.period;
}

std::array<double, 3> registry_parts(int k) {
  // Additive recurrence of the three powers of the root of x^4 = x + 1 (a golden ratio in three dimensions).
  constexpr double root = 1.2207440846057594;
  const auto part = [&](double step) { return std::fmod(0.5 + k / step, 1.0); };
  return {part(root), part(root * root), part(root * root * root)};
}

RegistrySpread registry_spread(const SpeciesLaws& laws, const AtomColumn& i, const AtomColumn& j, double distance,
                               int samples) {
  if (samples < 1) throw std::invalid_argument("van der Waals: at least one registry");
  RegistrySpread out;
  out.least = infinite;
  out.largest = -infinite;
  double squares = 0;
  AtomColumn turned = i;
  for (int k = 1; k <= samples; ++k) {
    const auto [turn_i, turn_j, shift] = registry_parts(k);
    const double c = std::cos(2 * pi * turn_i), s = std::sin(2 * pi * turn_i);
    for (std::size_t a = 0; a < i.atoms.size(); ++a) {
      const Vector3& x = i.atoms[a];
      turned.atoms[a] = {c * x.x() - s * x.y(), s * x.x() + c * x.y(), x.z()};
    }
    const double energy = parallel_energy_of_atoms(laws, turned, j, distance, 2 * pi * turn_j, j.period * shift);
    out.mean += energy / samples;
    squares += energy * energy / samples;
    out.least = std::min(out.least, energy);
    out.largest = std::max(out.largest, energy);
  }
  out.deviation = std::sqrt(std::max(0.0, squares - out.mean * out.mean));
  return out;
}

}  // namespace ropewalk::calibrate
