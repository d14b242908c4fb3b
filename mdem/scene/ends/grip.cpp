#include "scene/ends/grip.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/contract.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/end_moment.hpp"
#include "scene/scene.hpp"
#include "scene/scene_place.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/schedule_rows.hpp"

namespace ropewalk {
namespace {

using Is = GripAxis::Is;
using Matrix3 = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
// Matrices and vectors of some of the six components, without the heap.
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

Matrix3 cross(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// The velocity with which an arm that turns for `time` ps moves along its chord.
Matrix3 chord(const Vector3& turning, double time) {
  const double angle = turning.norm() * time;
  if (angle == 0) return cross(turning);
  return (Eigen::AngleAxisd(angle, turning.normalized()).toRotationMatrix() - Matrix3::Identity()) / time;
}

// Values of the components from `first` on that are driven like this.
template <class Of>
Vector3 driven(const std::array<Schedule, 6>& schedules, const std::array<GripAxis, 6>& axes, std::size_t first,
               Is is, const Of& of) {
  Vector3 out = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    if (axes[first + k].is == is) out[static_cast<Eigen::Index>(k)] = of(schedules[first + k]);
  return out;
}

}  // namespace

// A clamp and its elements now.
struct GripLoad::Body {
  std::size_t begin = 0, end = 0;  // of GripLoad::elements
  double mass = 0;
  Vector3 centre = Vector3::Zero(), axis = Vector3::Zero();
  Matrix3 held = Matrix3::Identity();  // the part of a velocity that the clamp holds
  Matrix6 inertia = Matrix6::Zero();   // of what it holds: half of q.inertia.q is the energy of the rigid motion q
  Vector6 momentum = Vector6::Zero();

