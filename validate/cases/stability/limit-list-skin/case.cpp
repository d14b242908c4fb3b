// Whether fast motion makes the neighbour list miss a pair.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/bundle.hpp"
#include "cases/common/stability_limit.hpp"
#include "model/error.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/forces/forces.hpp"

namespace ropewalk::validate::list_skin {
namespace {

constexpr double time_step = 0.02;  // ps

// Two elements in one line, just out of range of each other, that approach or turn.
Bundle nose_to_nose(const ParameterSet& set, double gap, double speed, double spin) {
  Bundle b;
  b.interaction.law = line_law({line_contact_of(set)});
  b.place(set, 1, {{0, 0}, {0, 0}});
  b.state.position.set(1, {0, 0, b.interaction.cutoff() + gap});
  if (spin > 0) {  // beside one another: the second one's end sweeps over the first
    b.state.position.set(1, {0, 0.3 * b.interaction.cutoff(), 0.8 * b.interaction.cutoff()});
    b.state.orientation.set(0, turn_about(Vector3::UnitX(), 1.2));
  }
  b.state.velocity.set(0, {0, 0, 0.5 * speed});
  b.state.velocity.set(1, {0, 0, -0.5 * speed});
  b.state.angular_velocity.set(0, {spin, 0, 0});
  b.state.angular_velocity.set(1, {-0.7 * spin, 0, 0});
  return b;
}

// The contact energy over all pairs, without a list.
double energy_without_list(const Interaction& in, const Topology& topology, const State& state) {
  Forces f(state.size());
  compute_reference(topology, in, state, f);
  return f.energy.vdw;
}

struct Approach {
  double missed = 0;   // largest difference of the energy from that without a list, eV
  double largest = 0;  // energy met: that there was something to miss
};

// Until the steps are done or the simulator stops.
Approach approach(const Bundle& b, const Interaction& oracle, double skin, long steps) {
  Simulation s(b.topology, b.interaction, {}, b.state, time_step, skin);
  Approach out;
  try {
    for (long k = 0; k < steps; ++k) {
      s.step();
      const double expected = energy_without_list(oracle, b.topology, s.state());
      out.missed = std::max(out.missed, std::fabs(s.forces().energy.vdw - expected));
      out.largest = std::max(out.largest, std::fabs(expected));
    }
  } catch (const NumericalError&) {
    return out;
  }
  return out;
}

// Steps per build while the two are out of reach and nothing changes their speed.
double steps_per_build(const ParameterSet& model, double skin, double speed) {
  constexpr long steps = 400;
  const Bundle b = nose_to_nose(model, skin + steps * speed * time_step, speed, 0);
  Simulation s(b.topology, b.interaction, {}, b.state, time_step, skin);
  const long before = s.list().builds();
  s.steps(steps);
  return static_cast<double>(steps) / static_cast<double>(s.list().builds() - before);
}

// How far (nm) the two may approach before a list that is never rebuilt misses the pair.
double stale_path(const ParameterSet& model, double skin) {
  const Bundle b = nose_to_nose(model, 1.0001 * skin, 0, 0);
  NeighbourList list(b.interaction, skin);
  list.build(b.topology, b.state);
  const auto misses = [&](double path) {
    State moved = b.state;
    moved.position.add(0, {0, 0, 0.5 * path});
    moved.position.add(1, {0, 0, -0.5 * path});
    ForceEngine engine;
    Forces f(2), all(2);
    engine.compute(b.topology, b.interaction, list, moved, f);
    compute_reference(b.topology, b.interaction, moved, all);
    return std::fabs(f.energy.vdw - all.energy.vdw) > 1e-12;
  };
  return limit_between(misses, 0, 3, 1e-4);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  CaseResult result;
  // At the largest speed that does not stop a run, half of it for each element; and turning.
  const double fastest = 2 * 0.24 * oracle.radius / time_step, spin = 0.45 / time_step;
  Interaction reference;
  reference.law = line_law({line_contact_of(oracle)});
  double missed = 0, weakest = 1e9;
  for (const double skin : {0.02, 0.1, 0.25, 0.5})
    for (const double part : {0.01, 0.1, 1.0}) {
      const double speed = part * fastest;
      const long steps = std::lround((1 + 0.5 * skin) / (speed * time_step)) + 1;
      const Approach a = approach(nose_to_nose(model, 0.5 * skin, speed, 0), reference, skin, steps);
      missed = std::max(missed, a.missed / a.largest);
      weakest = std::min(weakest, a.largest);
    }
  for (const double skin : {0.02, 0.25}) {
    const Approach a = approach(nose_to_nose(model, 0, 0.5, spin), reference, skin, 60);
    missed = std::max(missed, a.missed / a.largest);
    weakest = std::min(weakest, a.largest);
  }
  result.check_absolute("contact energy that the list misses, over the largest", missed, 0, 1e-9, "1",
                        "at up to 16 km/s or 0.45 rad in a step, skins of 0.02 to 0.5 nm");
  result.show_absolute("smallest of the largest contact energies", weakest, 0, 0, "eV",
                       "shows that there was a contact to miss");
  // A list that is never rebuilt.
  std::vector<double> skins = {0.1, 0.25, 0.5}, paths;
  for (const double skin : skins) {
    paths.push_back(stale_path(model, skin));
    result.check_relative(fmt::format("path after which an old list misses, skin {:.2f} nm", skin), paths.back(),
                          skin, 0.05, "nm", "both have moved half of it");
  }
  result.limits.push_back({"path until an old list misses a contact, skin 0.25 nm", paths[1], skins[1], "nm",
                           Limit::Guard::none,
                           "not needed: the list is checked before every force evaluation, at any speed"});
  // The cost of speed.
  const double speed = 1.0;
  const double found = limit_between([&](double s) { return steps_per_build(model, s, speed) > 1.5; }, 1e-3, 0.2);
  const double theory = speed * time_step;  // each of the two moves at half the speed, and may move half the skin
  result.check_relative("skin below which the list is built in every step", found, theory, 0.05, "nm",
                        "1 km/s, steps of 20 fs");
  result.limits.push_back({"skin below which every step builds the list, 1 km/s", found, theory, "nm",
                           Limit::Guard::none, "not needed: the run is slow, not wrong; the default is 0.25 nm"});
  std::vector<double> v, every;
  for (double at = 0.1; at < 2.05; at += 0.1) {
    v.push_back(at);
    every.push_back(steps_per_build(model, 0.25, at));
  }
  result.figure(
      "Steps between two builds of the list", {"speed of approach", "km/s"}, {"steps", ""},
      "The list is rebuilt in the step in which an element has moved more than half the skin.",
      {theory_curve("skin/(v dt)", 0.1, 2, [&](double x) { return std::max(1.0, 0.25 / (x * time_step)); }),
       model_points("counted, skin of 0.25 nm", v, every)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "limit-list-skin";
  c.order = 80;
  c.run = run;
  c.turns_red = {wrong_contact(2)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::list_skin
