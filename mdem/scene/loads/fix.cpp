#include "scene/loads/fix.hpp"

#include <fmt/format.h>

#include "scene/loads/load_kind.hpp"

namespace ropewalk {
namespace {

void read_axes(const TomlTable& t, const Scene&, FixLoad& fix) {
  if (!t.has("axes")) return;
  // Empty is a text here: nothing but the orientation.
  const std::string axes = t.text("axes");
  fix.x = axes.find('x') != std::string::npos;
  fix.y = axes.find('y') != std::string::npos;
  fix.z = axes.find('z') != std::string::npos;
  if (axes.size() != static_cast<std::size_t>(fix.x + fix.y + fix.z))
    throw t.error("axes", fmt::format("is \"{}\"", printable(axes, 40)),
                  "write x, y and z, each at most once: \"xy\"");
}

void check_fix(const TomlTable& t, const Scene&, FixLoad& fix) {
  if (!fix.x && !fix.y && !fix.z && !fix.rotation)
    throw t.error("axes", "is empty and rotation is false: nothing is fixed", "take the load away");
}

}  // namespace

LoadKind fix_kind() {
  using Key = KeyOf<FixLoad>;
  return load_kind<FixLoad>({"fix",
                             "",
                             {Key::custom("axes", "", standard("\"xyz\""), "coordinates that are held", read_axes),
                              Key::boolean("rotation", &FixLoad::rotation, standard(), "orientation is held")},
                             check_fix});
}

std::optional<LoadEffect> FixLoad::effect() const {
  LoadEffect out;
  const bool held[] = {x, y, z, rotation, rotation, rotation};
  for (std::size_t k = 0; k < out.axes.size(); ++k)
    if (held[k]) out.axes[k] = LoadComponent::held();
  out.keeps_tilt = rotation;
  return out;
}

void FixLoad::constrain(const Topology&, double, double, State& state) const {
  for (const int e : elements) {
    const auto i = static_cast<std::size_t>(e);
    if (x) state.velocity.x[i] = 0;
    if (y) state.velocity.y[i] = 0;
    if (z) state.velocity.z[i] = 0;
    if (rotation) state.angular_velocity.set(i, Vector3::Zero());
  }
}

}  // namespace ropewalk
