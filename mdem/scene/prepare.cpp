#include "scene/prepare.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr double most_steps = 1e12;  // years, even of a single tube

double chosen_step(const Scene& scene, const TimeStepLimit& limit) {
  const double typed = scene.run.time_step;
  if (typed <= 0) return default_step_fraction * limit.limit;
  if (typed < limit.limit) return typed;
  const char* why = limit.damping_rate * limit.limit > 1 ? "the strongest damping" : "the stiffest mode";
  throw InputError({scene.path, 0, "run.time_step_fs"},
                   fmt::format("{:.4g} fs is not below the stability limit of {:.4g} fs, set by {}",
                               typed / units::fs, limit.limit / units::fs, why),
                   fmt::format("take at most {:.3g}, or \"auto\"", 0.9 * limit.limit / units::fs));
}

}  // namespace

Prepared prepare(Scene& scene) {
  Prepared out;
  BuiltScene built = build(scene);
  out.topology = std::move(built.topology);
  out.state = std::move(built.state);
  out.spacing = built.spacing;
  out.interaction = interaction_of(scene);
  out.drive = drive_of(scene, out.topology);
  out.limit = time_step_limit(out.topology, out.interaction, out.spacing);
  out.time_step = chosen_step(scene, out.limit);
  out.duration = scene.run.duration;
  if (out.duration <= 0 && scene.twist) out.duration = scene.twist->ramp_time() + scene.twist->hold;
  if (out.duration / out.time_step > most_steps)
    throw InputError({scene.path, 0, "run"},
                     fmt::format("{:.4g} ps in steps of {:.4g} fs are {:.1g} steps", out.duration,
                                 out.time_step / units::fs, out.duration / out.time_step),
                     fmt::format("at most {:.0g} can be counted; take a larger step or a shorter run", most_steps));
  return out;
}

Simulation start(const Scene& scene, const Prepared& p) {
  return Simulation(p.topology, p.interaction, p.drive, p.state, p.time_step, scene.contact.skin);
}

}  // namespace ropewalk
