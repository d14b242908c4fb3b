// Standing waves of one free tube.
#include <cmath>

#include "cases/common/chain.hpp"

namespace ropewalk::validate::wave_speeds {
namespace {

constexpr int bonds = 60;

struct StandingWave {
  double speed = 0;
  std::vector<double> time, amplitude;  // up to half a period
};

// The first mode of a free chain, started with velocities only. The projection of the velocities on the mode passes
// zero after a quarter of the period. The free ends lie half an element beyond the last centres.
StandingWave standing_wave(const ParameterSet& set, bool torsion) {
  Chain c(set, bonds);
  const auto mode = [&](int i) { return std::cos(units::pi * (i + 0.5) / (c.last + 1)); };
  const double start = 1e-3;
  for (int i = 0; i <= c.last; ++i)
    (torsion ? c.state.angular_velocity : c.state.velocity)
        .set(static_cast<std::size_t>(i), {0, 0, start * mode(i)});
  Simulation s = c.make(0.2);
  StandingWave wave;
  const auto project = [&] {
    double sum = 0, norm = 0;
    for (int i = 0; i <= c.last; ++i) {
      const auto e = static_cast<std::size_t>(i);
      sum += mode(i) * (torsion ? s.state().angular_velocity.z[e] : s.state().velocity.z[e]);
      norm += mode(i) * mode(i);
    }
    wave.time.push_back(s.state().time);
    wave.amplitude.push_back(sum / norm / start);
    return wave.amplitude.back();
  };
  double before = project();
  for (int k = 0; k < 100000 && before > -0.9; ++k) {
    s.step();
    const double after = project();
    if (before > 0 && after <= 0) {
      const double zero = s.state().time - s.time_step() * after / (after - before);
      wave.speed = (c.last + 1) * set.element_length / (2 * zero);
    }
    before = after;
  }
  return wave;
}

ChartLine thinned(const std::string& name, const StandingWave& wave, int colour) {
  std::vector<double> x, y;
  const std::size_t every = std::max<std::size_t>(1, wave.time.size() / 24);
  for (std::size_t k = 0; k < wave.time.size(); k += every) {
    x.push_back(wave.time[k]);
    y.push_back(wave.amplitude[k]);
  }
  return model_points(name, x, y, colour);
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model(), oracle = context.set();
  const double mass = oracle.element_mass(1);
  const double axial = std::sqrt(oracle.bond.stretch / mass);
  const double torsional = std::sqrt(oracle.bond.twist / oracle.element_inertia(1));
  const StandingWave a = standing_wave(model, false), t = standing_wave(model, true);
  CaseResult result;
  result.check_relative("axial wave speed", a.speed, axial, 3e-3, "km/s",
                        "discrete chain and time step: below 1e-3");
  result.check_relative("torsional wave speed", t.speed, torsional, 3e-3, "km/s",
                        "discrete chain and time step: below 1e-3");
  const double k = units::pi / ((bonds + 1) * oracle.element_length);
  result.figure(
      "First standing waves of a free tube", {"time", "ps"}, {"velocity of the mode, relative", ""},
      "Velocity of the first axial and torsional mode of a free tube.",
      {theory_curve("axial, theory", 0, a.time.back(), [&](double x) { return std::cos(k * axial * x); }),
       thinned("axial, chain", a, 1),
       theory_curve("torsion, theory", 0, t.time.back(), 2, [&](double x) { return std::cos(k * torsional * x); }),
       thinned("torsion, chain", t, 3)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "wave-speeds";
  c.order = 60;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {wrong_EA(1.1), wrong_GJ(0.9)};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::wave_speeds
