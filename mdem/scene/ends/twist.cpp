#include "scene/ends/twist.hpp"

#include <fmt/format.h>

#include "model/error.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/end_moment.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "scene/scene_place.hpp"

namespace ropewalk {
namespace {

constexpr const char* rate_key = "rate_nN_nm_per_ps";

const Words<TwistLoad::Application>& words_of_application() {
  using A = TwistLoad::Application;
  static const Words<A> words = {{"couple", A::couple},
                                 {"follower", A::follower},
                                 {"conservative", A::conservative},
                                 {"tangential", A::tangential}};
  return words;
}

void check_twist(const TomlTable& t, const Scene&, TwistLoad& twist) {
  if (twist.ramp_time() > longest_time)
    throw t.error(rate_key, fmt::format("makes a ramp of {:.3g} ps", twist.ramp_time()), "ramp faster");
  if (twist.unload_time() > longest_time)
    throw t.error("unload_rate_nN_nm_per_ps", fmt::format("takes {:.3g} ps", twist.unload_time()), "unload faster");
  if (twist.unloaded > 0 && twist.unload_rate == 0)
    throw t.error("unloaded_ps", "follows upon the unloading, and unload_rate_nN_nm_per_ps is 0", "give a rate");
}

const KeyTable<TwistLoad>& twist_table() {
  using Key = KeyOf<TwistLoad>;
  using T = TwistLoad;
  static const Words<bool> grips = {{"free", true}, {"held", false}};
  static const KeyTable<T> table = {
      "twist",
      "the grips (first and last element of every tube) are twisted about z, + at the upper end",
      {Key::number("moment_nN_nm", unit::nN_nm, Bounds::positive(1e6), &T::moment, required("35"),
                   "moment at the end of the ramp"),
       Key::number(rate_key, {"nN nm/ps", units::nN_nm}, Bounds::non_negative(1e6), &T::rate, required("1"),
                   "rate of the ramp; 0: the moment acts at once")
           .of_pace(SceneKey::Pace::rate),
       Key::number("hold_ps", unit::ps, Bounds::non_negative(longest_time), &T::hold, standard(),
                   "time under the full moment, after the ramp")
           .of_pace(SceneKey::Pace::time),
       Key::number("unload_rate_nN_nm_per_ps", {"nN nm/ps", units::nN_nm}, Bounds::non_negative(1e6),
                   &T::unload_rate, standard(),
                   "rate at which the moment is taken away after the hold; 0: it stays")
           .of_pace(SceneKey::Pace::rate),
       Key::number("unloaded_ps", unit::ps, Bounds::non_negative(longest_time), &T::unloaded, standard(),
                   "time without a moment, at the end")
           .of_pace(SceneKey::Pace::time),
       Key::word("hand", Words<bool>{{"right", false}, {"left", true}}, &T::left_handed, standard(),
                 "\"left\": the moment at the upper end turns the other way"),
       Key::word("reading", Words<T::Reading>{{"per-tube", T::Reading::per_tube}, {"total", T::Reading::total}},
                 &T::reading, standard(), "the moment is that of each grip element, or of all: \"total\""),
       Key::word("application", words_of_application(), &T::application, standard(),
                 "a couple on each grip element: \"couple\" about z, \"follower\" about the tube, \"conservative\" "
                 "with a "
                 "potential; or \"tangential\" forces about the rope's axis"),
       Key::word("lateral", grips, &T::lateral_free, standard(),
                 "\"held\": the centre of mass of a grip stays on the axis"),
       Key::word("axial", grips, &T::axial_free, standard(), "\"held\": grip elements keep their z"),
       Key::boolean("geometric_only", &T::geometric_only, standard(),
                    "true: the tubes' own twist is relaxed at each increment"),
       Key::number("increment_ps", unit::ps, Bounds::positive(longest_time), &T::increment, standard(),
                   "time between such relaxations")},
      check_twist};
  return table;
}

const char* applied_by(TwistLoad::Application application) {
  switch (application) {
    case TwistLoad::Application::couple:
      return "couples of fixed direction";
    case TwistLoad::Application::follower:
      return "couples that follow the tubes";
    case TwistLoad::Application::conservative:
      return "couples with a potential";
    case TwistLoad::Application::tangential:
      return "tangential forces";
  }
  return "";
}

Vector3 direction_of_couple(TwistLoad::Application application, const Vector3& axis) {
  switch (application) {
    case TwistLoad::Application::follower:
      return axis;
    case TwistLoad::Application::conservative:
      return (Vector3::UnitZ() + axis) / (1 + axis.z());
    default:
      return Vector3::UnitZ();
  }
}

}  // namespace

// --- the drive -------------------------------------------------------------------------------------------------

DriveKind twist_drive() {
  return {[] { return twist_table().doc(); },
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            auto drive = std::make_shared<TwistDrive>();
            drive->load = twist_table().read(t, scene);
            return drive;
          }};
}