  Matrix3 held_spin(const GripLoad& grip, const State& s, std::size_t k) const {
    if (!grip.spin_free && !grip.tilt_free) return Matrix3::Identity();
    const Vector3 t = axis_of(s.orientation[static_cast<std::size_t>(grip.elements[k])]);
    const Matrix3 spin = t * t.transpose();
    Matrix3 held_here = Matrix3::Zero();
    if (!grip.spin_free) held_here += spin;
    if (!grip.tilt_free) held_here += Matrix3::Identity() - spin;
    return held_here;
  }
};

// Adds up numbers of the clamps that are on several processes. `numbers_of` has them side by side in a clamp.
template <class Of>
void GripLoad::add_up(std::vector<Body>& all, int count, const Of& numbers_of) const {
  if (shared_.empty()) return;
  const auto n = static_cast<std::size_t>(count);
  std::vector<double> sums(n * shared_.size());
  const auto visit = [&](const auto& with) {
    std::size_t k = 0;
    for (Body& b : all) {
      while (k < shared_.size() && shared_[k] < clamp_[b.begin]) ++k;
      if (k < shared_.size() && shared_[k] == clamp_[b.begin]) with(numbers_of(b), &sums[n * k]);
    }
  };
  visit([&](const double* from, double* to) { std::copy_n(from, n, to); });
  others_->sum(sums.data(), sums.size());
  visit([&](double* to, const double* from) { std::copy_n(from, n, to); });
}

bool GripLoad::solves() const {
  return std::any_of(axes.begin(), axes.end(),
                     [](const GripAxis& a) { return a.is == Is::free || a.is == Is::loaded; });
}

std::vector<GripLoad::Body> GripLoad::bodies(const State& s) const {
  std::vector<Body> all;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    if (k == 0 || clamp_[k] != clamp_[k - 1]) {
      all.emplace_back();
      all.back().begin = k;
    }
    const auto i = static_cast<std::size_t>(elements[k]);
    Body& b = all.back();
    b.end = k + 1;
    b.mass += mass_[k];
    b.centre += mass_[k] * s.position[i];
    b.axis += axis_of(s.orientation[i]);
  }
  static_assert(offsetof(Body, axis) == offsetof(Body, mass) + 4 * sizeof(double), "seven numbers side by side");
  add_up(all, 7, [](Body& b) { return &b.mass; });
  for (Body& b : all) {
    b.centre /= b.mass;
    if (slide_free) b.held -= b.axis.normalized() * b.axis.normalized().transpose();
  }
  return all;
}

// And the momentum.
void GripLoad::find_inertia(const State& s, std::vector<Body>& all) const {
  for (Body& b : all)
    for (std::size_t k = b.begin; k < b.end; ++k) {
      const auto i = static_cast<std::size_t>(elements[k]);
      const Vector3 arm = s.position[i] - b.centre, p = mass_[k] * b.held * s.velocity[i];
      const Matrix3 lever = -cross(arm), by_turn = mass_[k] * b.held * lever,
                    spin = inertia_[k] * b.held_spin(*this, s, k);
      b.inertia.topLeftCorner<3, 3>() += mass_[k] * b.held;
      b.inertia.topRightCorner<3, 3>() += by_turn;
      b.inertia.bottomLeftCorner<3, 3>() += by_turn.transpose();
      b.inertia.bottomRightCorner<3, 3>() += lever.transpose() * by_turn + spin;
      b.momentum.head<3>() += p;
      b.momentum.tail<3>() += arm.cross(p) + spin * s.angular_velocity[i];
    }
  static_assert(offsetof(Body, momentum) == offsetof(Body, inertia) + 36 * sizeof(double), "side by side");
  add_up(all, 42, [](Body& b) { return b.inertia.data(); });
}

void GripLoad::keep(const std::vector<std::size_t>& places, const LoadProcesses& others) {
  std::vector<int> of(clamp_.empty() ? 0 : static_cast<std::size_t>(clamp_.back()) + 1), some;
  for (const int c : clamp_) ++of[static_cast<std::size_t>(c)];
  elements = chosen(elements, places);
  mass_ = chosen(mass_, places);
  inertia_ = chosen(inertia_, places);
  clamp_ = chosen(clamp_, places);
  for (std::size_t k = 0, next; k < clamp_.size(); k = next) {
    for (next = k + 1; next < clamp_.size() && clamp_[next] == clamp_[k];) ++next;
    if (static_cast<int>(next - k) < of[static_cast<std::size_t>(clamp_[k])]) some.push_back(clamp_[k]);
  }
  shared_ = others.join(some);
  std::sort(shared_.begin(), shared_.end());
  shared_.erase(std::unique(shared_.begin(), shared_.end()), shared_.end());
  others_ = &others;
}

namespace {

// Sets the components of q that are neither held nor moved, so that inertia.q = momentum in them.
void solve_free(const std::array<GripAxis, 6>& axes, const Matrix6& inertia, const Vector6& momentum, Vector6& q) {
  std::array<Eigen::Index, 6> index{};
  Eigen::Index n = 0;
  for (Eigen::Index k = 0; k < 6; ++k)
    if (axes[static_cast<std::size_t>(k)].is == Is::free || axes[static_cast<std::size_t>(k)].is == Is::loaded)
      index[static_cast<std::size_t>(n++)] = k;
  if (n == 0) return;
  const Vector6 left = momentum - inertia * q;
  Matrix a(n, n);
  Vector b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    b[i] = left[index[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = inertia(index[static_cast<std::size_t>(i)], index[static_cast<std::size_t>(j)]);
  }
  const Vector found = a.ldlt().solve(b);  // zero along components without inertia
  for (Eigen::Index i = 0; i < n; ++i) q[index[static_cast<std::size_t>(i)]] = found[i];
}

}  // namespace

void GripLoad::constrain(const Topology&, double time, double ahead, State& s) const {
  // The mean over the drift, so that a schedule is met exactly.
  const auto rate = [&](const Schedule& schedule) {
    return ahead > 0 ? (schedule.value(time + 2 * ahead) - schedule.value(time)) / (2 * ahead)
                     : schedule.rate(time);
  };
  Vector6 prescribed;
  prescribed << driven(schedules_, axes, 0, Is::moved, rate), driven(schedules_, axes, 3, Is::moved, rate);
  std::vector<Body> all = bodies(s);
  std::vector<Vector6> motion(all.size(), prescribed);
  if (solves()) {
    find_inertia(s, all);
    for (std::size_t n = 0; n < all.size(); ++n) {
      Body& b = all[n];
      solve_free(axes, b.inertia, b.momentum, motion[n]);
      const Vector3 turn = motion[n].tail<3>();
      b.momentum.setZero();  // now what the centripetal accelerations take from it in unit time
      for (std::size_t k = b.begin; k < b.end; ++k) {
        const Vector3 arm = s.position[static_cast<std::size_t>(elements[k])] - b.centre;
        const Vector3 force = mass_[k] * b.held * turn.cross(turn.cross(arm));
        b.momentum.head<3>() -= force;
        b.momentum.tail<3>() -= arm.cross(force);
      }
    }
    add_up(all, 6, [](Body& b) { return b.momentum.data(); });
    for (std::size_t n = 0; n < all.size(); ++n) {
      Vector6 faster = Vector6::Zero();  // acceleration of the free components
      solve_free(axes, all[n].inertia, all[n].momentum, faster);
      motion[n] += ahead * faster;
    }
  }
  for (std::size_t n = 0; n < all.size(); ++n) {
    const Body& b = all[n];
    const Vector3 velocity = motion[n].head<3>(), turning = motion[n].tail<3>();
    const Matrix3 sweep = chord(turning, 2 * ahead);
    for (std::size_t k = b.begin; k < b.end; ++k) {
      const auto i = static_cast<std::size_t>(elements[k]);
      const Vector3 rigid = velocity + sweep * (s.position[i] - b.centre);
      const Vector3 v = s.velocity[i], w = s.angular_velocity[i];
      s.velocity.set(i, v + b.held * (rigid - v));
      s.angular_velocity.set(i, w + b.held_spin(*this, s, k) * (turning - w));
    }
  }
}

// As the forces that give the clamp its acceleration as a rigid body, so that none acts between its elements.
void GripLoad::add_forces(const State& s, double time, std::vector<PointLoad>& out) const {
  if (std::none_of(axes.begin(), axes.end(), [](const GripAxis& a) { return a.is == Is::loaded; })) return;
  const auto now = [&](const Schedule& schedule) { return schedule.value(time); };
  Vector6 load;
  load << driven(schedules_, axes, 0, Is::loaded, now), driven(schedules_, axes, 3, Is::loaded, now);
  std::vector<Body> all = bodies(s);
  find_inertia(s, all);
  for (const Body& b : all) {
    Vector6 q = Vector6::Zero();
    solve_free(axes, b.inertia, load, q);
    for (std::size_t k = b.begin; k < b.end; ++k) {
      const auto i = static_cast<std::size_t>(elements[k]);
      const Vector3 arm = s.position[i] - b.centre;
      out.push_back({elements[k], mass_[k] * b.held * (q.head<3>() + q.tail<3>().cross(arm)),
                     inertia_[k] * b.held_spin(*this, s, k) * q.tail<3>()});
    }
  }
}

bool GripLoad::is_unfelt(std::size_t axis, const State& s) const {
  if (axes[axis].is != Is::loaded) return false;
  std::vector<Body> all = bodies(s);
  find_inertia(s, all);
  for (const Body& b : all) {
    Vector6 load = Vector6::Zero(), q = Vector6::Zero();
    load[static_cast<Eigen::Index>(axis)] = 1;
    solve_free(axes, b.inertia, load, q);
    if (std::fabs((b.inertia * q)[static_cast<Eigen::Index>(axis)] - 1) > 1e-6) return true;
  }
  return false;
}

GripLoad GripLoad::on_elements(std::vector<int> on, const Topology& topology, double free_length) const {
  GripLoad out = *this;
  out.elements = std::move(on);
  out.mass_.clear();
  out.inertia_.clear();
  out.clamp_.clear();
  double sound = 0;  // ps, that a wave needs from end to end
  for (const int e : out.elements) {
    const TubeType& type = topology.type_of_element(e);
    out.clamp_.push_back(each ? static_cast<int>(out.clamp_.size()) / depth : 0);
    out.mass_.push_back(type.mass);
    out.inertia_.push_back(type.inertia);
    const double tube = (topology.length_of(topology.tube_of(e)) - 1) * type.element_length;
    sound = std::max({sound, tube / std::sqrt(type.bond.stretch * type.element_length / type.mass),
                      tube / std::sqrt(type.bond.twist * type.element_length / type.inertia)});
  }
  for (std::size_t k = 0; k < axes.size(); ++k) {
    ROPEWALK_EXPECTS(!axes[k].strain || free_length > 0);
    std::vector<Schedule::Point> points = axes[k].points;
    for (Schedule::Point& p : points)
      if (axes[k].strain) p.value *= (end == upper_end ? free_length : -free_length) * (both ? 0.5 : 1);
    // A corner of a motion is a jump of the speed; a load has its own corners, as in [twist].
    const double usual = axes[k].is == Is::moved ? 2 * sound : 0;
    out.schedules_[k] = Schedule(points, smooth < 0 ? usual : smooth);
  }
  return out;
}

std::string GripLoad::needs_time() const {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k].is == Is::moved || !Schedule(axes[k].points).constant())
      return fmt::format("the schedule of grip.{} needs time", grip_axis_names[k]);
  }
  return "";
}

