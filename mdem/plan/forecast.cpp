#include "plan/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "plan/demands.hpp"
#include "plan/features.hpp"
#include "plan/sliding_rope.hpp"
#include "scene/watch.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {
namespace {

// The value that a scene brings a limit to; 0: not estimated.
double expected(const Demands& f, const TubeType& type, double Limits::*limit) {
  if (limit == &Limits::wall_twist) return type.radius * f.twist;
  if (limit == &Limits::twist) return type.element_length * f.twist;
  if (limit == &Limits::kink_curvature) return f.curvature;
  if (limit == &Limits::bend) return type.element_length * f.curvature;
  if (limit == &Limits::strain) return f.strain;
  if (limit == &Limits::compression) return f.pressed;
  if (limit == &Limits::pressure) return f.pressure;
  return 0;
}

// The shock goes as the square of the rate.
std::string gentle_ramp(const Prepared& p, double part) {
  const std::optional<EndMoment> load = end_moment(end_drives(p.loads, p.topology));
  if (!load || !(load->rate() > 0)) return "ramp the moment";
  const double rate = load->rate() * std::sqrt(part);
  return fmt::format("a ramp of {:.2g} nN nm/ps, over {:.3g} ps, would be gentle", rate / units::nN_nm,
                     load->largest() / rate);
}

// The part of its strand's length that a tube has: 1 where a strand is one tube.
double part_of_strand(const Topology& topology, int tube) {
  const auto [first, last] = topology.strand_of(tube);
  int elements = 0;
  for (int t = first; t <= last; ++t) elements += topology.length_of(t);
  return static_cast<double>(topology.length_of(tube)) / elements;
}

}  // namespace

std::optional<std::string> helix_ahead(const Scene& scene, const Prepared& p) {
  const std::optional<HelixTheory> theory = helix_theory(scene, p);
  const std::optional<EndMoment> load = end_moment(end_drives(p.loads, p.topology));
  if (!theory || !load || load->largest() <= theory->static_moment) return {};
  std::string words = fmt::format(
      "By theory a straight rope of tubes that slide becomes a helix from {:.3g} nN nm on each tube on.",
      theory->static_moment / theory->tubes_in_unit / units::nN_nm);
  constexpr double winding = 1;
  if (const double rate = theory->growth(load->largest(), winding); rate > 0)
    words += fmt::format(
        " Under {:.3g} nN nm its amplitude grows by a factor of e in {:.3g} ps, with {:.2g} turns, if the rope "
        "turns by ML/EI.",
        load->of_each(p.topology.tubes()) / units::nN_nm, 1 / rate, theory->windings(load->largest(), winding));
  return words;
}

double expected_shock(const Scene& scene, const Prepared& p) {
  const double twist = twist_energy_of(scene, p.topology, p.loads);
  if (!(twist > 0) || !scene.source->is_parallel()) return 0;
  const EndMoment load = end_moment(end_drives(p.loads, p.topology)).value();
  if (!(load.rate() > 0)) return 1;
  const double rate = load.rate() * load.of_each(p.topology.strands()) / load.largest();
  const double spread =
      load.balanced ? 24 : 6;  // the rope turns against its middle, or against the end that is held
  double kinetic = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const TubeType& type = p.topology.type_of(t);
    const double rho2 =
        Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]).head<2>().squaredNorm();
    const double length = p.topology.length_of(t) * type.element_length, winds = length * rate / type.bond.twist;
    kinetic += 4 * type.mass / type.element_length * rho2 * length * winds * winds / spread;
  }
  return kinetic / twist;
}

