#include "sim/statics/newton.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/contract.hpp"
#include "model/counter_random.hpp"
#include "model/error.hpp"
#include "sim/dynamics/step_limit.hpp"
#include "sim/statics/end_words.hpp"

namespace ropewalk {
namespace {

using Eigen::VectorXd;

constexpr int most_products = 400;         // products in one solution
constexpr int most_tries = 25;             // tries of one step
constexpr std::int64_t most_saddles = 30;  // couples of fixed direction have no potential: they may pump for ever
constexpr double nearly_free = 0.1;        // 1/ps: with a smaller shift only soft motions are held back
constexpr double fire_until = 0.05;        // eV/nm: smaller forces are those of contacts that have formed
constexpr long fire_steps = 300;           // after which Newton's method has a turn

VectorXd forces_of(const Simulation& s) {
  VectorXd f(6 * static_cast<Eigen::Index>(s.state().size()));
  for (std::size_t i = 0; i < s.state().size(); ++i)
    f.segment<6>(6 * static_cast<Eigen::Index>(i)) << s.forces().force[i], s.forces().torque[i];
  return f;
}

Vector3 across(const Vector3& turn, const Vector3& axis) { return turn - turn.dot(axis) * axis; }

Quaternion rotation_by(const Vector3& turn) {
  return Quaternion(Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()));
}

// A part of a step that was solved for.
struct Attempt {
  double scale = 1;
  double first = 0, end = 0,
         by_model = 0;  // eV: work of the force before it, after it, and after it by the tangent
  bool taken = false;
  double disagreement() const { return std::fabs(end - by_model) / std::fabs(first); }
};

double energy_of(const Simulation& s) { return s.forces().energy.potential() - s.account().work; }

}  // namespace

struct NewtonStatics::At {
  AllowedMotions allowed;
  VectorXd force, borne;  // that moves elements; that constraints bear
  double energy = 0;      // eV, potential less the work of the loads
  const BlockMatrix* k = nullptr;

  explicit At(const Simulation& s) : allowed(s), force(forces_of(s)), energy(energy_of(s)) {
    borne = force;
    allowed.project_force(force);
    borne -= force;
  }
};

NewtonStatics::NewtonStatics(Simulation& simulation, const NewtonOptions& options)
    : s_(simulation),
      options_(options),
      maker_(simulation),
      sections_(sections_of(simulation.topology(), simulation.state())) {
  // The rates are those of carbon tubes, whose chains have 20 to 42 rad/ps. Heavy and soft filaments are slower.
  constexpr double carbon = 20;
  const double chain = time_step_limit(simulation.topology(), simulation.interaction(), 0).chain_frequency,
               slower = std::min(1.0, chain / carbon);
  options_.first_rate *= slower;
  options_.least_rate *= slower;
  options_.slow *= slower;
}

NewtonStatics::Refusal NewtonStatics::refusal(const Simulation& s) {
  if (const std::string term = term_without_tangent(s); !term.empty())
    return {"does not go with " + term + ", whose forces have no tangent",
            "take " + term + " away, or take solver = \"fire\" or mode = \"dynamics\""};
  const AllowedMotions allowed(s);
  if (!allowed.keeps_momentum())
    return {"needs constraints that act on different elements",
            "hold each element by one [[grip]] or [[load]] alone"};
  const std::string motion = allowed.mechanism(load_forces(s.loads(), s.state()));
  if (motion.empty()) return {};
  return {"finds no state of rest: the load " + motion + ", and nothing holds it",
          "hold it, as by [[load]] of kind \"fix\" or [[grip]], or balance the load"};
}

