// The energy of a bundle whose contact forces lack the torque of an angle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/common/chain.hpp"
#include "cases/common/scene_of_case.hpp"
#include "model/error.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::legacy_torque {
namespace {

constexpr double enough = 150;  // eV

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
  Scene scene = scene_of_case("legacy-torque", set,
                              {{"rope.length_nm", fmt::to_string(5 * set.element_length)},
                               {"contact.legacy_torque", legacy ? "true" : "false"}});
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double first = s.total_energy();
  Record record{{0}, {0}};
  try {
    const long steps = std::lround(p.duration / p.time_step), every = steps / 200;
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
                {theory_curve("conserved", 0, full.time.back(), [](double) { return 0.0; }),
                 model_points("full gradient", full.time, full.gain),
                 model_points("without the torque", legacy.time, legacy.gain, 2)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "legacy-torque";
  c.order = 20;
  c.law = Case::Law::paper;
  c.sets = {"cnt-10-10-paper"};
  c.only_these = "it shows what the published code does with the published set";
  c.run = run;
  c.turns_red = {without_torque()};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::legacy_torque
