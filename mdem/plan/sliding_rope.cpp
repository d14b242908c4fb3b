#include "plan/sliding_rope.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "observe/centre_line.hpp"
#include "scene/source.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int slip_waves = 64;                 // Legendre polynomials of the slip, which turns with the winding
constexpr double tilting = 4.493409457909064;  // tan x = x
constexpr double most_over_static = 100;       // moments beyond are not looked for

// Legendre polynomials of the deflection, whose growing motions turn by up to 3 mu/4. Rates are right to 1e-5.
int waves_of(double mu) { return static_cast<int>(std::clamp(12 + 0.5 * mu, 16.0, 40.0)); }

// Nodes and weights of Gauss and Legendre on [0, 1]: Newton's method for the zeros of the polynomial.
struct Quadrature {
  VectorXd at, weight;
};
Quadrature gauss_legendre(int n) {
  Quadrature out{VectorXd(n), VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(units::pi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (double step = 1; std::abs(step) > 1e-15;) {
      double value = x, before = 1;
      for (int k = 2; k <= n; ++k) before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
      slope = n * (x * value - before) / (x * x - 1);
      step = value / slope;
      x -= step;
    }
    out.at(i) = 0.5 * (x + 1);
    out.weight(i) = 1 / ((1 - x * x) * slope * slope);
  }
  return out;
}

// Polynomials of Legendre on [0, 1], a row each, and their first two derivatives at the nodes.
struct Basis {
  Quadrature nodes = gauss_legendre(96);
  MatrixXd value, slope, curvature;
  MatrixXd bending, turning;  // <v'', u''> and <v'', u'>
  VectorXd norm;              // <v, v>

  Basis() {
    const Eigen::Index q = nodes.at.size();
    value = slope = curvature = MatrixXd::Zero(slip_waves, q);
    value.row(0).setOnes();
    value.row(1) = 2 * nodes.at.transpose().array() - 1;
    slope.row(1).setConstant(2);
    for (int n = 1; n + 1 < slip_waves; ++n) {
      value.row(n + 1) = ((2 * n + 1) * value.row(1).cwiseProduct(value.row(n)) - n * value.row(n - 1)) / (n + 1);
      slope.row(n + 1) = slope.row(n - 1) + 2 * (2 * n + 1) * value.row(n);
      curvature.row(n + 1) = curvature.row(n - 1) + 2 * (2 * n + 1) * slope.row(n);
    }
    norm = VectorXd(slip_waves);
    for (int n = 0; n < slip_waves; ++n) norm(n) = 1.0 / (2 * n + 1);
    const MatrixXd weighted = curvature * nodes.weight.asDiagonal();
    bending = weighted * curvature.transpose();
    turning = weighted * slope.transpose();
  }
};
const Basis& basis() {
  static const Basis made;
  return made;
}

// A complex matrix as two real ones: complex matrices of Eigen took 13 s more to compile.
struct ComplexMatrix {
  MatrixXd real, imaginary;
};

// <a_v - mean, a_u - mean> for the winding `turn` (rad from end to end). The integral of a polynomial is
// int_0^x P_j = (P_j+1 - P_j-1)/(4 j + 2) and (P_1 + P_0)/2 for j = 0; P_0 is the mean.
ComplexMatrix slip_of(double turn, int waves) {
  const Basis& b = basis();
  const VectorXd angle = turn * b.nodes.at;
  const auto integrals = [&](const VectorXd& wave) {
    MatrixXd series =
        b.curvature.topRows(waves) * wave.cwiseProduct(b.nodes.weight).asDiagonal() * b.value.transpose();
    series.array().rowwise() /= b.norm.transpose().array();
    MatrixXd whole = MatrixXd::Zero(waves, slip_waves);
    for (int j = 0; j < slip_waves; ++j) {
      if (j + 1 < slip_waves) whole.col(j + 1) += series.col(j) / (4.0 * j + 2);
      if (j > 1) whole.col(j - 1) -= series.col(j) / (4.0 * j + 2);
    }
    return whole;
  };
  const MatrixXd even = integrals(angle.array().cos()), odd = integrals(-angle.array().sin());
  const MatrixXd weighted_even = even * b.norm.asDiagonal(), weighted_odd = odd * b.norm.asDiagonal();
  return {weighted_even * even.transpose() + weighted_odd * odd.transpose(),
          weighted_even * odd.transpose() - weighted_odd * even.transpose()};
}

// lambda^2 c + lambda z D c + (K - i mu G) c = 0, in units of L^2 (m/B)^1/2: the real matrix of the real and the
// imaginary parts of c and of its rates, which has each lambda and its conjugate.
MatrixXd system_of(double mu, double z, double winding) {
  const Basis& b = basis();
  const int waves = waves_of(mu);
  const auto inverse = b.norm.head(waves).cwiseInverse().asDiagonal();
  const MatrixXd bending = inverse * b.bending.topLeftCorner(waves, waves);
  const MatrixXd turning = mu * (inverse * b.turning.topLeftCorner(waves, waves));
  MatrixXd system = MatrixXd::Zero(4 * waves, 4 * waves);  // rows for real c, imaginary c, and the rates of both
  const auto block = [&](int row, int column) { return system.block(row * waves, column * waves, waves, waves); };
  block(0, 2).setIdentity();
  block(1, 3).setIdentity();
  block(2, 0) = block(3, 1) = -bending;
  block(2, 1) = -turning;
  block(3, 0) = turning;
  if (z > 0) {
    const ComplexMatrix slip = slip_of(mu * winding, waves);
    block(2, 2) = block(3, 3) = -z * (inverse * slip.real);
    block(2, 3) = z * (inverse * slip.imaginary);
    block(3, 2) = -z * (inverse * slip.imaginary);
  }
  return system;
}
double fastest(double mu, double z, double winding) {
  return Eigen::EigenSolver<MatrixXd>(system_of(mu, z, winding), false).eigenvalues().real().maxCoeff();
}

// The fastest growing motion as a line of the length 1 that is nearly straight.
std::vector<Vector3> fastest_line(double mu, double z, double winding) {
  constexpr int points = 201;
  constexpr double amplitude = 1e-3;
  const Eigen::EigenSolver<MatrixXd> solver(system_of(mu, z, winding), true);
  Eigen::Index k = 0;
  solver.eigenvalues().real().maxCoeff(&k);
  // x + i y of the real part x and the imaginary part y of c. The vector is that of lambda, with y = -i x, or that
  // of its conjugate, with y = i x: then x + i y is zero, and the conjugate vector is the one.
  const int waves = waves_of(mu);
  const VectorXd re = solver.eigenvectors().col(k).real(), im = solver.eigenvectors().col(k).imag();
  const auto x = [&](const VectorXd& v) { return v.head(waves); };
  const auto y = [&](const VectorXd& v) { return v.segment(waves, waves); };
  VectorXd real = x(re) - y(im), imaginary = x(im) + y(re);
  const VectorXd real_of_other = x(re) + y(im), imaginary_of_other = y(re) - x(im);
  if (real.squaredNorm() + imaginary.squaredNorm() <
      real_of_other.squaredNorm() + imaginary_of_other.squaredNorm()) {
    real = real_of_other;
    imaginary = imaginary_of_other;
  }
  std::vector<Vector3> line;
  double largest = 0;
  for (int j = 0; j < points; ++j) {
    const double s = static_cast<double>(j) / (points - 1), at = 2 * s - 1;
    double value = at, before = 1;
    Vector3 p(real(0) + real(1) * at, imaginary(0) + imaginary(1) * at, s);
    for (int n = 2; n < waves; ++n) {
      before = std::exchange(value, ((2 * n - 1) * at * value - (n - 1) * before) / n);
      p += value * Vector3(real(n), imaginary(n), 0);
    }
    largest = std::max(largest, p.head<2>().norm());
    line.push_back(p);
  }
  for (Vector3& p : line) p.head<2>() *= amplitude / largest;
  return line;
}

}  // namespace