namespace {

constexpr double at_once = 1e-3;  // ps
// Tubes may break so much later than foreseen. When the strongest have broken, the rope is another one.
constexpr double latest_break = 1.25;

// What a scene does to one limit.
struct Ahead {
  double start = 0, largest = 0;
  double passes = 0;  // when it passes, ps
};

// `end`: ps, of the run, which loads may outlast.
template <class Value>
Ahead ahead_of(const DemandsAhead& demands, double end, const Value& of, double limit) {
  const auto value = [&](double time) { return of(demands.at(time)); };
  Ahead out{value(0), 0, 0};
  double before = 0;
  for (const double asked : demands.times()) {
    const double time = std::min(asked, end), now = value(time);
    if (now > limit && !(out.largest > limit)) {
      double low = before, high = time;
      for (int k = 0; k < 30 && high > low; ++k) {
        const double middle = 0.5 * (low + high);
        (value(middle) > limit ? high : low) = middle;
      }
      out.passes = high;
    }
    out.largest = std::max(out.largest, now);
    before = time;
  }
  return out;
}

// Pressed bonds have a limit of their own.
struct Asked {
  const LimitKind* kind;
  double Limits::*limit;
};

std::vector<Asked> all_asked() {
  std::vector<Asked> out;
  for (const LimitKind& kind : limit_kinds()) {
    out.push_back({&kind, kind.limit});
    if (kind.limit == &Limits::strain) out.push_back({&kind, &Limits::compression});
  }
  return out;
}

std::vector<std::size_t> types_with_tubes(const Topology& topology) {
  const std::set<int> all(topology.tube_type.begin(), topology.tube_type.end());
  return {all.begin(), all.end()};
}

// As far as tubes bear it.
double expected_of(const Demands& f, const TubeType& type, const ForceTerm::Strength& strength, double Limits::*limit) {
  const double value = expected(f, type, limit);
  return limit == &Limits::strain ? std::min(value, strength.strongest) : value;
}

ForceTerm::Strength strength_of(const Prepared& p, std::size_t type) {
  ForceTerm::Strength out;
  for (const auto& term : p.interaction.terms) {
    const ForceTerm::Strength here = term->strength(static_cast<int>(type));
    out.weakest = std::min(out.weakest, here.weakest);
    out.strongest = std::min(out.strongest, here.strongest);
    out.moment = std::min(out.moment, here.moment);
  }
  return out;
}

// When the tubes of a type break, and by what.
struct Breaks {
  double from = std::numeric_limits<double>::infinity();  // ps
  std::string by;
};

Breaks breaks_ahead(const DemandsAhead& demands, double end, const TubeType& type,
                    const ForceTerm::Strength& strength) {
  Breaks out;
  const TubeLaw law(type);
  const auto look = [&](const auto& of, double limit, const std::string& by) {
    if (!std::isfinite(limit)) return;
    const Ahead ahead = ahead_of(demands, end, of, limit);
    const double from = ahead.start > limit ? 0 : ahead.passes;
    if (ahead.largest > limit && from < out.from) out = {from, by};
  };
  look([](const Demands& f) { return f.strain; }, strength.weakest,
       fmt::format("strained by {:.3g}", strength.weakest));
  look([&](const Demands& f) { return law.moment(std::min(f.curvature, 0.5 * units::pi / type.element_length)); },
       strength.moment, fmt::format("bent with {:.3g} nN nm", strength.moment / units::nN_nm));
  if (std::isfinite(strength.weakest) || std::isfinite(strength.moment))
    look([&](const Demands& f) { return type.element_length * f.twist; }, (1 - 1e-6) * 0.5 * units::pi,
         "twisted by 90 deg");
  return out;
}

}  // namespace

std::string not_foreseen(const Scene& scene, const Prepared& p) {
  std::set<std::string> what;
  for (const auto& term : p.interaction.terms)
    if (const std::string words = term->not_foreseen(); !words.empty()) what.insert(words);
  for (const auto& load : p.loads)
    if (!load->effect()) what.insert("what loads of your own do");
  if (scene.start.temperature > 0 || scene.bath()) what.insert("the peaks of heat");
  return what.empty() ? "" : fmt::format("Limits are foreseen without {}.", fmt::join(what, ", "));
}

