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

Vector3 centre_of(const State& s) {
  Vector3 centre = Vector3::Zero();
  for (std::size_t i = 0; i < s.size(); ++i) centre += s.position[i] / static_cast<double>(s.size());
  return centre;
}

VectorXd move_of_whole(const State& s, const Vector3& along) {
  VectorXd u(6 * static_cast<Eigen::Index>(s.size()));
  for (Eigen::Index row = 0; row < u.size(); row += 6) u.segment<6>(row) << along, Vector3::Zero();
  return u;
}

VectorXd turn_of_whole(const State& s, const Vector3& axis) {
  const Vector3 centre = centre_of(s);
  VectorXd u(6 * static_cast<Eigen::Index>(s.size()));
  for (std::size_t i = 0; i < s.size(); ++i)
    u.segment<6>(6 * static_cast<Eigen::Index>(i)) << axis.cross(Vector3(s.position[i] - centre)), axis;
  return u;
}

// Whether nothing is left of the work of each element's load.
bool cancels(const VectorXd& load, const VectorXd& motion) {
  double sizes = 0;
  for (Eigen::Index row = 0; row < load.size(); row += 6)
    sizes += std::fabs(motion.segment<6>(row).dot(load.segment<6>(row)));
  return std::fabs(motion.dot(load)) <= 1e-9 * sizes;
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
  find_images();
  find_constraints();
  VectorXd internal(mass_.size());
  for (std::size_t i = 0; i < n; ++i)
    internal.segment<6>(6 * static_cast<Eigen::Index>(i)) << s.forces().force[i], s.forces().torque[i];
  find_neutral(internal - load_forces(loads_, state_));
}

void AllowedMotions::find_images() {
  if (topology_.groups.images == 0) return;
  double mass = 0;
  for (int e = 0; e < topology_.elements(); ++e) {
    const int o = topology_.original_of(e);
    if (o == e) continue;
    const auto i = static_cast<std::size_t>(e), from = static_cast<std::size_t>(o);
    const Quaternion turn = state_.orientation[i] * state_.orientation[from].conjugate();
    Image image{6 * static_cast<Eigen::Index>(e), 6 * static_cast<Eigen::Index>(o), e > o ? 1.0 : -1.0, 0,
                turn.normalized().toRotationMatrix()};
    image.part = mass_[image.row];
    mass += image.part;
    mass_.segment<6>(image.row).setZero();
    images_.push_back(image);
  }
  for (Image& image : images_) image.part /= mass;
  VectorXd u = VectorXd::Zero(mass_.size());
  for (const Image& image : images_) u[image.row + 2] = image.sign;
  set_velocities(u, scratch_);
  constrain(topology_, loads_, before_all_motion, 0.0, scratch_);
  free_period_ = (velocities_of(scratch_) - u).cwiseAbs().maxCoeff() < 1e-9;
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
  if (!images_.empty()) {
    double on_period = 0;
    for (const Image& image : images_) on_period += 0.5 * image.sign * f[image.row + 2];
    for (Eigen::Index k = 0; k < f.size(); ++k)
      if (held_[static_cast<std::size_t>(k)]) f[k] = 0;
    if (free_period_) put_on_period(on_period, f);
    return;
  }
  f.array() /= mass_.array();
  constrain_motion(at, f);
  f.array() *= mass_.array();
}

double AllowedMotions::growth_of(const VectorXd& u) const {
  double sum = 0;
  for (const Image& image : images_) sum += image.part * image.sign * (u[image.row + 2] - u[image.original + 2]);
  return sum;
}

void AllowedMotions::put_on_period(double force, VectorXd& f) const {
  for (const Image& image : images_) {
    f[image.row + 2] += image.sign * image.part * force;
    f[image.original + 2] -= image.sign * image.part * force;
  }
}

double AllowedMotions::force_on_period(const VectorXd& f) const {
  if (!free_period_) return 0;
  double sum = 0;
  for (const Image& image : images_) sum += image.sign * f[image.row + 2];
  return sum;
}

VectorXd AllowedMotions::without_period(const VectorXd& f) const {
  VectorXd out = f;
  if (free_period_) put_on_period(-force_on_period(f), out);
  return out;
}

VectorXd AllowedMotions::stretch() const {
  if (!free_period_) return {};
  double length = 0;
  for (const Image& image : images_)
    length += image.part * image.sign *
              (state_.position.z[static_cast<std::size_t>(image.row / 6)] -
               state_.position.z[static_cast<std::size_t>(image.original / 6)]);
  VectorXd u = VectorXd::Zero(mass_.size());
  for (std::size_t i = 0; i < state_.size(); ++i)
    u[6 * static_cast<Eigen::Index>(i) + 2] = state_.position.z[i] / length;
  constrain_motion(state_, u);
  return u;
}

void AllowedMotions::let_period_stay(VectorXd& u) const {
  for (const Image& image : images_) u[image.row + 2] = u[image.original + 2];
}

void AllowedMotions::add_inertia(double by, const VectorXd& x, VectorXd& y) const {
  y.noalias() += by * mass_.cwiseProduct(x);
  if (free_period_) put_on_period(by * topology_.groups.period_inertia * growth_of(x), y);
}