std::optional<LoadEffect> GripLoad::effect() const {
  LoadEffect out;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    LoadComponent& c = out.axes[k];
    c.is = axes[k].is;
    c.each = each;
    if (c.is != Is::moved && c.is != Is::loaded) continue;
    c.course = Schedule(schedules_[k].points());
    c.now = [schedule = schedules_[k]](double time) { return schedule.value(time); };
  }
  if (slide_free) out.axes[z].is = Is::free;
  if (each && spin_free) out.axes[about_z].is = Is::free;
  if (each && tilt_free) out.axes[3].is = out.axes[4].is = Is::free;
  out.by = each && depth == 1 ? LoadEffect::By::couple : LoadEffect::By::body;
  out.by_element = false;
  out.keeps_tilt = each ? out.axes[3].is_kept() || out.axes[4].is_kept() : !tilt_free;
  return out;
}

// A strain is positive where the clamp pulls, at either end.
GripLoad GripLoad::at_other_end() const {
  GripLoad out = *this;
  out.end = end == upper_end ? lower_end : upper_end;
  for (GripAxis& axis : out.axes)
    if (!axis.strain)
      for (Schedule::Point& p : axis.points) p.value = 0 - p.value;
  return out;
}

std::string GripLoad::words() const {
  std::string held, rest;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const GripAxis& a = axes[k];
    const bool turn = k >= 3;
    const std::string name = turn ? fmt::format("about {}", "xyz"[k - 3]) : std::string(grip_axis_names[k]);
    if (a.is == Is::held) held += (held.empty() ? "" : ", ") + name;
    if (a.is == Is::free) rest += fmt::format("; {} free", name);
    if (a.is != Is::moved && a.is != Is::loaded) continue;
    const double last = a.points.back().value;
    const double unit = a.is == Is::loaded ? units::nN_nm : turn ? units::degree : 1.0;
    const char* unit_name = a.strain             ? "of its length"
                            : a.is == Is::loaded ? (turn ? "nN nm" : "nN")
                            : turn               ? "deg"
                                                 : "nm";
    double most = 0;
    for (const Schedule::Point& p : a.points) most = std::max(most, std::fabs(p.value));
    rest += fmt::format("; {} {} {:.4g} {}", name, a.is == Is::loaded ? "loaded with" : "moved to", last / unit,
                        unit_name);
    if (most > std::fabs(last)) rest += fmt::format(" by way of {:.4g}", most / unit);
    if (a.points.size() > 1) rest += fmt::format(" in {:.4g} ps", a.points.back().time);
  }
  std::string text = fmt::format("{}, {}: ",
                                 both ? "grips at both ends, the lower one with the opposite motion and load"
                                 : end == upper_end ? "upper grip"
                                                    : "lower grip",
                                 each ? "a clamp for each tube" : "one disc");
  const auto is_held = [](const GripAxis& a) { return a.is == Is::held; };
  text += held.empty() ? "nothing held" : std::all_of(axes.begin(), axes.end(), is_held) ? "held" : held + " held";
  if (slide_free) rest += "; tubes slide";
  if (spin_free) rest += "; tubes spin";
  if (tilt_free) rest += "; tubes tilt";
  return text + rest;
}

