#include "friction/strength.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ropewalk::calibrate {
namespace {

struct Line {
  double slope = 0, at_zero = 0;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n,
               mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return {xy / xx, mean_y - xy / xx * mean_x};
}

// Steepest fall of the force of the longest contact, eV/nm^2.
double stiffness(const SlipCurve& curve, Slip slip, double step) {
  double steepest = 0;
  for (std::size_t k = 1; k < curve.forces.size(); ++k)
    steepest = std::max(
        steepest, (force_of(curve.forces[k - 1].back(), slip) - force_of(curve.forces[k].back(), slip)) / step);
  return steepest;
}

Strength strength(const RigidPair& pair, const std::vector<Slip>& slips, const std::vector<Register>& at,
                  const std::vector<double>& lengths) {
  std::vector<double> slopes, ends, whole, stiff;
  for (const Register& r : at)
    for (const Slip slip : slips) {
      const SlipCurve curve = slip_curve(pair, slip, r, lengths);
      const std::vector<double> largest = strengths(curve, slip);
      const Line line = line_through(lengths, largest);
      slopes.push_back(line.slope);
      ends.push_back(line.at_zero);
      whole.push_back(largest.back());
      stiff.push_back(stiffness(curve, slip, slip_step));
    }
  Strength out;
  out.per_length = mean_of(slopes);
  out.of_ends = mean_of(ends);
  out.least = *std::min_element(slopes.begin(), slopes.end());
  out.largest = *std::max_element(slopes.begin(), slopes.end());
  out.spread = out.per_length.standard_error * std::sqrt(static_cast<double>(slopes.size()));
  std::vector<double> slip;
  for (std::size_t k = 0; k < whole.size(); ++k) slip.push_back(whole[k] / stiff[k]);
  out.elastic_slip = {mean_of(whole).value / mean_of(stiff).value, mean_of(slip).standard_error};
  return out;
}

}  // namespace

double force_of(const RegisterForces& f, Slip slip) {
  return slip == Slip::along ? f.along : slip == Slip::spin_a ? f.spin_a : f.spin_b;
}

SlipCurve slip_curve(const RigidPair& pair, Slip slip, Register at, const std::vector<double>& lengths,
                     double pressed, double step, double range) {
  SlipCurve curve;
  const Register begin = at;
  double distance = pair.radius_a() + pair.radius_b() + 0.32;
  for (int k = 0; k * step < range; ++k) {
    const double way = k * step;
    if (slip == Slip::along) at.shift = begin.shift + way;
    if (slip == Slip::spin_a) at.turn_a = begin.turn_a + way / pair.radius_a();
    if (slip == Slip::spin_b) at.turn_b = begin.turn_b + way / pair.radius_b();
    distance = pair.free_distance(at, distance);
    curve.distance.push_back(distance - pressed);
    curve.forces.push_back(pair.forces(at, distance - pressed, lengths));
  }
  return curve;
}

std::vector<double> strengths(const SlipCurve& curve, Slip slip) {
  std::vector<double> largest(curve.forces.front().size(), 0.0);
  for (const auto& place : curve.forces)
    for (std::size_t k = 0; k < largest.size(); ++k)
      largest[k] = std::max(largest[k], std::fabs(force_of(place[k], slip)));
  return largest;
}

std::vector<Register> registers(int count, double period) {
  std::vector<Register> out;
  for (int k = 1; k <= count; ++k) {
    const auto [turn_a, turn_b, shift] = registry_parts(k);
    out.push_back({2 * units::pi * turn_a, 2 * units::pi * turn_b, period * shift, 0});
  }
  return out;
}

Measured mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (n * (n - 1))) : 0};
}

Strength along_strength(const RigidPair& pair, const std::vector<Register>& at,
                        const std::vector<double>& lengths) {
  return strength(pair, {Slip::along}, at, lengths);
}
Strength spin_strength(const RigidPair& pair, const std::vector<Register>& at, const std::vector<double>& lengths) {
  return strength(pair, {Slip::spin_a, Slip::spin_b}, at, lengths);
}

std::vector<Pressed> pressed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& nearer) {
  const std::vector<double> all = {pair.length()};
  std::vector<double> free;
  for (const Register& r : at) free.push_back(strengths(slip_curve(pair, Slip::along, r, all), Slip::along)[0]);
  std::vector<Pressed> out;
  for (const double by : nearer) {
    std::vector<double> ratios, forces;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const SlipCurve pressed = slip_curve(pair, Slip::along, at[k], all, by);
      ratios.push_back(strengths(pressed, Slip::along)[0] / free[k]);
      for (const auto& place : pressed.forces) forces.push_back(place[0].apart / pair.length());
    }
    out.push_back({by, mean_of(ratios), mean_of(forces).value});
  }
  return out;
}

std::vector<Crossed> crossed_strengths(const RigidPair& pair, const std::vector<Register>& at,
                                       const std::vector<double>& angles) {
  std::vector<Crossed> out;
  for (const double angle : angles) {
    std::vector<double> forces;
    for (Register r : at) {
      r.tilt = angle;
      forces.push_back(strengths(slip_curve(pair, Slip::along, r, {pair.length()}), Slip::along)[0]);
    }
    out.push_back({angle, mean_of(forces)});
  }
  return out;
}

}  // namespace ropewalk::calibrate
