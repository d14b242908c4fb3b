#include "plan/forecast.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plan/features.hpp"
#include "plan/sliding_rope.hpp"
#include "scene/loads/periodic.hpp"
#include "scene/loads/twist.hpp"
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

// The shock goes as the square of the rate.
std::string gentle_ramp(const Scene& scene, double part) {
  const MomentRamp& ramp = *scene.moment_ramp();
  if (!(ramp.rate > 0)) return "ramp the moment";
  return fmt::format("a twist.rate_nN_nm_per_ps of {:.2g} would be gentle",
                     ramp.rate * std::sqrt(part) / units::nN_nm);
}

// The prescribed turn of one end of a rope, or of a slice, against the other end.
struct Turn {
  double angle = 0, rate = 0, length = 0;  // rad, rad/ps, nm
  bool length_held = false;
};

std::optional<Turn> turn_of(const Scene& scene, const Prepared& p) {
  Turn turn;
  if (const auto slices = scene.drives_of<PeriodicDrive>(); !slices.empty()) {
    const PeriodicLoad& load = slices.front()->load;
    turn.length = p.topology.period;
    turn.length_held = load.tension.empty();
    for (std::size_t k = 0; k < load.twist.size(); ++k) {
      turn.angle = std::max(turn.angle, std::fabs(load.twist[k].value) * turn.length);
      if (k > 0 && load.twist[k].time > load.twist[k - 1].time)
        turn.rate = std::max(turn.rate, std::fabs(load.twist[k].value - load.twist[k - 1].value) * turn.length /
                                            (load.twist[k].time - load.twist[k - 1].time));
    }
  } else if (const SceneFeatures f = features_of(scene, p); f.between_clamps) {
    turn = {f.turned, f.turning, f.length, f.length_held};
  }
  if (!(turn.angle > 0 && turn.rate > 0)) return std::nullopt;
  return turn;
}

// By length: 1 where a strand is one tube.
double part_of_strand(const Topology& topology, int tube) {
  const auto [first, last] = topology.strand_of(tube);
  int elements = 0;
  for (int t = first; t <= last; ++t) elements += topology.length_of(t);
  return static_cast<double>(topology.length_of(tube)) / elements;
}

}  // namespace

std::optional<std::string> helix_ahead(const Scene& scene, const Prepared& p) {
  const std::optional<HelixTheory> theory = helix_theory(scene, p);
  const MomentRamp* load = scene.moment_ramp();
  if (!theory || !load || load->moment <= theory->static_moment) return {};
  std::string words = fmt::format(
      "By theory a straight rope of tubes that slide becomes a helix from {:.3g} nN nm on each tube on.",
      theory->static_moment / theory->tubes_in_unit / units::nN_nm);
  constexpr double winding = 1;
  if (const double rate = theory->growth(load->moment, winding); rate > 0)
    words += fmt::format(
        " Under {:.3g} nN nm its amplitude grows by a factor of e in {:.3g} ps, with {:.2g} turns, if the rope "
        "turns by ML/EI.",
        load->of_each(p.topology.tubes()) / units::nN_nm, 1 / rate, theory->windings(load->moment, winding));
  return words;
}

double expected_shock(const Scene& scene, const Prepared& p) {
  const double twist = twist_energy_of(scene, p.topology);
  if (!(twist > 0) || scene.drives_of<TwistDrive>().empty() || !scene.source->is_parallel()) return 0;
  const MomentRamp& ramp = *scene.moment_ramp();
  if (!(ramp.rate > 0)) return 1;
  const double rate = ramp.rate * ramp.of_each(p.topology.strands()) / ramp.moment;
  double kinetic = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const TubeType& type = p.topology.type_of(t);
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    const double length = p.topology.length_of(t) * type.element_length, winds = length * rate / type.bond.twist;
    kinetic += 4 * type.mass / type.element_length * rho2 * length * winds * winds / 24;
  }
  return kinetic / twist;
}

std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& p) {
  std::vector<std::string> out;
  const SceneFeatures f = features_of(scene, p);
  const Limits limits = watched_of(scene, p.topology, p.interaction.law.get()).limits.front();
  for (const LimitKind& kind : limit_kinds()) {
    const bool shock = kind.limit == &Limits::shock;
    const double limit = limits.*kind.limit,
                 value = shock ? expected_shock(scene, p) : expected(f, p.topology.types[0], kind.limit);
    if (limit <= 0 || value <= limit) continue;
    const std::string unit = *kind.unit ? " " + std::string(kind.unit) : "";
    const std::string when =
        f.ramp > 0 && !shock ? fmt::format(", from about {:.3g} ps on", f.ramp * limit / value) : std::string();
    out.push_back(fmt::format("The load may bring {} to {:.3g}{}{}, beyond its limit of {:.3g}: {}; {}.", kind.key,
                              value / kind.unit_size, unit, when, limit / kind.unit_size, kind.consequence,
                              shock ? gentle_ramp(scene, limit / value) : kind.remedy));
  }
  return out;
}

std::optional<QuasiStatic> quasi_static(const Scene& scene, const Prepared& p) {
  const std::optional<Turn> turn = turn_of(scene, p);
  if (!turn) return std::nullopt;
  double twist = 0, inertia = 0, second = 0, fourth = 0, stretch = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const TubeType& type = p.topology.type_of(t);
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    const double part = part_of_strand(p.topology, t);
    twist += part * type.bond.twist;
    inertia += part * (type.mass * rho2 + type.inertia) / type.element_length;
    stretch += part * type.bond.stretch;
    second += part * type.bond.stretch * rho2;
    fourth += part * type.bond.stretch * rho2 * rho2;
  }
  const double cubic = 0.5 * (turn->length_held ? fourth : fourth - second * second / stretch);
  const double phi = turn->angle / turn->length, torque = 0.5 * twist * phi + 0.25 * cubic * phi * phi * phi;
  // The speed of rotation rises along the rope from zero at the held end to the whole rate at the turned one.
  const double drag = scene.bath() ? scene.bath()->coupling * inertia * 0.5 * turn->rate * turn->length : 0;
  return QuasiStatic{p.topology.images > 0, turn->length * std::sqrt(inertia / twist), turn->angle / turn->rate,
                     drag / torque, 0.5 * turn->rate * std::sqrt(twist * inertia) / torque};
}

std::string words_of(const QuasiStatic& q) {
  constexpr double enough = 0.05;
  const std::string percent = fmt::format(q.error < 0.1 ? "{:.2g}" : "{:.0f}", 100 * q.error);
  std::string text =
      q.slice
          ? fmt::format(
                "Twist enters the slice at its ends and needs {:.3g} ps to its middle, and the turn lasts {:.3g} "
                "ps: torques are those of rest within {} % at most",
                0.5 * q.travel, q.time, percent)
          : fmt::format(
                "Twist needs {:.3g} ps from end to end, and the turn lasts {:.3g} ps: torques are those of rest "
                "within {} % at most, by which both ends differ from their mean",
                q.travel, q.time, percent);
  if (q.error > enough)
    text += fmt::format("; for {:.2g} % turn in {:.3g} ps", 100 * enough, q.time * q.error / enough);
  text += ".";
  if (q.drag > 0.01)
    text += fmt::format(
        " The bath is at rest and brakes the turning rope by about {:.2g} % of that torque: lower "
        "thermostat.coupling_per_ps, or turn more slowly.",
        100 * q.drag);
  return text;
}

}  // namespace ropewalk
