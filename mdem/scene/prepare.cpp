#include "scene/prepare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "io/log.hpp"
#include "model/error.hpp"
#include "observe/centre_line.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/missing_forces.hpp"
#include "scene/refuse_loads.hpp"
#include "scene/refuse_state.hpp"
#include "scene/scene_place.hpp"
#include "scene/state_files.hpp"
#include "scene/term_damping.hpp"
#include "sim/dynamics/blow_up.hpp"
#include "sim/statics/load_steps.hpp"
#include "sim/statics/newton.hpp"

namespace ropewalk {
namespace {

constexpr double least_held = 0.9;  // relative to the temperature of a bath, beside what damps
constexpr double max_steps = 1e12;  // years, even of a single tube

double chosen_step(const Scene& scene, const TimeStepLimit& limit) {
  const double typed = scene.run.time_step;
  const double largest = limit.limit;
  if (typed <= 0) {
    const double step = automatic_step_fraction(scene) * largest;
    return is_warm(scene) ? std::min(step, step_of_excess(limit, warm_excess)) : step;
  }
  if (typed < largest) return typed;
  const char* why = limit.damping_rate * largest > 1 ? "the strongest damping" : "the stiffest mode";
  throw InputError(place_in(scene, "run.time_step_fs"),
                   fmt::format("{:.4g} fs is not below the stability limit of {:.4g} fs, set by {}",
                               typed / units::fs, largest / units::fs, why),
                   fmt::format("take at most {:.3g}, or \"auto\"", 0.9 * largest / units::fs));
}

// The last elements of a tube are its upper end: the signs of torque and tension follow from that, and a clamp of
// the upper ends of opposed tubes would hold both ends of the rope. Tubes that the program places itself stand
// upright.
void refuse_upside_down(const Scene& scene, const Prepared& p) {
  using Ends = Drive::Ends;
  if (!scene.from_file() || !(scene.has_ends(Ends::clamped) || scene.has_ends(Ends::loaded))) return;
  const InputError::Place place{scene.source->file(), 0, ""};
  const char* remedy =
      "write the lines of such a tube in the opposite order, each quaternion turned by 180 degrees about an axis "
      "across the tube";
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const Vector3 first = p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])],
                  way = p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t + 1]) - 1] - first;
    if (way.z() < -0.5 * way.norm())
      throw InputError(
          place,
          fmt::format("tube {} stands upside down: its first element, which is its lower end, lies {:.4g} nm "
                      "above its last one, and a drive holds the ends",
                      t, -way.z()),
          remedy);
  }
  if (!run_the_same_way(p.topology, p.state))
    throw InputError(place, "the tubes run in opposite directions, and a drive holds their upper and lower ends",
                     remedy);
}

void refuse_stop_rules(const Scene& scene) {
  for (std::size_t k = 0; k < scene.stops.size(); ++k)
    if (const std::string& column = scene.stops[k].column; !column.empty())
      column_of_log(column, place_in(scene, "stop.column", static_cast<int>(k)));
  if (!scene.stops.empty() && scene.run.mode == RunOptions::Mode::relax)
    throw InputError(place_in(scene, "stop"), "is for dynamics, and run.mode is \"relax\"", "take it away");
}

void refuse_expectations(const Scene& scene, double duration) {
  const bool relaxes = scene.run.mode == RunOptions::Mode::relax;
  for (std::size_t k = 0; k < scene.expected.size(); ++k) {
    const Expectation& e = scene.expected[k];
    const auto at = [&](const char* key) { return place_in(scene, key, static_cast<int>(k)); };
    column_of_log(e.column, at("expect.column"));
    if (!e.at || e.of_other_scene) continue;
    if (relaxes)
      throw InputError(at("expect.at_ps"), "is a time, and a relaxation has none",
                       "take it away: the last row is judged");
    if (*e.at > duration * (1 + 1e-9))
      throw InputError(at("expect.at_ps"), fmt::format("is {:.6g}, and the run ends at {:.6g} ps", *e.at, duration),
                       "name an earlier time, or run longer");
  }
}