// The largest of what is free.
void NewtonStatics::look(At& at) {
  out_.spinning = at.allowed.largest_spin(forces_of(s_));
  const double on_strand =
      std::fabs(at.allowed.force_on_period(at.force)) / static_cast<double>(s_.topology().strands());
  out_.largest_force = out_.relaxed.force = on_strand;
  out_.largest_torque = 0;
  for (int t = 0; t < s_.topology().tubes(); ++t)
    for (int e = s_.topology().tube_begin[t]; e < s_.topology().tube_begin[t + 1]; ++e) {
      const auto row = 6 * static_cast<Eigen::Index>(e);
      const double force = at.force.segment<3>(row).norm(), torque = at.force.segment<3>(row + 3).norm();
      out_.largest_force = std::max(out_.largest_force, force);
      out_.largest_torque = std::max(out_.largest_torque, torque);
      out_.relaxed.force = std::max({out_.relaxed.force, force, torque / s_.topology().type_of(t).radius});
    }
}

Solution NewtonStatics::solve(const At& at, double shift, const VectorXd& b, double tolerance, VectorXd& x) {
  const AllowedMotions& allowed = at.allowed;
  const Preconditioner chain(s_.topology(), s_.state(), sections_, *at.k, allowed.mass(), shift, allowed.held());
  const Operator a = [&](const VectorXd& v, VectorXd& y) {
    at.k->multiply(v, y);
    allowed.add_constraint_stiffness(at.borne, v, y);
    allowed.project_force(y);
    allowed.add_inertia(shift, v, y);
  };
  VectorXd stretch = allowed.stretch();  // the period would else be the softest by far
  double stiffness = 0;                  // against it
  if (stretch.size() > 0) {
    allowed.project_motion(stretch);
    VectorXd resistance;
    a(stretch, resistance);
    stiffness = std::max(std::fabs(stretch.dot(resistance)), 1e-9);
  }
  const Precondition m = [&](const VectorXd& r, VectorXd& z) {
    if (stretch.size() == 0) {
      chain.solve(r, z);
      allowed.project_motion(z);
      return;
    }
    chain.solve(allowed.without_period(r), z);
    allowed.let_period_stay(z);
    allowed.project_motion(z);
    z += (stretch.dot(r) / stiffness) * stretch;
  };
  const Solution found = out_.symmetric ? conjugate_gradients(a, m, b, tolerance, most_products, x)
                                        : gmres(a, m, b, tolerance, most_products, x);
  out_.products += found.iterations;
  return found;
}

// How each section moves as one body: along `shift`, and by `angle` about an axis through its centre.
struct NewtonStatics::SectionMove {
  Vector3 centre = Vector3::Zero(), axis = Vector3::Zero(), shift = Vector3::Zero();
  double angle = 0;
};

std::vector<NewtonStatics::SectionMove> NewtonStatics::section_moves(const VectorXd& d) const {
  const State& s = s_.state();
  std::vector<SectionMove> all(static_cast<std::size_t>(sections_.count));
  std::vector<double> elements(all.size(), 0), arms(all.size(), 0);
  for (std::size_t i = 0; i < s.size() && !all.empty(); ++i) {
    const auto k = static_cast<std::size_t>(sections_.of[i]);
    all[k].centre += s.position[i];
    all[k].shift += d.segment<3>(6 * static_cast<Eigen::Index>(i));
    all[k].axis += axis_of(s.orientation[i]);
    elements[k] += 1;
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k].centre /= elements[k];
    all[k].shift /= elements[k];
    all[k].axis.normalize();
  }
  for (std::size_t i = 0; i < s.size() && !all.empty(); ++i) {
    const auto k = static_cast<std::size_t>(sections_.of[i]);
    const Vector3 turn = all[k].axis.cross(Vector3(s.position[i] - all[k].centre));
    all[k].angle += turn.dot(Vector3(d.segment<3>(6 * static_cast<Eigen::Index>(i))) - all[k].shift);
    arms[k] += turn.squaredNorm();
  }
  for (std::size_t k = 0; k < all.size(); ++k) all[k].angle = arms[k] > 0 ? all[k].angle / arms[k] : 0;
  return all;
}