double SlidingRope::static_moment() const { return 2 * tilting * bend / length; }

double SlidingRope::growth(double moment, double winding) const {
  if (moment <= static_moment()) return 0;  // the eigenvalues there are zero, and their errors are not
  const double time = length * length * std::sqrt(mass / bend);
  return std::max(0.0, fastest(moment * length / bend, slip / std::sqrt(mass * bend), winding)) / time;
}

double SlidingRope::windings(double moment, double winding) const {
  if (moment <= static_moment()) return 0;
  return helix_of(fastest_line(moment * length / bend, slip / std::sqrt(mass * bend), winding)).windings;
}

// The integral over the ramp by Gauss's rule in the root of the moment beyond the static one, in which the rate of
// an undamped rope is straight.
double SlidingRope::gain(double moment, double winding, double rate, double hold) const {
  const double least = static_moment();
  if (moment <= least) return 0;
  double sum = growth(moment, winding) * hold;
  if (!(rate > 0)) return sum;
  static const Quadrature rule = gauss_legendre(4);
  const double reach = std::sqrt(moment - least);
  for (Eigen::Index k = 0; k < rule.at.size(); ++k) {
    const double root = reach * rule.at(k);
    sum += rule.weight(k) * growth(least + root * root, winding) * 2 * root * reach / rate;
  }
  return sum;
}

