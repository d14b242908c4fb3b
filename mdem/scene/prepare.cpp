#include "scene/prepare.hpp"

#include <fmt/format.h>

#include <cmath>

#include "model/error.hpp"

namespace ropewalk {
namespace {

constexpr double most_steps = 1e12;  // years, even of a single tube

// Of the bonds.
double chosen_step(const Scene& scene, const TimeStepLimit& limit) {
  const double typed = scene.run.time_step;
  const int every = scene.run.stepping.contact_every;
  const double largest = inner_step_limit(limit, every);
  if (typed <= 0) return default_step_fraction * largest;
  if (typed < largest) return typed;
  const char* why = limit.damping_rate * largest * every > 1 ? "the strongest damping" : "the stiffest mode";
  const std::string levels = every > 1 ? fmt::format(" with contact_every = {}", every) : "";
  throw InputError({scene.path, 0, "run.time_step_fs"},
                   fmt::format("{:.4g} fs is not below the stability limit of {:.4g} fs{}, set by {}",
                               typed / units::fs, largest / units::fs, levels, why),
                   fmt::format("take at most {:.3g}, or \"auto\"", 0.9 * largest / units::fs));
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
  out.stepping = scene.run.stepping;
  out.time_step = chosen_step(scene, out.limit) * out.stepping.contact_every;
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
  return Simulation(p.topology, p.interaction, p.drive, p.state, p.time_step, scene.contact.skin, p.stepping);
}

}  // namespace ropewalk
