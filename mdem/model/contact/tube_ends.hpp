// Van der Waals contact of two tubes in line, end against end: rows of atoms about the common axis.
//
// A tube that ends has rows of atoms on circles about its axis: gcd(n,m) hexagons a row, of height h, and each row
// has two circles of gcd(n,m) atoms, b apart along the axis (b = 0 for armchair tubes, h/3 for zigzag ones). The
// end of the tube lies half a row beyond the middle of its last row. Two such tubes with the gap s between their
// ends, averaged over their turns about the axis, have
//
//   V(s) = sum_k,l N_i N_j <v(rho)>,   rho^2 = z^2 + r_i^2 + r_j^2 - 2 r_i r_j cos(theta),
//
// over the circles k of one tube and l of the other, which lie z = s + z_k + z_l apart along the axis. <> is the
// mean over theta, and v is the Lennard-Jones energy of two atoms, cut off without a shift. The far ends of both
// tubes are out of reach. Where V has risen from the bottom of its well by half of the depth, its second-order
// Taylor polynomial continues it.
//
// Where the ends lie apart across their common axis, by the distance delta, their energy is V W with the weight
//
//   W = (1 - q)^3 for q < 1, and 0 beyond,   q = (delta/(r_i + r_j))^2.
//
// No atoms were measured for W: we chose it, so that ends that have passed each other have no contact. Units nm,
// eV.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "model/contact/line.hpp"
#include "model/contract.hpp"
#include "model/tube.hpp"
#include "model/units.hpp"

namespace ropewalk {

struct LennardJones {
  double epsilon = 0, sigma = 0, cutoff = 0;  // eV, nm, nm; cutoff 0: none
};

// The atoms at the end of a tube.
struct TubeEnd {
  double radius = 0;  // nm
  int atoms = 0;      // atoms on a circle
  double row = 0;     // h, nm
  double split = 0;   // b, nm
};

// atoms_per_length: 1/nm.
inline TubeEnd tube_end(Chirality c, double radius, double atoms_per_length) {
  ROPEWALK_EXPECTS(radius > 0 && atoms_per_length > 0);
  const int d = std::gcd(c.n, c.m);
  const double row = 2 * d / atoms_per_length;
  // The bond from one lattice site to the other has the part (n - m)/(2 sqrt(3 (n^2 + n m + m^2))) of the lattice
  // constant along the axis; the constant is the circumference over sqrt(n^2 + n m + m^2).
  const double square =
      static_cast<double>(c.n) * c.n + static_cast<double>(c.n) * c.m + static_cast<double>(c.m) * c.m;
  const double along = 2 * units::pi * radius * std::abs(c.n - c.m) / (2 * std::sqrt(3.0) * square);
  return {radius, d, row, std::remainder(along, row)};
}

class EndContact {
 public:
  // `i`, `j`: the ends of all walls of both tubes, inside first, which lie in one plane each. V is the sum over them.
  EndContact(const LennardJones& law, const std::vector<TubeEnd>& i, const std::vector<TubeEnd>& j);
  EndContact(const LennardJones& law, const TubeEnd& i, const TubeEnd& j)
      : EndContact(law, std::vector{i}, std::vector{j}) {}

  double reach() const { return reach_; }  // largest gap with a force
  double rest() const { return rest_; }    // the gap of lowest energy
  double width() const { return width_; }  // r_i + r_j
  // eV/nm^2: the largest second derivative. It grows towards the core.
  double stiffness() const { return at(core_).second; }

  // V and its derivatives by the gap.
  RadialTerms terms(double gap) const {
    if (gap >= reach_) return {};
    const double beyond = std::min(gap - core_, 0.0);
    RadialTerms t = at(gap - beyond);
    t.energy += beyond * (t.derivative + 0.5 * beyond * t.second);
    t.derivative += beyond * t.second;
    return t;
  }

 private:
  static constexpr double nearest = 0.1, spacing = 0.01;  // first gap and spacing of the table, nm
  static constexpr double without_cutoff = 4;             // sigma
  static constexpr int turns = 128;                       // values of theta in half a circle

  static RadialTerms sum(const LennardJones& law, double reach, const TubeEnd& i, const TubeEnd& j, double gap);
  RadialTerms at(double gap) const;