// A tolerance above all loads would call any state relaxed.
void refuse_loose_tolerance(const Scene& scene, const Simulation& s) {
  if (scene.run.mode != RunOptions::Mode::relax) return;
  std::vector<PointLoad> loads;
  point_loads(s.loads(), s.state(), s.state().time, loads);
  double largest = 0;
  for (const PointLoad& load : loads)
    largest = std::max(
        {largest, load.force.norm(), load.torque.norm() / s.topology().type_of_element(load.element).radius});
  if (largest > 0 && scene.run.goal.force >= largest)
    throw InputError(place_in(scene, "run.force_tolerance_nN"),
                     fmt::format("{:.3g} nN are not less than the largest load on an element, {:.3g} nN: the start "
                                 "would pass as relaxed",
                                 scene.run.goal.force / units::nN_nm, largest / units::nN_nm),
                     fmt::format("take at most {:.1g}", 0.01 * largest / units::nN_nm));
}

// Refuses scenes that the simulator would stop in the first step.
void refuse_first_step(const Scene& scene, const Simulation& s) {
  const Topology& topology = s.topology();
  refuse_forces(s.forces(), place_in(scene, "state"));
  if (scene.run.mode == RunOptions::Mode::relax) return;
  const double dt = s.time_step(), farthest = MotionBound::radii * topology.largest_radius();
  State kicked = s.state();
  for (int t = 0; t < topology.tubes(); ++t) {
    const TubeType& type = topology.type_of(t);
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      kicked.velocity.add(i, 0.5 * dt / type.mass * s.forces().force[i]);
      kicked.angular_velocity.add(i, 0.5 * dt / type.inertia * s.forces().torque[i]);
    }
  }
  constrain(topology, s.loads(), kicked.time, 0.5 * dt, kicked);
  for (std::size_t i = 0; i < kicked.size(); ++i) {
    const double moved = dt * kicked.velocity[i].norm(), turned = dt * kicked.angular_velocity[i].norm();
    if (moved >= farthest || turned >= MotionBound::turn)
      throw InputError(
          {scene.path, 0, ""},
          fmt::format("the first step would move element {} by {:.3g} nm and turn it by {:.3g} rad, and "
                      "a run ends at {:.3g} nm or {:.3g} rad",
                      i, moved, turned, farthest, MotionBound::turn),
          "take a gentler load, a slower start or a smaller time step");
  }
}

// All that takes heat out of a warm scene and gives none back.
struct Cooling {
  const Scene& scene;
  const Prepared& p;
  std::vector<TermDamping> terms;
  double of_terms = 0;  // 1/ps

  Cooling(const Scene& of, const Prepared& prepared) : scene(of), p(prepared) {
    const ThermostatOptions* bath = scene.bath();
    terms = damping_of_terms(p.topology, p.interaction, p.state,
                             bath ? bath->temperature.largest() : scene.start.temperature);
    for (const TermDamping& t : terms) of_terms += t.rate;
  }
  double held(double coupling) const { return bath_held(p.limit, coupling, of_terms); }
  // PFC's local damping takes a part of the heat in every swing of every mode.
  double left(double time) const { return scene.damping.local > 0 ? 0.0 : heat_left(p.limit, time, of_terms); }
  // Half-life of the heat, ps; infinite without damping.
  double half_life() const {
    if (scene.damping.local > 0) return 0;
    if (p.limit.damping_rate + of_terms <= 0) return std::numeric_limits<double>::infinity();
    double below = 0, above = 1 / (p.limit.damping_rate + of_terms);
    while (left(above) > 0.5 && above < 1e9) above *= 2;
    for (int k = 0; k < 40; ++k) {
      const double middle = 0.5 * (below + above);
      (left(middle) > 0.5 ? below : above) = middle;
    }
    return above;
  }
  // "set ... to 0"
  std::string remedy() const {
    std::vector<std::string> out;
    if (p.limit.damping_rate > 0)
      out.emplace_back("set contact_viscosity_eV_ps_per_nm3 and bond_damping_per_ps of [damping] to 0");
    for (const TermDamping& t : terms)
      out.push_back(t.name == "friction" ? "set drag_eV_ps_per_nm3 of [[friction]] to 0: the bath rubs as well"
                                         : fmt::format("take what brakes out of the force term \"{}\"", t.name));
    return fmt::format("{}", fmt::join(out, ", "));
  }
};

}  // namespace