std::vector<std::string> limits_ahead(const Scene& scene, const Prepared& p) {
  std::vector<std::string> out;
  const std::vector<Limits> limits = watched_of(scene, p.topology, p.loads, p.interaction.law.get()).limits;
  const std::vector<std::size_t> types = types_with_tubes(p.topology);
  const double end = scene.run.mode == RunOptions::Mode::relax ? std::numeric_limits<double>::infinity() : p.duration;
  std::vector<DemandsAhead> demands;
  std::vector<ForceTerm::Strength> strengths;
  for (const std::size_t type : types) {
    demands.emplace_back(scene, p, type);
    strengths.push_back(strength_of(p, type));
  }
  Breaks first;
  double last = 0;  // ps, when the strongest tubes of the strongest type break
  std::string of;
  for (std::size_t k = 0; k < types.size(); ++k) {
    const TubeType& type = p.topology.types[types[k]];
    ForceTerm::Strength strongest = strengths[k];
    strongest.weakest = strongest.strongest;
    last = std::max(last, breaks_ahead(demands[k], end, type, strongest).from);
    if (const Breaks breaks = breaks_ahead(demands[k], end, type, strengths[k]); breaks.from < first.from) {
      first = breaks;
      of = types.size() > 1 ? " of " + scene.sets[types[k]].name : "";
    }
  }
  if (std::isfinite(first.from))
    out.push_back(fmt::format("The load may break tubes{}, {}: a bond breaks once it is {}.", of,
                              first.from > at_once ? fmt::format("from about {:.3g} ps on", first.from)
                                                   : "from the start on",
                              first.by));
  const double until = std::min(end, latest_break * last);
  for (const auto& [asked, member] : all_asked()) {
    const LimitKind& kind = *asked;
    const auto limit_of = [&, own = member](const Limits& of) {
      return own == &Limits::compression && of.*own == 0 ? of.strain : of.*own;
    };
    // The type that the scene brings farthest beyond its limit.
    Ahead ahead;
    std::size_t type = types.front();
    for (std::size_t k = 0; k < types.size(); ++k) {
      const double here = limit_of(limits[types[k]]);
      if (here <= 0 || kind.limit == &Limits::shock) continue;
      const auto value = [&, own = member](const Demands& f) {
        return expected_of(f, p.topology.types[types[k]], strengths[k], own);
      };
      const Ahead of_type = ahead_of(demands[k], until, value, here);
      if (k > 0 && !(of_type.largest / here > ahead.largest / limit_of(limits[type]))) continue;
      ahead = of_type;
      type = types[k];
    }
    const double limit = limit_of(limits[type]), sign = member == &Limits::compression ? -1 : 1;
    if (limit <= 0) continue;
    const std::string what =
        types.size() > 1 ? fmt::format("{} of {}", kind.key, scene.sets[type].name) : std::string(kind.key);
    const std::string unit = *kind.unit ? " " + std::string(kind.unit) : "";
    const auto number = [&](double value) { return fmt::format("{:.3g}{}", sign * value / kind.unit_size, unit); };
    const std::string beyond =
        fmt::format("beyond its limit of {:.3g}: {}", sign * limit / kind.unit_size, kind.consequence);
    if (kind.limit == &Limits::shock) {
      if (const double shock = expected_shock(scene, p); shock > limit)
        out.push_back(fmt::format("The load may bring {} to {}, {}; {}.", kind.key, number(shock), beyond,
                                  gentle_ramp(p, limit / shock)));
      continue;
    }
    if (!(ahead.largest > limit)) continue;
    constexpr double more = 1.02;
    if (ahead.start > limit)
      out.push_back(fmt::format("The scene begins with {} at {}{}, {}; {}.", what, number(ahead.start),
                                ahead.largest > more * ahead.start
                                    ? fmt::format(", and the load may bring it to {}", number(ahead.largest))
                                    : std::string(),
                                beyond, kind.remedy));
    else
      out.push_back(fmt::format(
          "The load may bring {} to {}{}, {}; {}.", what, number(ahead.largest),
          ahead.passes > at_once ? fmt::format(", from about {:.3g} ps on", ahead.passes) : std::string(), beyond,
          kind.remedy));
  }
  return out;
}