SceneTable TwistDrive::table() const { return twist_table().doc(); }

std::string TwistDrive::words() const {
  return fmt::format(
      "twist{}: {:.4g} nN nm {} by {} on the grips, {}; grips {} along the axis, {} sideways{}",
      load.left_handed ? ", left-handed" : "", load.moment / units::nN_nm,
      load.reading == TwistLoad::Reading::per_tube ? "per tube" : "in total", applied_by(load.application),
      held ? "held"
           : fmt::format("ramped in {:.4g} ps, held for {:.4g} ps{}", load.ramp_time(), load.hold,
                         load.unload_rate > 0 ? fmt::format(", taken away in {:.4g} ps", load.unload_time()) : ""),
      load.axial_free ? "free" : "held", load.lateral_free ? "free" : "held",
      load.geometric_only ? "; spins relaxed (geometric twist only)" : "");
}

void TwistDrive::refuse(const TomlTable& top, const Scene& scene) const {
  if (scene.has_ends(Ends::clamped))
    throw top.error(
        "twist", "stands beside [[grip]], and both say what the ends do",
        "write the moment into a grip: as = \"each\", about_z = { torque_nN_nm = 35, rate_nN_nm_per_ps = 1 }");
  if (scene.run.mode == RunOptions::Mode::relax) refuse_in_relaxation(top, scene);
  if (load.geometric_only && scene.bath())
    throw top.table("twist").error("geometric_only",
                                   "does not go with [thermostat]: the bath turns the spins that it relaxes",
                                   "take one of the two away");
}

// The moment of its end is held.
void TwistDrive::refuse_in_relaxation(const TomlTable& top, const Scene& scene) const {
  const TomlTable t = top.table("twist");
  if (scene.run.solver == RunOptions::Solver::fire)
    throw top.error("twist",
                    "does not go with run.solver = \"fire\", which does not come to rest under a held moment",
                    "take solver = \"auto\" or \"newton\", or mode = \"dynamics\"");
  if (load.unload_rate > 0 && scene.statics.steps == 0)
    throw t.error("unload_rate_nN_nm_per_ps", "leaves no moment in the end, and run.mode is \"relax\"",
                  "take it away, write [statics] steps = 20, or take mode = \"dynamics\"");
  if (load.geometric_only)
    throw t.error("geometric_only", "relaxes spins from time to time, and run.mode is \"relax\"",
                  "take it away, or take mode = \"dynamics\"");
}

std::shared_ptr<const Drive> TwistDrive::at_its_end() const {
  auto out = std::make_shared<TwistDrive>(*this);
  out->held = true;
  out->load.rate = out->load.hold = 0;
  return out;
}

std::string TwistDrive::needs_time() const {
  if (held) return "";
  return "the moment of [twist] is ramped, and where a rope ends depends on the way";
}

void TwistDrive::refuse_start(const Scene& scene, const Topology& topology, const State&,
                              const LoadsAndConstraints& loads) const {
  if (load.application == TwistLoad::Application::tangential && topology.tubes() == 1)
    throw InputError(place_in(scene, "twist.application"),
                     "tangential forces about the axis of one tube have no arm", "take \"couple\"");
  for (int t = 0; t < topology.tubes(); ++t)
    if (topology.length_of(t) < 2)
      throw InputError(place_in(scene, "twist"), fmt::format("tube {} has one element and no two grips", t),
                       "take tubes of two elements or more");
  refuse_end_moment(scene, topology, loads, "twist.moment_nN_nm");
}

// --- the load --------------------------------------------------------------------------------------------------

TwistLoad TwistLoad::on_grip(std::vector<int> grip, double sign_there) const {
  TwistLoad there = *this;
  there.elements = std::move(grip);
  there.sign = sign_there;
  return there;
}