// Turns of whole sections count by their angle alone: they change nothing between tubes. A tube that touches no
// other one may go far, as long as it does not turn much: what turns by t along straight lines becomes longer by
// t^2/2. Where a clamp leads, all of its turn is borne by the bonds beside it, and counts.
double NewtonStatics::farthest(const VectorXd& d, bool led_by_clamps) const {
  constexpr double of_turns = 3, arm_of_sections = 0.5;
  const bool alone = !s_.interaction().law || s_.topology().tubes() == 1;
  const std::vector<SectionMove> sections = led_by_clamps ? std::vector<SectionMove>{} : section_moves(d);
  double most = 0;
  for (const SectionMove& section : sections) most = std::max(most, arm_of_sections * std::fabs(section.angle));
  for (int t = 0; t < s_.topology().tubes(); ++t)
    for (int e = s_.topology().tube_begin[t]; e < s_.topology().tube_begin[t + 1]; ++e) {
      const auto row = 6 * static_cast<Eigen::Index>(e);
      const auto i = static_cast<std::size_t>(e);
      Vector3 move = d.segment<3>(row), turn = d.segment<3>(row + 3);
      if (!sections.empty()) {
        const SectionMove& section = sections[static_cast<std::size_t>(sections_.of[i])];
        const Vector3 angle = section.angle * section.axis;
        move -= angle.cross(Vector3(s_.state().position[i] - section.centre));
        turn = across(turn - angle, axis_of(s_.state().orientation[i]));
      }
      const double by_turn = s_.topology().type_of(t).radius * turn.norm();
      most = std::max(most, alone ? of_turns * by_turn : std::max(by_turn, move.norm()));
    }
  return most;
}

// A section of a rope that turns about its axis goes along the arc and not along its tangent, which would make it
// wider, and takes with it what its elements do besides: each turns about its own axis, then that axis tilts. Both
// in one rotation would shear the tubes by half of their product. `onward` becomes the direction at the end of the
// way.
VectorXd NewtonStatics::on_arcs(const VectorXd& d, VectorXd& onward) const {
  onward = d;
  if (sections_.count == 0) return d;
  const std::vector<SectionMove> sections = section_moves(d);
  const State& s = s_.state();
  VectorXd out(d.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    const SectionMove& section = sections[static_cast<std::size_t>(sections_.of[i])];
    const Vector3 angle = section.angle * section.axis, arm = s.position[i] - section.centre,
                  move = Vector3(d.segment<3>(row)) - section.shift - angle.cross(arm),
                  t = axis_of(s.orientation[i]), own = Vector3(d.segment<3>(row + 3)) - angle,
                  tilt = across(own, t);
    const double spin = own.dot(t);
    const Quaternion q(Eigen::AngleAxisd(section.angle, section.axis)), tilts = rotation_by(tilt);
    const Eigen::AngleAxisd whole(q * tilts * rotation_by(spin * t));
    out.segment<3>(row) = section.shift + q * (arm + move) - arm;
    out.segment<3>(row + 3) = whole.angle() * whole.axis();
    onward.segment<3>(row) = section.shift + q * (angle.cross(Vector3(arm + move)) + move);
    onward.segment<3>(row + 3) = angle + q * (tilt + spin * (tilts * t));
  }
  return out;
}

bool NewtonStatics::move(const VectorXd& d, double passes) {
  const VectorXd along = on_arcs(d, onward_);
  Vec3Array linear(s_.state().size()), angular(s_.state().size());
  for (std::size_t i = 0; i < s_.state().size(); ++i) {
    const auto row = 6 * static_cast<Eigen::Index>(i);
    linear.set(i, along.segment<3>(row));
    angular.set(i, along.segment<3>(row + 3));
  }
  s_.displace(linear, angular, passes);
  return std::isfinite(s_.forces().energy.potential()) && s_.forces().slipping_bond < 0;
}