double SlidingRope::moment_of_gain(double wanted, double winding, double rate, double hold) const {
  double below = static_moment(), above = 1.05 * below;
  while (gain(above, winding, rate, hold) < wanted && above < most_over_static * static_moment())
    below = above, above *= 1.25;
  while (above - below > 1e-3 * above) {
    const double middle = 0.5 * (below + above);
    (gain(middle, winding, rate, hold) < wanted ? below : above) = middle;
  }
  return 0.5 * (below + above);
}

double HelixTheory::moment_to_pass(double amplitude, double winding) const {
  if (!grows || !(first_amplitude > 0) || !(amplitude > first_amplitude)) return 0;
  return tubes_in_unit * rope.moment_of_gain(std::log(amplitude / first_amplitude), winding, rate, hold);
}

double HelixTheory::growth(double moment, double winding) const {
  return grows ? rope.growth(moment / tubes_in_unit, winding) : 0;
}

double HelixTheory::windings(double moment, double winding) const {
  return grows ? rope.windings(moment / tubes_in_unit, winding) : 0;
}

double HelixTheory::winding_of(double turn, double moment) const {
  return std::fabs(turn) / (moment / tubes_in_unit * rope.length / rope.bend);
}

std::optional<HelixTheory> helix_theory(const Scene& scene, const Prepared& p) {
  const EndDrives drives = end_drives(p.loads, p.topology);
  const std::optional<EndMoment> load = end_moment(drives);
  const EndFreedom ends = end_freedom(drives);
  if (!scene.source->is_parallel() || scene.sets.size() > 1 || !load) return {};
  if (!load->balanced || !load->on_all || load->by != LoadEffect::By::couple || load->relaxes_spins) return {};
  if (ends.otherwise_driven || !ends.tilts || !ends.one_element) return {};
  const bool lateral_free = ends.sideways == EndFreedom::Sideways::free;
  const int tubes = p.topology.tubes();
  const TubeType& tube = p.topology.type_of(0);
  const double a = tube.element_length;
  HelixTheory out;
  SlidingRope& rope = out.rope;
  rope.length = p.topology.length_of(0) * a;
  rope.bend = tube.bond.bend;
  rope.mass = tube.mass / a;
  const ContactViscosity& viscosity = p.interaction.damping.contact;
  const int reach = static_cast<int>(viscosity.outer / a) + 1;
  const auto place_of = [&](int t) -> Eigen::Vector2d {
    return Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>();
  };
  for (int t = 0; t < tubes; ++t) {
    out.glued_over_sliding += tube.bond.stretch * place_of(t).squaredNorm() / (2 * tubes * rope.bend);
    for (int u = t + 1; u < tubes && viscosity.eta > 0; ++u) {
      const double apart2 = (place_of(t) - place_of(u)).squaredNorm();
      for (int k = -reach; k <= reach; ++k)
        rope.slip += viscosity.eta * viscosity.weight(std::sqrt(apart2 + k * k * a * a)) * apart2 / (2 * a * tubes);
    }
  }
  out.tubes_in_unit = load->per_tube ? 1 : tubes;
  out.static_moment =
      out.tubes_in_unit * (lateral_free ? rope.static_moment() : 2 * units::pi * rope.bend / rope.length);
  out.grows = lateral_free && scene.damping.local == 0 && !scene.bath() && p.interaction.terms.empty();
  const double ramp = load->ramp_time();
  out.rate = ramp > 0 ? load->largest() / ramp / out.tubes_in_unit : 0;
  out.hold = (load->course.stays() ? p.duration : load->course.leaves()) - ramp;
  out.first_amplitude = scene.start.half_waves == 1 ? 0.5 * scene.start.wave : 0;
  return out;
}

}  // namespace ropewalk
