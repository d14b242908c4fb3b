#include "plan/tube_law.hpp"

#include <cmath>

namespace ropewalk {
namespace {

constexpr double step = 1e-5;  // difference in strain, and in the angles of a bond

Frame turned(double bend, double twist) {
  const Eigen::Matrix3d r =
      (Eigen::AngleAxisd(bend, Vector3::UnitX()) * Eigen::AngleAxisd(twist, Vector3::UnitZ())).toRotationMatrix();
  return {r.col(0), r.col(1), r.col(2)};
}

// Where a function whose slope is about `stiffness` near zero has no value: the other load moves it away from zero.
template <class F>
double at_rest(const F& of, double stiffness) {
  double x = 0;
  for (int k = 0; k < 20; ++k) x -= of(x) / stiffness;
  return x;
}

// The first x from where the function is zero, towards `most` on the side of the sign of `wanted`, at which it has
// risen to `wanted`.
template <class F>
double first_reached(const F& of, double wanted, double stiffness, double most) {
  constexpr int parts = 8, most_parts = 4000;
  const double side = std::copysign(1.0, wanted), from = at_rest(of, stiffness);
  if (wanted == 0) return from;
  double low = from;
  for (int k = 1; k <= most_parts; ++k) {
    double high = from + wanted / stiffness * k / parts;
    if (!(side * high < most)) return side * most;
    if (side * of(high) < std::fabs(wanted)) {
      low = high;
      continue;
    }
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      (side * of(middle) < std::fabs(wanted) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  return side * most;
}

}  // namespace

double TubeLaw::energy(double strain, double twist, double curvature) const {
  const double bent = curvature * length_, arc = bond_.anharmonic.used ? 1 + (1 - std::cos(bent)) / 12 : 1.0;
  return bond_energy(bond_, length_, length_ * (1 + strain) / arc * Vector3::UnitZ(), turned(-0.5 * bent, 0),
                     turned(0.5 * bent, twist * length_))
             .total() /
         length_;
}

double TubeLaw::tension(double strain, double twist) const {
  return (energy(strain + step, twist, 0) - energy(strain - step, twist, 0)) / (2 * step);
}

double TubeLaw::torque(double strain, double twist) const {
  const double h = step / length_;
  return (energy(strain, twist + h, 0) - energy(strain, twist - h, 0)) / (2 * h);
}

double TubeLaw::moment(double curvature) const {
  const double h = step / length_;
  return (energy(0, 0, curvature + h) - energy(0, 0, curvature - h)) / (2 * h);
}

double TubeLaw::strain_under(double tension_, double twist) const {
  return first_reached([&](double e) { return tension(e, twist); }, tension_, bond_.stretch, 1);
}

double TubeLaw::twist_under(double torque_, double strain) const {
  return first_reached([&](double tau) { return torque(strain, tau); }, torque_, bond_.twist, largest_twist());
}

double TubeLaw::curvature_under(double moment_) const {
  return first_reached([&](double kappa) { return moment(kappa); }, std::fabs(moment_), bond_.bend,
                       0.5 * units::pi / length_);
}

}  // namespace ropewalk