double GripLoad::lasts() const {
  double last = 0;
  for (const GripAxis& a : axes)
    if (!a.points.empty()) last = std::max(last, a.points.back().time);
  return last;
}

// --- the table -------------------------------------------------------------------------------------------------

namespace {

// A course that a component of a clamp may follow.
struct Course {
  const char* key;
  double unit;
  const char* rate_key;
  bool rotation, load;
};
constexpr double rad = units::degree;
constexpr Course courses[] = {
    {"displacement_nm", 1, "rate_nm_per_ps", false, false},
    {"strain", 1, "rate_per_ps", false, false},
    {"force_nN", units::nN_nm, "rate_nN_per_ps", false, true},
    {"rotation_deg", rad, "rate_deg_per_ps", true, false},
    {"rotation_turns", 360 * rad, "rate_turns_per_ps", true, false},
    {"torque_nN_nm", units::nN_nm, "rate_nN_nm_per_ps", true, true},
};
constexpr double largest_value = 1e6;

std::string example_of(const Course& d) { return fmt::format("{{ {} = 1, {} = 0.01 }}", d.key, d.rate_key); }

// Goes from 0 at the start to each value in turn, at this speed; a value twice would be a hold without a length.
std::vector<Schedule::Point> at_rate(const TomlTable& t, const Course& d, const std::vector<double>& values) {
  const double rate = t.number(d.rate_key, Bounds::positive(largest_value));
  std::vector<Schedule::Point> points{{0, 0}};
  for (const double value : values) {
    const Schedule::Point last = points.back();
    if (value == last.value)
      throw t.error(d.key, fmt::format("has {} after {}: no time passes between them", value, last.value),
                    "write a hold as points in time: [[0, 0], [100, 1], [150, 1]]");
    points.push_back({last.time + std::fabs(value - last.value) / rate, value});
  }
  return points;
}

std::vector<Schedule::Point> in_time(const TomlTable& t, const Course& d) {
  const std::vector<Schedule::Point> points =
      points_in_time(t, d.key, Bounds::range(-largest_value, largest_value));
  if (!d.load && points.front().value != 0)
    throw t.error(d.key, fmt::format("begins at {}", points.front().value),
                  "begin with 0: it counts from where the elements are at the start");
  return points;
}

GripAxis read_axis(const TomlTable& t, const std::string& axis, bool rotation) {
  std::string names;
  const Course* found = nullptr;
  for (const Course& d : courses) {
    if (d.rotation != rotation) continue;
    names += (names.empty() ? "" : ", ") + std::string(d.key);
    if (!t.has(d.key)) continue;
    if (found) throw t.error(d.key, fmt::format("stands beside {}", found->key), "take one of the two");
    found = &d;
  }
  if (!found) {
    for (const std::string& key : t.keys()) {
      const std::string near = nearest_word(
          key, {courses[0].key, courses[1].key, courses[2].key, courses[3].key, courses[4].key, courses[5].key});
      if (!near.empty())
        throw t.error(key, fmt::format("is not for {}", axis), fmt::format("choose one of {}", names));
    }
    throw t.error("", "says nothing that the clamp follows", fmt::format("write one of {}", names));
  }
  const Course& d = *found;
  GripAxis out;
  out.is = d.load ? Is::loaded : Is::moved;
  out.strain = std::string(d.key) == "strain";
  if (out.strain && axis != "z") throw t.error(d.key, "is along the rope, z", "take displacement_nm");
  if (t.is_array(d.key) && t.has(d.rate_key)) {
    out.points = at_rate(t, d, t.list(d.key, Bounds::range(-largest_value, largest_value)));
  } else if (t.is_array(d.key)) {
    out.points = in_time(t, d);
  } else {
    const double value = t.number(d.key, Bounds::range(-largest_value, largest_value));
    if (t.has(d.rate_key)) {
      out.points = at_rate(t, d, {value});
    } else if (d.load) {
      out.points = {{0, value}};
    } else {
      throw t.error(
          d.key, "has no time to happen in",
          fmt::format("add {} = ..., or write points: {} = [[0, 0], [100, {}]]", d.rate_key, d.key, value));
    }
  }
  for (Schedule::Point& p : out.points) p.value *= d.unit;
  if (out.points.back().time > longest_time)
    throw t.error(d.key, fmt::format("takes {:.3g} ps", out.points.back().time), "go faster");
  return out;
}

KeyOf<GripLoad> axis_key(std::size_t axis, const char* standard_word, const std::string& meaning) {
  const std::string name = grip_axis_names[axis];
  return KeyOf<GripLoad>::custom(
             name, "", standard(fmt::format("\"{}\"", standard_word)), meaning,
             [=](const TomlTable& t, const Scene&, GripLoad& grip) {
               if (!t.has(name)) return;
               if (t.is_string(name)) {
                 grip.axes[axis] = {t.word(name, Words<Is>{{"held", Is::held}, {"free", Is::free}}), {}, false};
                 return;
               }
               const Course& example = courses[axis < 3 ? 0 : 4];
               grip.axes[axis] = read_axis(t.table(name, example_of(example)), name, axis >= 3);
             })
      .of_pace(SceneKey::Pace::course);
}

void check_grip(const TomlTable& t, const Scene&, GripLoad& grip) {
  const auto driven = [&](std::size_t axis) {
    return grip.axes[axis].is == Is::moved || grip.axes[axis].is == Is::loaded;
  };
  if (grip.slide_free && driven(GripLoad::z))
    throw t.error("z", "drives tubes that slide through the clamp", "set slide_free = false, or leave z out");
  if (grip.each && grip.spin_free && driven(GripLoad::about_z))
    throw t.error("about_z", "drives tubes that spin freely in their clamps",
                  "set spin_free = false, or leave about_z out");
}

const KeyTable<GripLoad>& table_of_grip() {
  using Key = KeyOf<GripLoad>;
  static const KeyTable<GripLoad> table = {
      "grip",
      "any number of these: a clamp on one end of the tubes; motions that are not named are held",
      {Key::custom(
           "end", "", required("\"upper\""),
           "\"lower\": holds the first elements; \"upper\": holds the last ones; \"both\": the keys describe the "
           "upper clamp, and the lower one has the opposite motion and load; a strain is the total of both",
           [](const TomlTable& t, const Scene&, GripLoad& grip) {
             const int word = t.word("end", Words<int>{{"lower", 0}, {"upper", 1}, {"both", 2}});
             grip.end = word == 0 ? lower_end : upper_end;
             grip.both = word == 2;
           }),
       Key::word("as", Words<bool>{{"disc", false}, {"each", true}}, &GripLoad::each, standard(),
                 "\"disc\": one rigid clamp; \"each\": a clamp for each tube, and each follows the keys below"),
       Key::integer("elements", 1, 1000, &GripLoad::depth, standard(),
                    "number of elements of each tube in the clamp")
           .that_counts_held(),
       axis_key(0, "held", "\"held\", \"free\", or what it follows: { displacement_nm = ... }, { force_nN = ... }"),
       axis_key(1, "held", "as for x"),
       axis_key(2, "held",
                "as for x, or { strain = ... }; a list is points [[ps, value], ...], or values reached one after "
                "another at rate_nm_per_ps, rate_per_ps or rate_nN_per_ps"),
       axis_key(
           3, "held",
           "rotation about the clamp's own centre: \"held\", \"free\", { rotation_deg = ... }, { rotation_turns "
           "= ... } or { torque_nN_nm = ... }, with rates as for z"),
       axis_key(4, "held", "as for about_x"), axis_key(5, "held", "as for about_x: it twists the rope"),
       Key::boolean("slide_free", &GripLoad::slide_free, standard(),
                    "tubes slide through the clamp along its axis"),
       Key::boolean("spin_free", &GripLoad::spin_free, standard(), "tubes turn about their own axes in the clamp"),
       Key::boolean("tilt_free", &GripLoad::tilt_free, standard(), "tubes tilt in the clamp"),
       Key::number("smooth_ps", unit::ps, Bounds::non_negative(longest_time), &GripLoad::smooth,
                   otherwise("10", "twice the travel of sound along the tubes for motions, 0 for loads"),
                   "rates change over this time, at most over half of the line between two points")
           .of_pace(SceneKey::Pace::time)},
      check_grip};
  return table;
}

// The keys that choose the tubes of a grip.
KeyTable<Selection> tubes_of_grip() {
  using Key = KeyOf<Selection>;
  return {"grip",
          "",
          {Key::custom(
              "tubes", "", standard("\"all\""), "tubes that the clamp holds: \"all\", or numbers from 0: [0, 3]",
              [](const TomlTable& t, const Scene& scene, Selection& on) { read_tube_selection(t, scene, on); })},
          {}};
}

// The keys of both, `tubes` behind `end`.
SceneTable grip_table() {
  SceneTable table = table_of_grip().doc();
  const SceneTable tubes = tubes_of_grip().doc();
  table.keys.insert(table.keys.begin() + 1, tubes.keys.begin(), tubes.keys.end());
  table.listed = true;
  return table;
}

}  // namespace

