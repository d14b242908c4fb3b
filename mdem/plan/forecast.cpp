#include "plan/forecast.hpp"

#include <fmt/format.h>

#include "plan/features.hpp"
#include "scene/watch.hpp"

namespace ropewalk {
namespace {

// The value that a scene brings a limit to; 0: not estimated.
double expected(const SceneFeatures& f, const TubeType& type, double Limits::*limit) {
  if (limit == &Limits::wall_twist) return type.radius * f.twist;
  if (limit == &Limits::twist) return type.element_length * f.twist;
  if (limit == &Limits::kink_curvature) return f.curvature;
  if (limit == &Limits::bend) return type.element_length * f.curvature;
  if (limit == &Limits::strain) return f.strain;
  if (limit == &Limits::pressure) return f.pressure;
  return 0;
}

}  // namespace

std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& p) {
  std::vector<std::string> out;
  SceneFeatures f = features_of(scene, p);
  if (scene.moment_ramp() && scene.source->is_parallel()) f.twist = f.turn;
  const Limits limits = watched_of(scene, p.topology, p.interaction.law.get()).limits.front();
  for (const LimitKind& kind : limit_kinds()) {
    const double limit = limits.*kind.limit, value = expected(f, p.topology.types[0], kind.limit);
    if (limit <= 0 || value <= limit) continue;
    const std::string unit = *kind.unit ? " " + std::string(kind.unit) : "";
    const std::string when =
        f.ramp > 0 ? fmt::format(", from about {:.3g} ps on", f.ramp * limit / value) : std::string();
    out.push_back(fmt::format("The load may bring {} to {:.3g}{}{}, beyond its limit of {:.3g}: {}; {}.", kind.key,
                              value / kind.unit_size, unit, when, limit / kind.unit_size, kind.consequence,
                              kind.remedy));
  }
  return out;
}

}  // namespace ropewalk