std::optional<QuasiStatic> quasi_static(const Scene& scene, const Prepared& p) {
  const SceneFeatures f = features_of(scene, p);
  if (!f.turned_between || !(f.turning > 0)) return std::nullopt;
  const double length = p.topology.groups.images > 0 ? p.topology.groups.period : f.length;
  const auto first_of = [&](int t) {
    return Vector3(p.state.position[static_cast<std::size_t>(p.topology.tube_begin[t])]);
  };
  Vector3 axis = Vector3::Zero();  // a rope may stand anywhere
  for (int t = 0; t < p.topology.tubes(); ++t) axis += first_of(t) / p.topology.tubes();
  double twist = 0, inertia = 0, second = 0, fourth = 0, stretch = 0;
  for (int t = 0; t < p.topology.tubes(); ++t) {
    const TubeType& type = p.topology.type_of(t);
    const double rho2 = (first_of(t) - axis).head<2>().squaredNorm();
    const double part = part_of_strand(p.topology, t);
    twist += part * type.bond.twist;
    inertia += part * (type.mass * rho2 + type.inertia) / type.element_length;
    stretch += part * type.bond.stretch;
    second += part * type.bond.stretch * rho2;
    fourth += part * type.bond.stretch * rho2 * rho2;
  }
  const double cubic = 0.5 * (f.length_held ? fourth : fourth - second * second / stretch);
  const double phi = f.turned / length, torque = 0.5 * twist * phi + 0.25 * cubic * phi * phi * phi;
  // The speed of rotation rises along the rope from zero at the held end to the whole rate at the turned one.
  const double drag = scene.bath() ? scene.bath()->coupling * inertia * 0.5 * f.turning * length : 0;
  return QuasiStatic{p.topology.groups.images > 0, length * std::sqrt(inertia / twist), f.turned / f.turning,
                     drag / torque, 0.5 * f.turning * std::sqrt(twist * inertia) / torque};
}

std::string words_of(const QuasiStatic& q) {
  constexpr double enough = 0.05, waves = 10;
  const double travel = q.slice ? 0.5 * q.travel : q.travel;
  if (travel > q.time)
    return fmt::format(
        "A twist wave needs {:.3g} ps {} and the ramp lasts {:.3g} ps: one part turns before another feels it, and "
        "the torque is that of the wave. Ramp over {:.2g} ps or more.",
        travel, q.slice ? "from the ends of the slice to its middle" : "from end to end", q.time,
        std::max(waves * travel, q.time * q.error / enough));
  const std::string percent = fmt::format(q.error < 0.1 ? "{:.2g}" : "{:.0f}", 100 * q.error);
  std::string text = q.slice ? fmt::format(
                                   "A twist wave needs {:.3g} ps from the ends of the slice to its middle and the "
                                   "ramp lasts {:.3g} ps: "
                                   "the torque may be up to {} % off its quasi-static value.",
                                   travel, q.time, percent)
                             : fmt::format(
                                   "A twist wave needs {:.3g} ps from end to end and the ramp lasts {:.3g} ps: the "
                                   "torque of either end "
                                   "may be up to {} % off its quasi-static value.",
                                   travel, q.time, percent);
  if (q.error > enough)
    text += fmt::format(" Ramp over {:.3g} ps for {:.2g} %.", q.time * q.error / enough, 100 * enough);
  if (q.drag > 0.01)
    text += fmt::format(
        " The bath is at rest and brakes the turning rope by about {:.2g} % of that torque: lower "
        "thermostat.coupling_per_ps, or turn more slowly.",
        100 * q.drag);
  return text;
}

}  // namespace ropewalk