std::vector<VectorXd> AllowedMotions::spins() const {
  std::vector<VectorXd> out;
  for (int t = 0; t < topology_.tubes(); ++t) {
    if (!spins_[static_cast<std::size_t>(t)]) continue;
    VectorXd u = VectorXd::Zero(mass_.size());
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e)
      u.segment<3>(6 * static_cast<Eigen::Index>(e) + 3) = axis_[static_cast<std::size_t>(e)];
    out.push_back(std::move(u));
  }
  return out;
}

std::vector<VectorXd> AllowedMotions::wholes() const {
  std::vector<VectorXd> out;
  for (const Whole& w : whole_) out.push_back(w.motion);
  return out;
}

void AllowedMotions::find_constraints() {
  held_.assign(static_cast<std::size_t>(mass_.size()), 0);
  tied_.assign(static_cast<std::size_t>(mass_.size()), 0);
  if (loads_.empty()) return;
  VectorXd u(mass_.size());
  for (Eigen::Index k = 0; k < u.size(); ++k) u[k] = random_part(k, 0);
  constrained_ = true;
  VectorXd left = u;
  constrain_motion(state_, left);
  constrained_ = (left - u).cwiseAbs().maxCoeff() > 0;
  for (const Image& image : images_)
    for (Eigen::Index k = image.row; k < image.row + 6; ++k) {
      held_[static_cast<std::size_t>(k)] = true;
      left[k] = u[k];
    }
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const bool held = left[k] == 0 && u[k] != 0;
    if (held) held_[static_cast<std::size_t>(k)] = true;
    tied_[static_cast<std::size_t>(k)] = !held && left[k] != u[k];
    turns_ = turns_ || tied_[static_cast<std::size_t>(k)];
  }
  if (!turns_) return;
  if (!images_.empty()) {
    keeps_momentum_ = false;
    return;
  }
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
    if (mass_[6 * static_cast<Eigen::Index>(e)] > 0)
      sum += axis_[static_cast<std::size_t>(e)].dot(Vector3(f.segment<3>(6 * static_cast<Eigen::Index>(e) + 3)));
  return sum;
}

// All elements of a tube have one inertia. Images turn as their originals, and no force acts on them.
void AllowedMotions::without_spins(VectorXd& u, bool of_images) const {
  for (int t = 0; t < topology_.tubes(); ++t) {
    if (!spins_[static_cast<std::size_t>(t)]) continue;
    const double mean = spin_of(t, u) / topology_.own_elements(t);
    for (int e = topology_.tube_begin[t]; e < topology_.tube_begin[t + 1]; ++e)
      if (of_images || mass_[6 * static_cast<Eigen::Index>(e)] > 0)
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
  const Vector3 centre = centre_of(state_);
  VectorXd any(mass_.size());
  for (Eigen::Index k = 0; k < any.size(); ++k) any[k] = random_part(k, 3);
  const char* axes = "xyz";
  for (int k = 0; k < 6; ++k) {
    const Vector3 along = Vector3::Unit(k % 3);
    const VectorXd u = k < 3 ? move_of_whole(state_, along) : turn_of_whole(state_, along);
    State there = state_;
    VectorXd expected = load;
    const Quaternion turn(Eigen::AngleAxisd(by, along));
    double sizes = 0;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(i);
      if (k < 3) {
        there.position.add(i, by * along);
      } else {
        there.position.set(i, centre + turn * Vector3(state_.position[i] - centre));
        there.orientation.set(i, turn * state_.orientation[i]);
        expected.segment<3>(row) = turn * Vector3(load.segment<3>(row));
        expected.segment<3>(row + 3) = turn * Vector3(load.segment<3>(row + 3));
      }
      sizes += std::fabs(u.segment<6>(row).dot(internal.segment<6>(row)));
    }
    VectorXd free = u;
    constrain_motion(state_, free);
    if ((free - u).cwiseAbs().maxCoeff() > unmoved * u.cwiseAbs().maxCoeff()) continue;
    const bool turns_along = (load_forces(loads_, there) - expected).cwiseAbs().maxCoeff() <= unmoved * size;
    const auto has_no_torque = [&](const State& at) {
      return cancels(load_forces(loads_, at), turn_of_whole(at, along));
    };
    if (!turns_along &&
        (k < 3 || !has_no_torque(state_) || !has_no_torque(there) || !has_no_torque(moved(state_, by * any))))
      continue;
    if (std::fabs(u.dot(internal)) > 1e-6 * sizes + 1e-9) continue;
    Whole whole{u, u,
                std::string(k < 3 ? "moves the whole scene along " : "turns the whole scene about ") + axes[k % 3]};
    without_spins(whole.motion, true);
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
  without_spins(u, true);
  for (const Whole& w : whole_) u -= w.motion.dot(mass_.cwiseProduct(u)) * w.motion;
}

void AllowedMotions::project_force(VectorXd& f) const {
  constrain_force(state_, f);
  without_spins(f, false);
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
