#include "plan/forecast.hpp"

#include <fmt/format.h>

#include "plan/features.hpp"
#include "scene/watch.hpp"

namespace ropewalk {
namespace {

// What a scene brings a limit to; 0: not estimated.
double expected(const SceneFeatures& f, const TubeType& type, double Limits::*limit) {
  if (limit == &Limits::wall_twist) return type.radius * f.twist;
  if (limit == &Limits::twist) return type.element_length * f.twist;
  if (limit == &Limits::kink_curvature) return f.curvature;
  if (limit == &Limits::bend) return type.element_length * f.curvature;
  if (limit == &Limits::strain) return f.strain;
  if (limit == &Limits::pressure) return f.pressure;
  return 0;
}

// The twist (rad/nm) at which tubes, each under the moment of [twist], rest where the length is free:
// M = GJ phi + EA Var(rho^2) phi^3/2.
double resting_twist(const Scene& scene, const Prepared& p) {
  const TwistLoad& w = *scene.twist;
  const BondStiffness& k = p.topology.types[0].bond;
  const double moment = w.reading == TwistLoad::Reading::per_tube ? w.moment : w.moment / p.topology.tubes();
  double mean = 0, mean2 = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    mean += rho2 / p.topology.tubes();
    mean2 += rho2 * rho2 / p.topology.tubes();
  }
  const double cubic = w.geometric_only ? 0 : 0.5 * k.stretch * (mean2 - mean * mean);
  double low = 0, high = moment / k.twist;
  for (int step = 0; step < 60; ++step) {
    const double phi = 0.5 * (low + high);
    (k.twist * phi + cubic * phi * phi * phi < moment ? low : high) = phi;
  }
  return low;
}

}  // namespace

std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& p) {
  std::vector<std::string> out;
  SceneFeatures f = features_of(scene, p);
  if (scene.twist && scene.source->is_parallel()) f.twist = resting_twist(scene, p);
  const Limits limits = watched_of(scene, p.topology).limits.front();
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
