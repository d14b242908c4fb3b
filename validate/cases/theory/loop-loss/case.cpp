// A rope turned and turned back: the lost energy against the rate.
#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "cases/common/scene_of_case.hpp"
#include "cases/common/torsion_machine.hpp"
#include "core/checks.hpp"
#include "observe/growth.hpp"
#include "scene/prepare.hpp"

namespace ropewalk::validate::loop_loss {
namespace {

constexpr int elements = 20;
constexpr double twist = 1.2;  // deg/nm

struct Loop {
  double lost = 0, put_in = 0;  // eV
  double open = 0;              // eV, that the energy balance misses
};

// The loss is what damping has taken after a hold in which the rope comes to rest.
Loop turned_and_back(const ParameterSet& set, double rate) {
  const double length = elements * set.element_length, turn = twist * length;
  const double there = turn / rate, hold = 60;
  Scene scene = scene_of_case(
      "loop-loss", set,
      {{"rope.length_nm", fmt::to_string(length)},
       {"grip.1.about_z.rotation_deg",
        fmt::format("[[0, 0], [{}, {}], [{}, 0], [{}, 0]]", there, turn, 2 * there, 2 * there + hold)},
       {"grip.1.smooth_ps", fmt::to_string(0.25 * there)}});
  const Prepared p = prepare(scene);
  Simulation s = start(scene, p);
  const double first = s.total_energy();
  Loop out;
  const long steps = std::lround(p.duration / p.time_step), parts = 200;
  for (long k = 0; k < parts; ++k) {
    s.steps((k + 1) * steps / parts - k * steps / parts);
    out.put_in = std::max(out.put_in, s.work());
  }
  out.lost = s.dissipated();
  out.open = s.total_energy() - s.account().supplied() - first;
  return out;
}

CaseResult run(const CaseContext& context) {
  const CaseTube tube = context.tube();
  CaseResult result;
  std::vector<double> rates, losses;
  double open = 0, slowest = 0;
  for (const double rate : {1.5, 0.5, 0.15, 0.05, 0.015}) {
    if (context.brief && rate < 0.05) continue;
    if (context.progress) context.progress(fmt::format("{} degrees per ps", rate));
    const Loop loop = turned_and_back(tube.model, rate);
    rates.push_back(std::log10(rate));
    losses.push_back(std::log10(loop.lost));
    slowest = loop.put_in;
    open = std::max(open, std::fabs(loop.open) / loop.put_in);
  }
  const StraightLine fit = *line_through(rates, losses);
  result.check_absolute("exponent of the loss", fit.b, 1, 0.1, "",
                        "two decades of the rate, all slower than sound");
  result.check_absolute("energy balance, part of the work", open, 0, 2e-3, "",
                        "the error of the integration over a whole loop");
  const RopeInMachine rope(tube.set, 7, elements);
  const double turned = twist * units::degree * elements * tube.set.element_length / rope.bonded();
  result.check_relative("energy put in at the slowest rate", slowest,
                        7 * rope.theory(tube.set, turned, RopeInMachine::Length::held).energy, 2e-2, "eV",
                        "that of a rope turned infinitely slowly");
  const auto mean = [](const std::vector<double>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  const double level = mean(losses) - mean(rates);
  result.figure("Loss of a loop against its rate", {"log₁₀ of the rate in °/ps", ""},
                {"log₁₀ of the loss in eV", ""},
                "Seven tubes turned and turned back between clamps at fixed length.",
                {theory_curve("proportional", rates.back(), rates.front(), [&](double x) { return level + x; }),
                 model_points("loops", rates, losses)});
  return result;
}

const RegisteredCase registered([] {
  Case c;
  c.name = "loop-loss";
  c.order = 180;
  c.tier = Case::Tier::full;
  c.law = Case::Law::none;
  c.run = run;
  c.turns_red = {{wrong_GJ(1.1), {"put in"}}};
  return c;
});

}  // namespace
}  // namespace ropewalk::validate::loop_loss
