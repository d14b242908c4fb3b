#include "sim/statics/allowed_motions.hpp"

#include <algorithm>
#include <cmath>

#include "model/counter_random.hpp"
#include "sim/dynamics/tangent.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {
namespace {

using Eigen::VectorXd;

VectorXd velocities_of(const State& s) {
  VectorXd u(6 * static_cast<Eigen::Index>(s.size()));
  for (std::size_t i = 0; i < s.size(); ++i)
    u.segment<6>(6 * static_cast<Eigen::Index>(i)) << s.velocity[i], s.angular_velocity[i];
  return u;
}
void set_velocities(const VectorXd& u, State& s) {
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    s.velocity.set(i, u.segment<3>(row));
    s.angular_velocity.set(i, u.segment<3>(row + 3));
  }
}

double random_part(Eigen::Index k, std::uint32_t stream) {
  return 2 * unit_interval(philox({static_cast<std::uint32_t>(k), stream, 0, 0}, 4)[0]) - 1;
}

}  // namespace

AllowedMotions::AllowedMotions(const Simulation& s)
    : topology_(s.topology()), loads_(s.loads()), state_(s.state()), scratch_(s.state()) {
  const auto n = static_cast<std::size_t>(topology_.elements());
  mass_.resize(6 * static_cast<Eigen::Index>(n));
  for (int t = 0; t < topology_.tubes(); ++t)
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e) {
      const TubeType& type = topology_.type_of(t);
      mass_.segment<6>(6 * static_cast<Eigen::Index>(e)) << Vector3::Constant(type.mass),
          Vector3::Constant(type.inertia);
    }
  axis_.resize(n);
  for (std::size_t i = 0; i < n; ++i) axis_[i] = axis_of(state_.orientation[i]);
  find_constraints();
  VectorXd internal(mass_.size());
  for (std::size_t i = 0; i < n; ++i)
    internal.segment<6>(6 * static_cast<Eigen::Index>(i)) << s.forces().force[i], s.forces().torque[i];
  find_neutral(internal - load_forces(loads_, state_));
}

void AllowedMotions::constrain_motion(const State& at, VectorXd& u) const {
  if (!constrained_) return;
  if (&at != &scratch_) scratch_ = at;
  set_velocities(u, scratch_);
  constrain(topology_, loads_, before_all_motion, 0.0, scratch_);
  u = velocities_of(scratch_);
}

void AllowedMotions::constrain_force(const State& at, VectorXd& f) const {
  if (!constrained_) return;
  f.array() /= mass_.array();
  constrain_motion(at, f);
  f.array() *= mass_.array();
}

void AllowedMotions::find_constraints() {
  held_.assign(static_cast<std::size_t>(mass_.size()), 0);
  if (loads_.empty()) return;
  VectorXd u(mass_.size());
  for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = random_part(k, 0);
  constrained_ = true;
  VectorXd left = u;
  constrain_motion(state_, left);
  constrained_ = (left - u).cwiseAbs().maxCoeff() > 0;
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const bool held = left[k] == 0 && u[k] != 0;
    held_[static_cast<std::size_t>(k)] = held;
    turns_ = turns_ || (!held && left[k] != u[k]);
  }
  if (!turns_) return;
  VectorXd v(u.size()), v_left;
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = random_part(k, 2);
  v_left = v;
  constrain_motion(state_, v_left);
  const VectorXd p = mass_.cwiseProduct(u), q = mass_.cwiseProduct(v);
  keeps_momentum_ = std::fabs(p.dot(v_left) - q.dot(left)) <= 1e-9 * p.norm() * v.norm();
}

double AllowedMotions::spin_of(int tube, const VectorXd& f) const {
  double sum = 0;
  for (int e = topology_.tube_begin[tube]; e < topology_.tube_begin[tube + 1]; ++e)
    sum += axis_[static_cast<std::size_t>(e)].dot(Vector3(f.segment<3>(6 * static_cast<Eigen::Index>(e) + 3)));
  return sum;
}

// All elements of a tube have one inertia.
void AllowedMotions::without_spins(VectorXd& u) const {
  for (int t = 0; t < topology_.tubes(); ++t) {
    if (!spins_[static_cast<std::size_t>(t)]) continue;
    const double mean = spin_of(t, u) / topology_.length_of(t);
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e)
      u.segment<3>(6 * static_cast<Eigen::Index>(e) + 3) -= mean * axis_[static_cast<std::size_t>(e)];
  }
}

