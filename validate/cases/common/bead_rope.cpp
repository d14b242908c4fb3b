#include "cases/common/bead_rope.hpp"

#include <algorithm>

#include "model/error.hpp"

namespace ropewalk::validate {
namespace {

constexpr double force_tolerance = 1e-4;  // eV/nm
constexpr long max_steps = 200000;

}  // namespace

BeadRope::BeadRope(const GrippedRope& gripped, const BeadLaw& law)
    : rope_(gripped),
      law_(law),
      position_(gripped.state.position),
      velocity_(position_.size()),
      force_(position_.size()) {
  compute();
}

void BeadRope::turn(double angle) {
  for (std::size_t i = 0; i < position_.size(); ++i)
    position_.set(i, turn_about(Vector3::UnitZ(), rope_.turn_of(static_cast<int>(i), angle)) * position_[i]);
  compute();
}

// EA/2a (D - a)^2 of a bond, EI/a (1 - cos) of the hinge between two.
void BeadRope::bonds(std::size_t first) {
  const TubeType& type = rope_.topology.types[0];
  const double a = type.element_length, hinge = type.bond.bend / a;
  const auto beads = static_cast<std::size_t>(rope_.elements_of_tube());
  Vector3 before = Vector3::Zero();  // direction of the last bond
  double before_length = 0;
  for (std::size_t k = first; k + 1 < first + beads; ++k) {
    const Vector3 r = position_[k + 1] - position_[k];
    const double length = r.norm(), strain = length - a;
    const Vector3 d = r / length;
    stretch_ += 0.5 * type.bond.stretch / a * strain * strain;
    const Vector3 pull = type.bond.stretch / a * strain * d;
    force_.add(k, pull);
    force_.add(k + 1, -pull);
    if (k > first) {
      const double c = before.dot(d);
      bend_ += hinge * (1 - c);
      const Vector3 here = hinge / length * (before - c * d), there = hinge / before_length * (d - c * before);
      force_.add(k + 1, here);
      force_.add(k, there - here);
      force_.add(k - 1, -there);
    }
    before = d;
    before_length = length;
  }
}

void BeadRope::compute() {
  const std::size_t n = position_.size(), beads = static_cast<std::size_t>(rope_.elements_of_tube());
  force_ = Vec3Array(n);
  stretch_ = bend_ = contact_ = 0;
  for (std::size_t first = 0; first < n; first += beads) bonds(first);
  // So far beyond the well that only forces of 1e-4 of the largest are cut off.
  const double reach2 = 16 * law_.sigma * law_.sigma;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = (i / beads + 1) * beads; j < n; ++j) {
      const Vector3 r = position_[j] - position_[i];
      const double r2 = r.squaredNorm();
      if (r2 > reach2) continue;
      contact_ += law_.energy(r2) - law_.energy(reach2);
      const Vector3 f = law_.force_over_distance(r2) * r;
      force_.add(i, -f);
      force_.add(j, f);
    }
}

double BeadRope::largest_force() const {
  double largest = 0;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    const double at = rope_.fraction_at(static_cast<int>(i));
    if (at > 0 && at < 1) largest = std::max(largest, force_[i].norm());
  }
  return largest;
}

// FIRE: E. Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006), DOI 10.1103/PhysRevLett.97.170201.
void BeadRope::relax() {
  const TubeType& type = rope_.topology.types[0];
  const double a = type.element_length, stiffest = std::sqrt(4 * type.bond.stretch / (a * type.mass) +
                                                             16 * type.bond.bend / (a * a * a * type.mass));
  const double dt_max = 1.8 / stiffest;
  double dt = 0.5 * dt_max, mix = 0.1;
  int downhill = 0;
  const std::size_t n = position_.size();
  velocity_ = Vec3Array(n);
  for (long step = 0; step < max_steps; ++step) {
    if (step % 10 == 0 && largest_force() < force_tolerance) return;
    double power = 0, v2 = 0, f2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double at = rope_.fraction_at(static_cast<int>(i));
      if (at <= 0 || at >= 1) force_.set(i, Vector3::Zero());
      power += force_[i].dot(velocity_[i]);
    }
    if (power > 0) {
      if (++downhill > 5) dt = std::min(1.1 * dt, dt_max), mix *= 0.99;
    } else {
      velocity_ = Vec3Array(n);
      downhill = 0, dt = 0.5 * dt, mix = 0.1;
    }
    for (std::size_t i = 0; i < n; ++i) {
      velocity_.add(i, dt / type.mass * force_[i]);
      v2 += velocity_[i].squaredNorm(), f2 += force_[i].squaredNorm();
    }
    const double turn = f2 > 0 ? mix * std::sqrt(v2 / f2) : 0;
    for (std::size_t i = 0; i < n; ++i) {
      velocity_.set(i, (1 - mix) * velocity_[i] + turn * force_[i]);
      position_.add(i, dt * velocity_[i]);
    }
    compute();
  }
  throw NumericalError(max_steps, -1, "the rope of beads did not come to rest", "turn it in smaller increments");
}

double BeadRope::moment() const {
  return resisting_moment(rope_.upper, position_, force_, Vec3Array(position_.size()));
}

}  // namespace ropewalk::validate