  double reach_, width_, step_ = 0, core_ = 0, rest_ = 0;
  std::vector<RadialTerms> table_;
};

// --- Definitions ------------------------------------------------------------------------------------

inline EndContact::EndContact(const LennardJones& law, const std::vector<TubeEnd>& i, const std::vector<TubeEnd>& j)
    : reach_(law.cutoff > 0 ? law.cutoff : without_cutoff * law.sigma), width_(i.back().radius + j.back().radius) {
  ROPEWALK_EXPECTS(law.epsilon > 0 && law.sigma > 0 && reach_ > nearest);
  const int steps = static_cast<int>(std::ceil((reach_ - nearest) / spacing));
  step_ = (reach_ - nearest) / steps;
  for (int k = 0; k < steps; ++k) {
    table_.emplace_back();
    for (const TubeEnd& of_i : i)
      for (const TubeEnd& of_j : j) {
        const RadialTerms t = sum(law, reach_, of_i, of_j, nearest + k * step_);
        table_.back().energy += t.energy, table_.back().derivative += t.derivative, table_.back().second += t.second;
      }
  }
  table_.push_back({});  // no atom reaches another one
  // The well, and its inner wall.
  std::size_t lowest = 0;
  for (std::size_t k = 1; k < table_.size(); ++k)
    if (table_[k].energy < table_[lowest].energy) lowest = k;
  const auto bisected = [&](double low, double high, const auto& is_low) {
    while (high - low > 1e-9) {
      const double middle = 0.5 * (low + high);
      (is_low(at(middle)) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  const double well = nearest + static_cast<double>(lowest) * step_;
  rest_ = lowest == 0 ? nearest
                      : bisected(well - step_, well + step_, [](const RadialTerms& t) { return t.derivative < 0; });
  const double depth = at(rest_).energy;
  core_ = bisected(nearest, rest_, [&](const RadialTerms& t) { return t.energy > 0.5 * depth; });
}

inline RadialTerms EndContact::sum(const LennardJones& law, double reach, const TubeEnd& i, const TubeEnd& j,
                                   double gap) {
  RadialTerms out;
  const double squares = i.radius * i.radius + j.radius * j.radius, product = 2 * i.radius * j.radius;
  const double per_turn = static_cast<double>(i.atoms) * j.atoms / turns;
  // Places of the circles behind the end, from half a row less half the split on.
  const auto circles = [&](const TubeEnd& end) {
    std::vector<double> z;
    for (int k = 0; (k + 0.5) * end.row - 0.5 * std::fabs(end.split) < reach; ++k)
      for (const double half : {-0.5, 0.5}) z.push_back((k + 0.5) * end.row + half * end.split);
    return z;
  };
  for (const double below : circles(i))
    for (const double above : circles(j)) {
      const double z = gap + below + above;
      if (z >= reach) continue;
      for (int k = 0; k < turns; ++k) {
        const double rho2 = z * z + squares - product * std::cos((k + 0.5) * units::pi / turns);
        if (rho2 >= reach * reach) break;
        const double x2 = law.sigma * law.sigma / rho2, x6 = x2 * x2 * x2;
        const double v = 4 * law.epsilon * x6 * (x6 - 1);
        // Derivative by rho^2.
        const double first = -4 * law.epsilon * x6 * (6 * x6 - 3) / rho2,
                     second = 4 * law.epsilon * x6 * (42 * x6 - 12) / (rho2 * rho2);
        out.energy += per_turn * v;
        out.derivative += per_turn * 2 * z * first;
        out.second += per_turn * (2 * first + 4 * z * z * second);
      }
    }
  return out;
}

// Quintic Hermite interpolation, so that V is twice continuously differentiable.
inline RadialTerms EndContact::at(double gap) const {
  const double place = std::max((gap - nearest) / step_, 0.0);
  const std::size_t k = std::min(static_cast<std::size_t>(place), table_.size() - 2);
  const double t = place - static_cast<double>(k), h = step_;
  const RadialTerms &a = table_[k], &b = table_[k + 1];
  // a + a' t h + a'' (t h)^2/2 + t^3 (p + q t + r t^2)
  const double rise = b.energy - a.energy - h * (a.derivative + 0.5 * h * a.second),
               slope = h * (b.derivative - a.derivative - h * a.second), bend = h * h * (b.second - a.second);
  const double p = 10 * rise - 4 * slope + 0.5 * bend, q = -15 * rise + 7 * slope - bend,
               r = 6 * rise - 3 * slope + 0.5 * bend;
  return {a.energy + h * t * (a.derivative + 0.5 * h * t * a.second) + t * t * t * (p + t * (q + t * r)),
          a.derivative + h * t * a.second + t * t * (3 * p + t * (4 * q + 5 * r * t)) / h,
          a.second + t * (6 * p + t * (12 * q + 20 * r * t)) / (h * h)};
}

}  // namespace ropewalk