// Each is tried on the loads by a finite motion, at random for all spins at once.
void AllowedMotions::find_neutral(const VectorXd& internal) {
  constexpr double unmoved = 1e-9, by = 0.1;
  const VectorXd load = load_forces(loads_, state_);
  const double size = std::max(load.cwiseAbs().maxCoeff(), 1e-300);
  VectorXd spin = VectorXd::Zero(mass_.size());
  spins_.assign(static_cast<std::size_t>(topology_.tubes()), 1);
  for (int t = 0; t < topology_.tubes(); ++t)
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e)
      spin.segment<3>(6 * static_cast<Eigen::Index>(e) + 3) =
          random_part(t, 1) * axis_[static_cast<std::size_t>(e)];
  VectorXd allowed = spin;
  constrain_motion(state_, allowed);
  const VectorXd spun = load_forces(loads_, moved(state_, by * spin));
  for (int t = 0; t < topology_.tubes(); ++t) {
    double moments = 0;
    bool neutral = true;
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e) {
      const auto row = 6 * static_cast<Eigen::Index>(e);
      neutral = neutral && (allowed - spin).segment<6>(row).cwiseAbs().maxCoeff() < unmoved &&
                (spun - load).segment<6>(row).cwiseAbs().maxCoeff() < unmoved * size;
      moments += std::fabs(axis_[static_cast<std::size_t>(e)].dot(Vector3(internal.segment<3>(row + 3))));
    }
    spins_[static_cast<std::size_t>(t)] = neutral && std::fabs(spin_of(t, internal)) <= 1e-6 * moments + 1e-9;
  }
  Vector3 centre = Vector3::Zero();
  for (std::size_t i = 0; i < state_.size(); ++i) centre += state_.position[i] / static_cast<double>(state_.size());
  const char* axes = "xyz";
  for (int k = 0; k < 6; ++k) {
    const Vector3 along = Vector3::Unit(k % 3);
    VectorXd u = VectorXd::Zero(mass_.size());
    State there = state_;
    VectorXd expected = load;
    const Quaternion turn(Eigen::AngleAxisd(by, along));
    double sizes = 0;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(i);
      const Vector3 arm = state_.position[i] - centre;
      if (k < 3) {
        u.segment<3>(row) = along;
        there.position.add(i, by * along);
      } else {
        u.segment<3>(row) = along.cross(arm);
        u.segment<3>(row + 3) = along;
        there.position.set(i, centre + turn * arm);
        there.orientation.set(i, turn * state_.orientation[i]);
        expected.segment<3>(row) = turn * Vector3(load.segment<3>(row));
        expected.segment<3>(row + 3) = turn * Vector3(load.segment<3>(row + 3));
      }
      sizes += std::fabs(u.segment<6>(row).dot(internal.segment<6>(row)));
    }
    VectorXd free = u;
    constrain_motion(state_, free);
    if ((free - u).cwiseAbs().maxCoeff() > unmoved * u.cwiseAbs().maxCoeff()) continue;
    if ((load_forces(loads_, there) - expected).cwiseAbs().maxCoeff() > unmoved * size) continue;
    if (std::fabs(u.dot(internal)) > 1e-6 * sizes + 1e-9) continue;
    Whole whole{u, u, std::string(k < 3 ? "moves the whole along " : "turns the whole about ") + axes[k % 3]};
    without_spins(whole.motion);
    const double before = u.dot(mass_.cwiseProduct(u));
    for (int pass = 0; pass < 2; ++pass)
      for (const Whole& other : whole_)
        whole.motion -= other.motion.dot(mass_.cwiseProduct(whole.motion)) * other.motion;
    const double left = whole.motion.dot(mass_.cwiseProduct(whole.motion));
    if (left < 1e-9 * before) continue;
    whole.motion /= std::sqrt(left);
    whole_.push_back(std::move(whole));
  }
}

void AllowedMotions::project_motion(VectorXd& u) const {
  constrain_motion(state_, u);
  without_spins(u);
  for (const Whole& w : whole_) u -= w.motion.dot(mass_.cwiseProduct(u)) * w.motion;
}

void AllowedMotions::project_force(VectorXd& f) const {
  constrain_force(state_, f);
  without_spins(f);
  for (const Whole& w : whole_) f -= w.motion.dot(f) * mass_.cwiseProduct(w.motion);
}

void AllowedMotions::add_constraint_stiffness(const VectorXd& borne, const VectorXd& x, VectorXd& y) const {
  constexpr double farthest = 1e-4;  // nm, rad
  const double most = x.cwiseAbs().maxCoeff();
  if (!turns_ || !(most > 0)) return;
  const double by = farthest / most;
  VectorXd ahead = borne, behind = borne;
  constrain_force(moved(state_, by * x), ahead);
  constrain_force(moved(state_, -by * x), behind);
  VectorXd g = (ahead - behind) / (2 * by);
  constrain_force(state_, g);
  y -= g;
}

double AllowedMotions::largest_spin(const VectorXd& force) const {
  double most = 0;
  for (int t = 0; t < topology_.tubes(); ++t)
    if (spins_[static_cast<std::size_t>(t)]) most = std::max(most, std::fabs(spin_of(t, force)));
  return most;
}

std::string AllowedMotions::mechanism(const VectorXd& force) const {
  constexpr double balanced = 1e-3;
  for (const Whole& w : whole_) {
    double sizes = 0;
    for (Eigen::Index row = 0; row < force.size(); row += 6)
      sizes += std::fabs(w.plain.segment<6>(row).dot(force.segment<6>(row)));
    if (std::fabs(w.plain.dot(force)) > balanced * sizes + 1e-6) return w.words;
  }
  for (int t = 0; t < topology_.tubes(); ++t) {
    if (!spins_[static_cast<std::size_t>(t)]) continue;
    double sizes = 0;
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e)
      sizes += std::fabs(
          axis_[static_cast<std::size_t>(e)].dot(Vector3(force.segment<3>(6 * static_cast<Eigen::Index>(e) + 3))));
    if (std::fabs(spin_of(t, force)) > 0.1 * sizes + 1e-6)
      return "spins tube " + std::to_string(t) + " about its axis";
  }
  return "";
}

}  // namespace ropewalk
