#include "scene/loads/rotate.hpp"

#include "scene/loads/load_kind.hpp"

namespace ropewalk {
namespace {

void read_centre(const TomlTable& t, const Scene&, PrescribedRotation& load) {
  if (!t.has("centre_nm")) return;
  const std::vector<double> c = t.numbers("centre_nm", Bounds::range(-1e6, 1e6), 2);
  load.centre = {c[0], c[1], 0};
}

void check_rotation(const TomlTable& t, const Scene&, PrescribedRotation& load) {
  if (load.rate == 0)
    throw t.error("rate_deg_per_ps", "is 0", "to hold elements where they are take kind = \"fix\"");
  load.angle = std::copysign(load.angle, load.rate);
}

}  // namespace

LoadKind rotate_kind() {
  using Key = KeyOf<PrescribedRotation>;
  using R = PrescribedRotation;
  return load_kind<R>(
      {"rotate",
       "",
       {Key::number("rate_deg_per_ps", {"deg/ps", units::degree}, Bounds::range(-360, 360), &R::rate, required("1"),
                    "speed of the prescribed rotation about z, negative: left-handed")
            .of_pace(SceneKey::Pace::rate),
        Key::number("angle_deg", unit::degree, Bounds::positive(1e6), &R::angle, required("360"), "where it stops"),
        Key::custom("centre_nm", "nm", standard("[0, 0]"), "x and y of the axis", read_centre),
        Key::boolean("axial_free", &R::axial_free, standard(), "z is free"),
        Key::boolean("spin_free", &R::spin_free, standard(), "elements may turn about their own axes")},
       check_rotation});
}

std::optional<LoadEffect> PrescribedRotation::effect() const {
  LoadEffect out;
  for (const std::size_t axis : {0, 1, 3, 4}) out.axes[axis] = LoadComponent::held(false);
  if (!axial_free) out.axes[LoadEffect::z] = LoadComponent::held();
  if (angle / rate > 0)
    out.axes[LoadEffect::about_z] =
        LoadComponent::follows(LoadComponent::Is::moved, Schedule({{0, 0}, {angle / rate, angle}}), false);
  out.by = LoadEffect::By::body;
  out.keeps_tilt = true;
  return out;
}

void PrescribedRotation::set_velocities(double time, std::size_t i, State& state) const {
  const Vector3 omega(0, 0, speed(time));
  const Vector3 v = omega.cross(state.position[i] - centre);
  state.velocity.x[i] = v.x();
  state.velocity.y[i] = v.y();
  if (!axial_free) state.velocity.z[i] = 0;
  Vector3 w = omega;
  if (spin_free) {
    const Vector3 t = axis_of(state.orientation[i]);
    w += (state.angular_velocity[i] - omega).dot(t) * t;
  }
  state.angular_velocity.set(i, w);
}

void PrescribedRotation::constrain(const Topology&, double time, double, State& state) const {
  for (const int e : elements) set_velocities(time, static_cast<std::size_t>(e), state);
}

}  // namespace ropewalk