double automatic_step_fraction(const Scene& scene) {
  const bool cold = scene.start.temperature == 0 && !scene.bath() && !scene.from_file();
  return cold && scene.run.mode != RunOptions::Mode::relax ? cold_step_fraction : default_step_fraction;
}

bool is_warm(const Scene& scene) {
  if (scene.run.mode == RunOptions::Mode::relax) return false;
  if (const ThermostatOptions* bath = scene.bath()) return bath->temperature.largest() > 0;
  return scene.start.temperature > 0 && !scene.start.may_cool;
}

void refuse_cooling(const Scene& scene, const Prepared& p) {
  if (!is_warm(scene)) return;
  if (const ThermostatOptions* bath = scene.bath()) {
    for (const auto& term : p.interaction.terms)
      if (term->acts_in_kick() && !scene.start.may_cool)
        throw InputError(
            place_in(scene, "thermostat"),
            fmt::format("does not go with the force term \"{}\": it acts in the kick, on the velocities "
                        "that the bath gives",
                        term->name()),
            "take one of the two away");
    const Cooling cooling(scene, p);
    const double held = cooling.held(bath->coupling);
    if (held < least_held && !scene.start.may_cool)
      throw InputError(
          place_in(scene, "thermostat.temperature_K"),
          fmt::format("is {} K, and damping leaves the tubes at about {:.2g} % of that: it takes heat that "
                      "coupling_per_ps = {:.4g} does not replace",
                      words_of(bath->temperature), 100 * held, bath->coupling),
          cooling.remedy() + "; or write may_cool = true into [start]");
    return;
  }
  const Cooling cooling(scene, p);
  const double left = cooling.left(p.duration);
  if (left > 0.5) return;
  throw InputError(
      place_in(scene, "start.temperature_K"),
      fmt::format(
          "is {:.4g} K, and damping leaves {:.2g} % of that heat at the end of the run, {:.4g} ps (half of it "
          "after {:.2g} ps)",
          scene.start.temperature, 100 * left, p.duration, cooling.half_life()),
      "hold it with [thermostat], set the keys of [damping] to 0, or write may_cool = true into [start] if it is a "
      "first push alone");
}

std::vector<std::string> warmth_of(const Scene& scene, const Prepared& p) {
  std::vector<std::string> out;
  const ThermostatOptions* bath = scene.bath();
  const double excess = excess_of_positions(p.limit, p.time_step);
  if (is_warm(scene))
    out.push_back(
        bath ? fmt::format("The time step makes the velocities at its end, and so kinetic_eV, up to {:.2g} % "
                           "colder than the bath. Positions, and so the energies of the bonds, have its "
                           "temperature.",
                           100 * (1 - 1 / (1 + excess)))
             : fmt::format("The time step makes positions, and so the energies of the bonds, up to {:.2g} % "
                           "hotter than velocities.",
                           100 * excess));
  if (bath ? !is_warm(scene) : scene.run.mode == RunOptions::Mode::relax || scene.start.temperature <= 0)
    return out;
  const Cooling cooling(scene, p);
  if (bath) {
    if (const double held = cooling.held(bath->coupling); held < 0.99) {
      std::string remedy = cooling.remedy();
      remedy.front() = static_cast<char>(std::toupper(remedy.front()));
      out.push_back(
          fmt::format("Damping takes out heat beside the thermostat: the tubes stay at about {:.2g} % of {} K. {}.",
                      100 * held, words_of(bath->temperature), remedy));
    }
    return out;
  }
  std::string text =
      fmt::format("The {:.4g} K at the start are in the velocities alone; bonds at rest take half of that heat.",
                  scene.start.temperature);
  if (const double half = cooling.half_life(); std::isfinite(half))
    text += fmt::format(" Damping takes half of it in {:.2g} ps and leaves {:.2g} % after {:.4g} ps.", half,
                        100 * cooling.left(p.duration), p.duration);
  out.push_back(text);
  return out;
}