DriveKind grip_drive() {
  return {grip_table, [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            auto drive = std::make_shared<GripDrive>();
            drive->on = tubes_of_grip().read(t, scene);
            drive->load = table_of_grip().read(t, scene);
            return drive;
          }};
}

SceneTable GripDrive::table() const { return grip_table(); }

std::shared_ptr<const Drive> GripDrive::at_its_end() const {
  auto out = std::make_shared<GripDrive>(*this);
  for (GripAxis& axis : out->load.axes)
    if (axis.is == Is::loaded) axis.points = {{0, axis.points.back().value}};
  return out;
}

std::string GripDrive::words() const {
  constexpr std::size_t most = 12;
  if (on.all_tubes) return load.words();
  const std::vector<int>& all = on.tubes;
  const auto named = static_cast<std::ptrdiff_t>(std::min(most, all.size()));
  return load.words() + fmt::format("; on tube{} {}{}", all.size() > 1 ? "s" : "",
                                    fmt::join(all.begin(), all.begin() + named, ", "),
                                    all.size() > most ? fmt::format(" and {} more", all.size() - most) : "");
}

void GripDrive::add_loads(const Scene& scene, const Topology& topology, const Interaction&,
                          LoadsAndConstraints& loads) const {
  loads.add(at(load, scene, topology));
  if (load.both) loads.add(at(load.at_other_end(), scene, topology));
}