std::optional<LoadEffect> TwistLoad::effect() const {
  const double ramp = ramp_time(), held = ramp + hold, to = sign * moment;
  std::vector<Schedule::Point> points;
  const auto add = [&](double time, double value) {
    if (points.empty() || time > points.back().time) points.push_back({time, value});
  };
  if (ramp > 0) add(0, 0);
  add(ramp, to);
  if (unload_rate > 0) {
    add(held, to);
    add(held + unload_time(), 0);
  }
  LoadEffect out;
  LoadComponent& turn = out.axes[LoadEffect::about_z];
  turn =
      LoadComponent::follows(LoadComponent::Is::loaded, Schedule(std::move(points)), reading == Reading::per_tube);
  turn.now = [load = *this](double time) {
    return load.sign > 0 ? load.moment_at(time) : 0 - load.moment_at(time);
  };
  if (!lateral_free) out.axes[0] = out.axes[1] = LoadComponent::held(false);
  if (!axial_free) out.axes[LoadEffect::z] = LoadComponent::held();
  using By = LoadEffect::By;
  out.by = application == Application::couple       ? By::couple
           : application == Application::tangential ? By::tangential
                                                    : By::turning_couple;
  out.relaxes_spins = geometric_only;
  return out;
}

void TwistLoad::keep(const std::vector<std::size_t>& places, const LoadProcesses& others) {
  const bool some = !places.empty() && places.size() < elements.size();
  all_ = count_of_all();
  others_ = others.join(some ? std::vector<int>{1} : std::vector<int>{}).empty() ? nullptr : &others;
  elements = chosen(elements, places);
}

// Tangential forces about the centre of the grip. They are proportional to the arm, and their moments add up to
// `whole`.
void TwistLoad::add_tangential(const State& state, double whole, std::vector<PointLoad>& out) const {
  std::array<double, 3> sums{};
  for (const int e : elements)
    for (std::size_t k = 0; k < 3; ++k)
      sums[k] += state.position[static_cast<std::size_t>(e)][static_cast<Eigen::Index>(k)];
  add_up(sums);
  const Vector3 centre = Vector3(sums[0], sums[1], sums[2]) / count_of_all();
  std::array<double, 1> arms2{};
  for (const int e : elements) {
    const Vector3 arm = state.position[static_cast<std::size_t>(e)] - centre;
    arms2[0] += arm.x() * arm.x() + arm.y() * arm.y();
  }
  add_up(arms2);
  if (arms2[0] <= 0) return;
  for (const int e : elements) {
    const Vector3 arm = state.position[static_cast<std::size_t>(e)] - centre;
    out.push_back({e, whole / arms2[0] * Vector3(-arm.y(), arm.x(), 0), Vector3::Zero()});
  }
}

void TwistLoad::add_forces(const State& state, double time, std::vector<PointLoad>& out) const {
  const double now = sign * moment_at(time), count = count_of_all();
  if (application == Application::tangential) {
    add_tangential(state, reading == Reading::per_tube ? now * count : now, out);
    return;
  }
  const double each = reading == Reading::per_tube ? now : now / count;
  for (const int e : elements) {
    const Vector3 axis = axis_of(state.orientation[static_cast<std::size_t>(e)]);
    out.push_back({e, Vector3::Zero(), each * direction_of_couple(application, axis)});
  }
}

// Taking the velocity of the centre of mass from every element does no work on the others; a mean of another weight
// would.
void TwistLoad::constrain(const Topology& topology, double, double, State& state) const {
  if (lateral_free && axial_free) return;
  Vector3 mean = Vector3::Zero();
  if (!lateral_free) {
    std::array<double, 3> sums{};  // sums of mass and momentum
    for (const int e : elements) {
      const double m = topology.type_of_element(e).mass;
      const Vector3 v = state.velocity[static_cast<std::size_t>(e)];
      sums[0] += m;
      sums[1] += m * v.x();
      sums[2] += m * v.y();
    }
    add_up(sums);
    mean = Vector3(sums[1], sums[2], 0) / sums[0];
  }
  for (const int e : elements) {
    const auto i = static_cast<std::size_t>(e);
    // Held sideways means that the rope's end stays on its axis while the tubes in it may turn about it.
    state.velocity.x[i] -= mean.x();
    state.velocity.y[i] -= mean.y();
    if (!axial_free) state.velocity.z[i] = 0;
  }
}

void add_twist(const TwistLoad& twist, const Topology& topology, LoadsAndConstraints& loads) {
  std::vector<int> lower, upper;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (topology.begins_strand(t)) lower.push_back(topology.tube_begin[t]);
    if (topology.ends_strand(t)) upper.push_back(topology.tube_begin[t + 1] - 1);
  }
  loads.add(twist.on_grip(upper, twist.hand()));
  loads.add(twist.on_grip(lower, -twist.hand()));
}

}  // namespace ropewalk