// Conjugate gradients for (K + s M) x = r, r random with unit variance in every motion, meet a motion whose
// stiffness is below -s if there is one.
std::optional<VectorXd> NewtonStatics::falling_motion(const At& at) {
  const AllowedMotions& allowed = at.allowed;
  VectorXd r(allowed.mass().size()), x;
  for (Eigen::Index k = 0; k < r.size(); k += 2) {
    const auto bits = philox({static_cast<std::uint32_t>(k), 7, 0, 0}, 1);
    const auto pair = normal_pair(bits[0], bits[1]);
    r[k] = pair[0];
    r[k + 1] = pair[1];
  }
  r = r.cwiseProduct(allowed.mass().cwiseSqrt()).eval();
  allowed.project_force(r);
  const Solution found = solve(at, options_.slow * options_.slow, r, 1e-3, x);
  if (found.falls) return found.motion;
  return std::nullopt;
}

// Work along d of what NewtonOptions::loads_to_come adds to the loads; 0 where none are known.
double NewtonStatics::work_to_come(const At& at, const VectorXd& d) const {
  const double passes = options_.loads_to_come - s_.time();
  if (!(passes > 0)) return 0;
  State then = s_.state();
  then.time += passes;
  VectorXd of_led;
  at.k->multiply(led(passes), of_led);
  VectorXd added = load_forces(s_.loads(), then) - load_forces(s_.loads(), s_.state()) - of_led;
  at.allowed.project_force(added);
  return added.dot(d);
}

// To the side where the energy falls farther. A state that is its own mirror image has none.
bool NewtonStatics::push_along(const At& at, const VectorXd& motion) {
  constexpr double alike = 0.5;  // part of the fall: the motion is not exactly that of steepest descent
  const VectorXd d = motion * (0.1 * s_.topology().largest_radius() / farthest(motion));
  const double to_come = work_to_come(at, d);
  const Simulation before = s_;
  std::optional<Simulation> best;
  for (const double sign : {1.0, -1.0}) {
    s_ = before;
    if (!move(sign * d)) continue;
    const double further = best ? energy_of(*best) - energy_of(s_) : 0;
    const bool same = best && std::fabs(further) < alike * std::fabs(at.energy - energy_of(s_));
    if (!best || (same && to_come != 0 ? to_come < 0 : further > 0)) best = s_;
  }
  s_ = best ? *best : before;
  return best.has_value();
}

// How constraints lead their elements in the next `passes` ps.
VectorXd NewtonStatics::led(double passes) const {
  State way = s_.state();
  way.velocity.set_to_zero();
  way.angular_velocity.set_to_zero();
  constrain(s_.topology(), s_.loads(), way.time, 0.5 * passes, way);
  VectorXd out(6 * static_cast<Eigen::Index>(way.size()));
  for (std::size_t i = 0; i < way.size(); ++i)
    out.segment<6>(6 * static_cast<Eigen::Index>(i)) << passes * way.velocity[i], passes * way.angular_velocity[i];
  return out;
}

// The rest of the rope follows by (K + s M) d = f + change of the loads - K u, where constraints lead by u.
bool NewtonStatics::follow_once(const At& at, double until) {
  constexpr double least_shift = 0.01, most_shift = 100;  // shift of the root, 1/ps
  double passes = until - s_.time();
  const VectorXd loads = load_forces(s_.loads(), s_.state());
  for (int tries = 0; tries < most_tries; ++tries) {
    VectorXd d = led(passes);
    if (d.isZero(0)) return move(d, passes);
    if (const double far = farthest(d, true); far > options_.farthest) {
      passes *= 0.9 * options_.farthest / far;
      continue;
    }
    State then = s_.state();
    then.time += passes;
    VectorXd b = load_forces(s_.loads(), then) - loads, resistance, follows;
    at.k->multiply(d, resistance);
    b -= resistance;
    at.allowed.project_force(b);
    b += at.force;
    for (double rate = least_shift; rate < most_shift; rate *= 3)
      if (!solve(at, rate * rate, b, 0.01, follows).falls) break;
    d += follows;
    const double far = farthest(d, true);
    const Simulation before = s_;
    if (far < 2 * options_.farthest && move(d, passes)) return true;
    s_ = before;
    passes *= far < 2 * options_.farthest ? 0.5 : options_.farthest / far;
  }
  return false;
}

