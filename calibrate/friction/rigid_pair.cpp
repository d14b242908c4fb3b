#include "friction/rigid_pair.hpp"

#include <algorithm>
#include <cmath>

namespace ropewalk::calibrate {
namespace {

bool lower(const Vector3& x, const Vector3& y) { return x.z() < y.z(); }

Vector3 turned(const Vector3& x, double cosine, double sine) {
  return {cosine * x.x() - sine * x.y(), sine * x.x() + cosine * x.y(), x.z()};
}

}  // namespace

RigidPair::RigidPair(const AtomLaw& law, std::vector<Vector3> a, double radius_a, std::vector<Vector3> b,
                     double radius_b)
    : law_(law), a_(std::move(a)), b_(std::move(b)), radius_a_(radius_a), radius_b_(radius_b) {
  std::stable_sort(a_.begin(), a_.end(), lower);
  std::stable_sort(b_.begin(), b_.end(), lower);
  low_ = b_.front().z();
  length_ = b_.back().z() - low_;
}

std::vector<RegisterForces> RigidPair::forces(const Register& at, double distance,
                                              const std::vector<double>& lengths) const {
  // Atoms of a that can reach b, in columns.
  const double cutoff = law_.cutoff, cutoff2 = cutoff * cutoff, sigma2 = law_.sigma * law_.sigma;
  std::vector<double> x, y, z;
  const double cos_a = std::cos(at.turn_a), sin_a = std::sin(at.turn_a);
  for (const Vector3& atom : a_) {
    const Vector3 p = turned(atom, cos_a, sin_a);
    if (p.x() < distance - radius_b_ - cutoff) continue;
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  const double cos_b = std::cos(at.turn_b), sin_b = std::sin(at.turn_b), cos_t = std::cos(at.tilt),
               sin_t = std::sin(at.tilt);
  const double middle = low_ + 0.5 * length_;
  std::vector<RegisterForces> out(lengths.size());
  RegisterForces sum;
  std::size_t part = 0;
  for (const Vector3& atom : b_) {
    while (part + 1 < lengths.size() && atom.z() - low_ > lengths[part]) out[part++] = sum;
    const Vector3 own = turned(atom, cos_b, sin_b);
    const double up = own.z() - middle;
    const double bx = own.x() + distance, by = own.y() * cos_t - up * sin_t,
                 bz = middle + own.y() * sin_t + up * cos_t + at.shift;
    if (bx > radius_a_ + cutoff) continue;
    const auto first = std::lower_bound(z.begin(), z.end(), bz - cutoff) - z.begin(),
               last = std::upper_bound(z.begin(), z.end(), bz + cutoff) - z.begin();
    double fx = 0, fy = 0, fz = 0, energy = 0;
    for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k) {
      const double dx = bx - x[k], dy = by - y[k], dz = bz - z[k], d2 = dx * dx + dy * dy + dz * dz;
      const double inverse2 = 1 / d2, s2 = sigma2 * inverse2, s6 = s2 * s2 * s2;
      const bool within = d2 < cutoff2;
      energy += within ? s6 * s6 - s6 : 0;
      const double f = within ? (2 * s6 * s6 - s6) * inverse2 : 0;
      fx += f * dx;
      fy += f * dy;
      fz += f * dz;
    }
    sum.energy += 4 * law_.epsilon * energy;
    const double unit = 24 * law_.epsilon;
    sum.apart += unit * fx;
    // Along the axis of b, and about both axes.
    sum.along += unit * (fz * cos_t - fy * sin_t);
    sum.spin_a += unit * (by * fx - bx * fy) / radius_a_;
    sum.spin_b += unit * (own.x() * (fy * cos_t + fz * sin_t) - own.y() * fx) / radius_b_;
  }
  for (; part < lengths.size(); ++part) out[part] = sum;
  return out;
}

double RigidPair::free_distance(const Register& at, double start) const {
  const std::vector<double> all = {length_};
  double x = start, before = start - 0.002;
  double f = forces(at, x, all)[0].apart, f_before = forces(at, before, all)[0].apart;
  for (int n = 0; n < 20 && std::fabs(x - before) > 1e-6; ++n) {
    const double slope = (f - f_before) / (x - before);
    // At distances where the attraction weakens, Newton's step would lead away from the well, which lies nearer.
    const double step = slope < 0 ? std::clamp(-f / slope, -0.02, 0.02) : -0.02;
    before = x;
    f_before = f;
    x += step;
    f = forces(at, x, all)[0].apart;
  }
  return x;
}

}  // namespace ropewalk::calibrate
