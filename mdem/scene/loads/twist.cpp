#include "scene/loads/twist.hpp"

#include <fmt/format.h>

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

constexpr const char* rate_key = "rate_nN_nm_per_ps";

void check_twist(const TomlTable& t, const Scene&, TwistLoad& twist) {
  if (twist.ramp_time() > longest_time)
    throw t.error(rate_key, fmt::format("makes a ramp of {:.3g} ps", twist.ramp_time()), "ramp faster");
}

}  // namespace

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
                   "rate of the ramp; 0: the moment acts at once"),
       Key::number("hold_ps", unit::ps, Bounds::non_negative(longest_time), &T::hold, standard(),
                   "time under the full moment, after the ramp"),
       Key::word("reading", Words<T::Reading>{{"per-tube", T::Reading::per_tube}, {"total", T::Reading::total}},
                 &T::reading, standard(), "the moment is that of each grip element, or of all: \"total\""),
       Key::word(
           "application",
           Words<T::Application>{{"couple", T::Application::couple}, {"tangential", T::Application::tangential}},
           &T::application, standard(),
           "a couple on each grip element, or \"tangential\" forces about the rope's axis"),
       Key::word("lateral", grips, &T::lateral_free, standard(),
                 "\"held\": the centre of mass of a grip stays on the axis"),
       Key::word("axial", grips, &T::axial_free, standard(), "\"held\": grip elements keep their z"),
       Key::boolean("geometric_only", &T::geometric_only, standard(),
                    "relax the tubes' own twist at each increment"),
       Key::number("increment_ps", unit::ps, Bounds::positive(longest_time), &T::increment, standard(),
                   "time between such relaxations")},
      check_twist};
  return table;
}

TwistLoad TwistLoad::on_grip(std::vector<int> grip, double sign_there) const {
  TwistLoad there = *this;
  there.elements = std::move(grip);
  there.sign = sign_there;
  return there;
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
  for (const int e : elements) out.push_back({e, Vector3::Zero(), Vector3(0, 0, each)});
}

// Taking the velocity of the centre of mass from every element does no work on the others; a mean of another weight
// would.
void TwistLoad::constrain(const Topology& topology, double, double, State& state) const {
  if (lateral_free && axial_free) return;
  Vector3 mean = Vector3::Zero();
  if (!lateral_free) {
    std::array<double, 3> sums{};  // of mass and momentum
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
    lower.push_back(topology.tube_begin[t]);
    upper.push_back(topology.tube_begin[t + 1] - 1);
  }
  loads.add(twist.on_grip(upper, 1));
  loads.add(twist.on_grip(lower, -1));
}

}  // namespace ropewalk