GripLoad GripDrive::at(const GripLoad& grip, const Scene& scene, const Topology& topology) const {
  std::vector<int> elements;
  double free = 0;
  const Topology strands = strands_of(topology);
  for (const int t : selected_tubes(scene, on, topology)) {
    // "all" means the tubes at this end of the rope. A tube named by its number is held at its own end, also inside
    // the rope.
    if (on.all_tubes && !(grip.end == lower_end ? topology.begins_strand(t) : topology.ends_strand(t))) continue;
    const int length = topology.length_of(t);
    free = std::max(free, free_length(scene, strands, strands.tube_of(topology.tube_begin[t])));
    const bool both = topology.begins_strand(t) && topology.ends_strand(t);
    if ((both ? 2 : 1) * load.depth > length)
      throw InputError(place_in(scene, "grip.elements"),
                       fmt::format("is {}, and tube {} has {}", load.depth, t, length),
                       "leave half of each tube to the other end");
    const int first = grip.end == lower_end ? 0 : length - load.depth;
    for (int e = 0; e < load.depth; ++e) elements.push_back(topology.tube_begin[t] + first + e);
  }
  return grip.on_elements(std::move(elements), topology, free);
}

// Elements that two grips hold, and loads that nothing feels. The first grip looks at all.
void GripDrive::refuse_start(const Scene& scene, const Topology& topology, const State& state,
                             const LoadsAndConstraints& loads) const {
  if (scene.drives_of<GripDrive>().front() != this) return;
  refuse_end_moment(scene, topology, loads, "grip.about_z");
  std::vector<int> held;
  for (const GripLoad* grip : loads.of<GripLoad>()) {
    for (const int e : grip->elements) {
      if (std::find(held.begin(), held.end(), e) == held.end()) continue;
      const int tube = topology.tube_of(e);
      throw InputError(place_in(scene, "grip"),
                       fmt::format("two grips hold element {} of tube {}", e - topology.tube_begin[tube], tube),
                       "give each its own end or its own tubes");
    }
    held.insert(held.end(), grip->elements.begin(), grip->elements.end());
    for (std::size_t axis = 0; axis < grip->axes.size(); ++axis)
      if (grip->is_unfelt(axis, state))
        throw InputError(place_in(scene, fmt::format("grip.{}", grip_axis_names[axis])),
                         "is a load that nothing in the clamp feels: the elements are free of it",
                         "set slide_free, spin_free or tilt_free to false");
  }
}

}  // namespace ropewalk
