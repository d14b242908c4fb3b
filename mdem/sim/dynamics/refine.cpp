#include "sim/dynamics/refine.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "model/contract.hpp"
#include "sim/state/motion.hpp"

namespace ropewalk {
namespace {

struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion turn = Quaternion::Identity();
};

Pose pose_of(const State& s, int i) {
  const auto at = static_cast<std::size_t>(i);
  return {s.position[at], s.orientation[at]};
}

double sinc(double x) { return std::fabs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

Quaternion turn_by(const Vector3& rotation) {
  const double angle = rotation.norm();
  const Vector3 v = 0.5 * sinc(0.5 * angle) * rotation;
  return {std::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

Quaternion roll_by(double angle) { return {std::cos(0.5 * angle), 0, 0, std::sin(0.5 * angle)}; }

// The rod of one bond.
class RodPiece {
 public:
  RodPiece(const Pose& i, const Pose& j, double shear_share) : i_(i), j_(j), share_(shear_share) {
    const Vector3 t_i = axis_of(i.turn), t_j = axis_of(j.turn), across = t_i.cross(t_j);
    const double sine = across.norm(), angle = std::atan2(sine, t_i.dot(t_j));
    bend_ = sine > 0 ? Vector3(angle / sine * across) : Vector3::Zero();
    const Quaternion rest = (turn_by(bend_) * i.turn).conjugate() * j.turn;
    roll_ = 2 * std::atan2(rest.z(), rest.w());
    if (roll_ > units::pi) roll_ -= 2 * units::pi;
    if (roll_ <= -units::pi) roll_ += 2 * units::pi;
    const Vector3 r = j.position - i.position;
    mean_ = (t_i + t_j).normalized();
    length_ = r.dot(mean_) / sinc(0.5 * angle);
    shear_ = r - r.dot(mean_) * mean_;
  }

  Pose inside(double u) const {
    const double cubic = u + share_ * (3 * u * u - 2 * u * u * u - u);
    const Vector3 lean = 6 * share_ * u * (1 - u) / length_ * shear_;
    return {i_.position + arc(u) + cubic * shear_, turn_by(mean_.cross(lean)) * turn(u)};
  }
  Pose before(double u) const { return {i_.position + arc(u) + u * (1 - share_) * shear_, turn(u)}; }
  Pose behind(double u) const { return {j_.position + arc(u) - arc(1) + (u - 1) * (1 - share_) * shear_, turn(u)}; }

 private:
  Vector3 arc(double u) const {
    return length_ * u * sinc(0.5 * u * bend_.norm()) * (turn_by(0.5 * u * bend_) * axis_of(i_.turn));
  }
  Quaternion turn(double u) const { return turn_by(u * bend_) * i_.turn * roll_by(u * roll_); }

  Pose i_, j_;
  double share_;
  Vector3 bend_, mean_, shear_;
  double roll_ = 0, length_ = 0;
};

void set_pose(const Pose& p, int i, State& out) {
  const auto at = static_cast<std::size_t>(i);
  out.position.set(at, p.position);
  out.orientation.set(at, p.turn.normalized());
}

// The first element of a tube of the finer chain.
int begin_of(const Topology& coarse, int tube, Splitting how) {
  return 2 * coarse.tube_begin[tube] - (how == Splitting::between ? tube : 0);
}

void place_between(const Topology& coarse, int tube, const State& s, State& out) {
  const TubeType& type = coarse.type_of(tube);
  const double share = shear_share(type.bond, type.element_length);
  int at = begin_of(coarse, tube, Splitting::between);
  for (int i = coarse.tube_begin[tube]; i < coarse.tube_begin[tube + 1]; ++i) {
    set_pose(pose_of(s, i), at++, out);
    if (i + 1 < coarse.tube_begin[tube + 1])
      set_pose(RodPiece(pose_of(s, i), pose_of(s, i + 1), share).inside(0.5), at++, out);
  }
}

void place_halves(const Topology& coarse, int tube, const State& s, State& out) {
  const int from = coarse.tube_begin[tube], to = coarse.tube_begin[tube + 1];
  const TubeType& type = coarse.type_of(tube);
  const double share = shear_share(type.bond, type.element_length);
  if (to - from == 1) {
    const Pose p = pose_of(s, from);
    const Vector3 quarter = 0.25 * type.element_length * axis_of(p.turn);
    set_pose({p.position - quarter, p.turn}, 2 * from, out);
    set_pose({p.position + quarter, p.turn}, 2 * from + 1, out);
    return;
  }
  for (int i = from; i + 1 < to; ++i) {
    const RodPiece rod(pose_of(s, i), pose_of(s, i + 1), share);
    set_pose(rod.inside(0.25), 2 * i + 1, out);
    set_pose(rod.inside(0.75), 2 * i + 2, out);
    if (i == from) set_pose(rod.before(-0.25), 2 * from, out);
    if (i + 2 == to) set_pose(rod.behind(1.25), 2 * to - 1, out);
  }
}

State placed(const Topology& coarse, const State& s, Splitting how) {
  State out(static_cast<std::size_t>(begin_of(coarse, coarse.tubes(), how)));
  for (int t = 0; t < coarse.tubes(); ++t)
    (how == Splitting::between ? place_between : place_halves)(coarse, t, s, out);
  return out;
}

// The time in which no element moves farther than a thousandth of its length or turns by more than that in rad: the
// stencil below is then exact to 1e-11 of the largest velocities.
double stencil_time(const Topology& coarse, const State& s) {
  constexpr double little = 1e-3;
  double rate = 0;
  for (int t = 0; t < coarse.tubes(); ++t)
    for (int i = coarse.tube_begin[t]; i < coarse.tube_begin[t + 1]; ++i) {
      const auto at = static_cast<std::size_t>(i);
      rate =
          std::max({rate, s.velocity[at].norm() / coarse.type_of(t).element_length, s.angular_velocity[at].norm()});
    }
  return rate > 0 ? little / rate : 0;
}

// Derivative of the map along the motion, by central differences of fourth order.
void follow(const Topology& coarse, const State& s, Splitting how, State& fine) {
  const double h = stencil_time(coarse, s);
  if (h <= 0) return;
  constexpr std::array<std::array<double, 2>, 4> stencil = {{{1, 8}, {-1, -8}, {2, -1}, {-2, 1}}};
  for (const auto& [steps, weight] : stencil) {
    State moved = s;
    move_elements(moved, steps * h, 0, static_cast<std::ptrdiff_t>(s.size()));
    const State at = placed(coarse, moved, how);
    const double share = weight / (12 * h);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const Quaternion q = fine.orientation[i];
      Quaternion change = at.orientation[i] * q.conjugate();
      if (change.w() < 0) change.coeffs() *= -1;
      fine.velocity.add(i, share * (at.position[i] - fine.position[i]));
      fine.angular_velocity.add(i, 2 * share * change.vec());
    }
  }
}

// Linear momentum, and angular momentum about a point with the elements' own spins, of one tube.
struct TubeMomenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

TubeMomenta momenta(const Topology& topology, int tube, const State& s, const Vector3& about) {
  const TubeType& type = topology.type_of(tube);
  TubeMomenta out;
  for (int e = topology.tube_begin[tube]; e < topology.tube_begin[tube + 1]; ++e) {
    const auto i = static_cast<std::size_t>(e);
    out.linear += type.mass * s.velocity[i];
    out.angular += type.mass * (s.position[i] - about).cross(s.velocity[i]) + type.inertia * s.angular_velocity[i];
  }
  return out;
}

void restore_momenta(const Topology& coarse, const State& before, const Topology& fine, int tube, State& s) {
  const int from = fine.tube_begin[tube], to = fine.tube_begin[tube + 1];
  const TubeType& type = fine.type_of(tube);
  Vector3 centre = Vector3::Zero();
  for (int e = from; e < to; ++e) centre += s.position[static_cast<std::size_t>(e)] / (to - from);
  Eigen::Matrix3d inertia = (to - from) * type.inertia * Eigen::Matrix3d::Identity();
  for (int e = from; e < to; ++e) {
    const Vector3 r = s.position[static_cast<std::size_t>(e)] - centre;
    inertia += type.mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  const TubeMomenta want = momenta(coarse, tube, before, centre), have = momenta(fine, tube, s, centre);
  const Vector3 drift = (want.linear - have.linear) / (type.mass * (to - from));
  const Vector3 spin = inertia.inverse() * (want.angular - have.angular);
  for (int e = from; e < to; ++e) {
    const auto i = static_cast<std::size_t>(e);
    s.velocity.add(i, drift + spin.cross(s.position[i] - centre));
    s.angular_velocity.add(i, spin);
  }
}

}  // namespace

Topology halved(const Topology& coarse, Splitting how) {
  Topology fine = coarse;
  for (int t = 0; t <= coarse.tubes(); ++t) fine.tube_begin[t] = begin_of(coarse, t, how);
  for (TubeType& type : fine.types) {
    type.element_length *= 0.5;
    type.mass *= 0.5;
    type.inertia *= 0.5;
  }
  return fine;
}

State halved(const Topology& coarse, const State& state, Splitting how) {
  ROPEWALK_EXPECTS(!coarse.part && static_cast<int>(state.size()) == coarse.elements());
  const Topology fine = halved(coarse, how);
  State out = placed(coarse, state, how);
  follow(coarse, state, how, out);
  for (int t = 0; how == Splitting::whole && t < coarse.tubes(); ++t) restore_momenta(coarse, state, fine, t, out);
  out.time = state.time;
  out.step = state.step;
  ROPEWALK_ENSURES(static_cast<int>(out.size()) == fine.elements());
  return out;
}

std::vector<int> heirs(const Topology& coarse, Splitting how) {
  std::vector<int> out;
  for (int t = 0; t < coarse.tubes(); ++t)
    for (int k = 0; k < coarse.length_of(t); ++k) out.push_back(begin_of(coarse, t, how) + 2 * k);
  return out;
}

}  // namespace ropewalk