Prepared prepare(Scene& scene) {
  Prepared out;
  BuiltScene built = build(scene);
  out.topology = std::move(built.topology);
  out.state = std::move(built.state);
  out.spacing = built.spacing;
  out.interaction = interaction_of(scene, std::move(built.law));
  add_terms(scene, out.topology, out.state, out.interaction);
  begin_with(scene.memory, out.topology, out.interaction);
  out.loads = loads_of(scene, out.topology, out.interaction);
  out.stepping = scene.run.stepping;
  refuse_upside_down(scene, out);
  for (const auto& drive : scene.drives) {
    drive->refuse_start(scene, out.topology, out.state, out.loads);
    drive->set_stepping(scene.lineage, out.stepping);
  }
  refuse_loads(scene, out.topology, out.interaction, out.loads);
  for (const auto& load : out.loads) load->begin(out.topology, out.state);
  out.limit = time_step_limit(out.topology, out.interaction, out.spacing);
  out.time_step = chosen_step(scene, out.limit);
  out.duration = scene.run.duration;
  if (out.duration <= 0) out.duration = protocol_time(scene);
  if (out.duration > 0 && out.duration < 0.5 * out.time_step)
    throw InputError(place_in(scene, "run.duration_ps"),
                     fmt::format("{:.4g} ps are less than half a step of {:.4g} fs: the run would take none",
                                 out.duration, out.time_step / units::fs),
                     "run longer, or set run.time_step_fs");
  if (out.duration / out.time_step > max_steps)
    throw InputError(place_in(scene, "run"),
                     fmt::format("{:.4g} ps in steps of {:.4g} fs are {:.1g} steps", out.duration,
                                 out.time_step / units::fs, out.duration / out.time_step),
                     fmt::format("at most {:.0g} can be counted; take a larger step or a shorter run", max_steps));
  const auto* rope = dynamic_cast<const RopeSource*>(scene.source.get());
  const bool typed = rope && !rope->typed_places.empty();
  if (scene.from_file() || typed)
    refuse_overlaps(out.topology, out.interaction, out.state,
                    typed ? place_in(scene, "rope.places_nm") : InputError::Place{scene.source->file(), 0, ""},
                    scene.run.mode == RunOptions::Mode::relax);
  refuse_stop_rules(scene);
  refuse_expectations(scene, out.duration);
  return out;
}

EndElements ends_of(const LoadsAndConstraints& loads, const Topology& topology) {
  EndElements held, ends = tube_ends(topology);
  for (const auto& load : loads) load->add_ends(held);
  for (const End end : {lower_end, upper_end})
    if (!held[end].empty()) ends[end] = held[end];
  return ends;
}

namespace {

// Newton's method has no answer for these.
void refuse_statics(const Scene& scene, const Simulation& simulation) {
  if (scene.statics.steps > 0 && load_step_times(simulation.loads(), scene.statics.steps).empty())
    throw InputError(
        place_in(scene, "statics.steps"), "has no schedule to go along: no load and no grip changes",
        "ramp a load, as by twist.rate_nN_nm_per_ps, or take [statics] away for the one state of rest");
  if (scene.run.mode != RunOptions::Mode::relax || scene.run.solver == RunOptions::Solver::fire) return;
  const NewtonStatics::Refusal refused = NewtonStatics::refusal(simulation);
  if (!refused.why.empty()) throw InputError(place_in(scene, "run.solver"), refused.why, refused.remedy);
}

}  // namespace

Simulation start(const Scene& scene, const Prepared& p) {
  refuse_missing_forces(scene.missing_forces, scene.path);
  Simulation simulation(p.topology, p.interaction, p.loads, p.state, p.time_step, scene.contact.skin, p.stepping);
  simulation.set_gauges(ends_of(p.loads, p.topology), p.state);
  refuse_first_step(scene, simulation);
  refuse_loose_tolerance(scene, simulation);
  refuse_statics(scene, simulation);
  return simulation;
}

}  // namespace ropewalk
