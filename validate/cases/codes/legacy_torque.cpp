// The energy of a bundle whose contact forces lack the torque of an angle.
#include <algorithm>
#include <cmath>

#include "cases/common/chain.hpp"
#include "model/error.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::legacy_torque {
namespace {

constexpr double duration = 400, step = 0.016, enough = 150;  // ps, ps, eV

struct Record {
  std::vector<double> time, gain;  // ps, eV

  double mean(std::size_t from, std::size_t to) const {
    double sum = 0;
    for (std::size_t k = from; k < to; ++k) sum += gain[k];
    return sum / static_cast<double>(to - from);
  }
  // Mean of the last quarter minus that of the first, which the oscillation of the integrator does not affect.
  double drift() const {
    const std::size_t n = gain.size();
    return n < 8 ? gain.back() : mean(n - n / 4, n) - mean(0, n / 4);
  }
};

Record undamped_bundle(const ParameterSet& set, bool legacy) {
  Scene scene;
  scene.sets = {set};
  scene.element_length = set.element_length;
  RopeSource rope;
  rope.tubes = 7;
  rope.length = 5 * set.element_length;
  scene.source = std::make_shared<RopeSource>(rope);
  scene.start.temperature = 10;
  scene.contact.legacy_torque = legacy;
  scene.run.time_step = step;
  scene.run.duration = duration;
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double first = s.total_energy();
  Record record{{0}, {0}};
  try {
    const long steps = std::lround(duration / step), every = steps / 200;
    for (long k = 1; k <= steps && record.gain.back() < enough; ++k) {
      s.step();
      if (k % every != 0) continue;
      record.time.push_back(s.state().time);
      record.gain.push_back(s.total_energy() - first);
    }
  } catch (const NumericalError&) {
    // After a blow-up the energy gained before counts.
  }
  return record;
}

CaseResult run(const CaseContext& context) {
  const ParameterSet model = context.model();
  const Record full = undamped_bundle(model, context.fault.missing_torque);
  const Record legacy = undamped_bundle(model, true);
  CaseResult result;
  result.check_absolute("drift of the energy, full gradient", full.drift(), 0, 0.1, "eV",
                        "1e-3 of the cohesion; oscillation of the time step");
  result.show_absolute("largest energy gained without the torque",
                       *std::max_element(legacy.gain.begin(), legacy.gain.end()), 0, 0.1, "eV",
                       "stopped at 150 eV");
  result.figure("Energy of an undamped bundle of seven tubes", {"time", "ps"}, {"energy gained", "eV"},
                "No load, no damping, 10 K at the start: every change of the energy is an error.",
                {theory_curve("conserved", 0, duration, [](double) { return 0.0; }),
                 model_points("full gradient", full.time, full.gain),
                 model_points("without the torque", legacy.time, legacy.gain, 2)});
  result.remarks.push_back(
      "A contact energy that depends on an angle exerts a torque. Without this torque the forces are not the "
      "gradient of the energy, and the bundle heats up at any time step.");
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "legacy-torque";
  c.group = Case::Group::codes;
  c.order = 20;
  c.law = Case::Law::paper;
  c.sets = {"cnt-10-10-paper"};
  c.only_these = "it shows what the published code does with the published set";
  c.title = "The torque that the published contact code leaves out";
  c.why =
      "A rope that gains energy from its own contact forces shows instabilities that a real rope does not have.";
  c.setup =
      "Seven tubes of five elements with the paper law, undamped, at 10 K at the start, run for 400 ps at 16 fs: "
      "once with the full gradient, once without the torque that belongs to the angle of the line of centres.";
  c.oracle = "Conservation of energy.";
  c.literature =
      "I. Ostanin, R. Ballarini, D. Potyondy, T. Dumitrica, J. Mech. Phys. Solids 61, 762 (2013), DOI "
      "10.1016/j.jmps.2012.10.016; public code: waLBerla, module MESA-PD";
  c.run = run;
  c.turns_red = {without_torque()};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::legacy_torque