Statics NewtonStatics::come_near_rest(const std::function<bool(long)>& progress) {
  constexpr long most_steps = 30;
  roughly_ = true;
  const Statics out = relax({fire_until, 1}, most_steps, progress);
  roughly_ = false;
  return out;
}

Statics NewtonStatics::follow(double until, const RelaxGoal& goal, const std::function<bool(long)>& progress) {
  Statics out;
  out.end = Statics::End::at_rest;
  while (s_.time() < until) {
    if (!progress(0)) return out.end = Statics::End::interrupted, out;
    s_.relaxation_with(goal);
    At at(s_);
    look(at);
    at.k = &maker_.make(s_);
    out_.symmetric = at.k->symmetric();
    if (!follow_once(at, until)) return out.end = Statics::End::refused, out;
    if (s_.time() < until && come_near_rest(progress).end == Statics::End::interrupted)
      return out.end = Statics::End::interrupted, out;
  }
  return out;
}

Statics NewtonStatics::relax(const RelaxGoal& goal, long max_steps, const std::function<bool(long)>& progress) {
  ROPEWALK_EXPECTS(goal.force > 0 && goal.energy > 0 && max_steps >= 0);
  constexpr double least_part = 1e-3;  // this part of the contact energy stands for that of bonds that hardly bear
  NewtonPace* pace = &s_.relaxation_with(goal);
  out_ = {};
  const bool by_fire = options_.fire && !is_slice();
  const bool rested = s_.last_rest().step == s_.step_count();
  if (pace->rate == 0) {
    const bool near = roughly_ || options_.near;
    pace->newton = rested || near || !by_fire;
    pace->rate = rested ? options_.least_rate : near ? nearly_free : options_.first_rate;
  }
  const auto done = [&] { return static_cast<long>(s_.step_count() - (s_.relaxation_began())); };
  const auto end_by = [&](Statics::End why) {
    out_.end = why;
    if (roughly_)
      s_.end_relaxation();
    else if (why != Statics::End::interrupted)
      s_.rest_after(out_.relaxed);
    return out_;
  };
  int overloaded = 0;  // steps
  for (;;) {
    at_newton_ = pace->newton;
    if (!pace->newton) {
      const long until = std::min(max_steps, (done() / fire_steps + 1) * fire_steps);
      if (!s_.relax_by_fire(std::max(fire_until, goal.force), until, progress))
        return end_by(Statics::End::interrupted);
      pace = &s_.relaxation_with(goal);
      pace->newton = true;
      pace->rate = options_.first_rate;
      at_newton_ = true;
    }
    At at(s_);
    look(at);
    const BlockMatrix& k = maker_.make(s_);
    at.k = &k;
    out_.symmetric = k.symmetric();
    const double bonds =
        std::max({s_.forces().energy.bonds(), least_part * std::fabs(s_.forces().energy.vdw), 1e-6});
    const double enough = 0.25 * goal.energy * goal.energy * bonds;
    bool moved_on = false;
    for (int tries = 0; tries < most_tries && !moved_on; ++tries) {
      VectorXd d;
      const double shift = pace->rate * pace->rate;
      const double tolerance = std::min(0.1, std::max(1e-3, 0.03 * std::sqrt(out_.relaxed.force)));
      const Solution found = solve(at, shift, at.force, tolerance, d);
      if (found.falls) {
        pace->falling = std::max(pace->falling, pace->rate);
        pace->rate = std::max(1.5 * pace->rate, 0.01);
        continue;
      }
      const double gain = at.force.dot(d);
      out_.relaxed.above = 0.5 * gain;
      out_.relaxed.error = 2 * std::sqrt(std::max(0.0, out_.relaxed.above) / bonds);
      const bool free = roughly_ || pace->rate <= 3.1 * options_.least_rate ||
                        (pace->rate < nearly_free && out_.relaxed.above < 0.01 * enough);
      if (out_.relaxed.force < goal.force && out_.relaxed.above <= enough && free) {
        out_.relaxed.at_rest = true;
        if (roughly_) return end_by(Statics::End::at_rest);
        if (rested && s_.last_rest().step == s_.step_count()) {
          out_.relaxed.saddles = s_.last_rest().saddles;
          return end_by(Statics::End::at_rest);
        }
        out_.relaxed.saddles = pace->saddles;
        // Under loads without a potential the symmetric part does not tell what grows.
        const std::optional<VectorXd> motion = out_.symmetric ? falling_motion(at) : std::nullopt;
        if (!motion) return end_by(Statics::End::at_rest);
        const bool came_back = !is_slice() && pace->saddles > 0 && !(at.energy < pace->saddle_energy - enough);
        if (came_back) --out_.relaxed.saddles;
        if (came_back || pace->saddles == most_saddles || done() >= max_steps || !push_along(at, *motion)) {
          out_.falls = true;
          return end_by(Statics::End::at_rest);
        }
        pace = &s_.relaxation_with(goal);
        ++pace->saddles;
        pace->saddle_energy = at.energy;
        pace->rate = 1;
        pace->falling = 0;
        out_.relaxed.at_rest = false;
        moved_on = true;
        break;
      }
      if (done() >= max_steps || out_.newton_steps >= options_.most) return end_by(Statics::End::out_of_steps);
      if (tries == 0 && !progress(done())) return end_by(Statics::End::interrupted);
      const Simulation before = s_;
      const auto attempt = [&](double scale) {
        Attempt out;
        out.scale = scale;
        const bool fine = move(scale * d);
        VectorXd left = forces_of(s_);
        AllowedMotions(s_).project_force(left);
        out.end = left.dot(onward_);
        out.first = scale * gain;
        // The energy of a slice is known by the work of its forces alone: energies count the images too.
        const double change = is_slice() ? -0.5 * (out.first + out.end) : energy_of(s_) - at.energy,
                     noise = 1e-10 * std::fabs(at.energy) + 1e-12;
        out.by_model = scale * (shift * scale * d.dot(at.allowed.mass().cwiseProduct(d)) + (1 - scale) * gain);
        out.taken = fine && change < -1e-4 * out.first + noise && out.end > -1.5 * std::fabs(out.first) - 1e-9;
        return out;
      };
      const double far = farthest(d);
      const Attempt step = attempt(far > options_.farthest ? options_.farthest / far : 1.0);
      if (!step.taken) {
        ++out_.refused;
        s_ = before;
        pace = &s_.relaxation_with(goal);
        pace->rate = std::max(2 * pace->rate, 0.02);
        continue;
      }
      moved_on = true;
      ++out_.newton_steps;
      pace = &s_.relaxation_with(goal);
      // What is left of forces at rest is rounding, which no model foresees.
      if ((step.disagreement() < 0.3 && step.scale > 0.3) || out_.relaxed.force < 1e-3 * goal.force)
        pace->rate = std::max(options_.least_rate, pace->rate / 3);
      else if (step.end - step.by_model < -0.7 * std::fabs(step.first))
        pace->rate *= 2;
      if (pace->falling > 0 && pace->rate < 1.3 * pace->falling) {
        pace->rate = 1.3 * pace->falling;
        pace->falling *= 0.5;
      }
    }
    overloaded = overloaded_bond(s_).empty() ? 0 : overloaded + 1;
    if (options_.most_overloaded > 0 && overloaded >= options_.most_overloaded)
      return end_by(Statics::End::out_of_steps);
    if (moved_on) continue;
    if (roughly_ || !by_fire || done() >= max_steps) return end_by(Statics::End::refused);
    pace->newton = false;
  }
}

}  // namespace ropewalk
