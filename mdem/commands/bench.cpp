// `bench`: the cost of a step and where it goes.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "bench/step_cost.hpp"
#include "commands/commands.hpp"
#include "model/error.hpp"
#include "run/use_device.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

void print(const StepCost& c, const BenchArguments& a, const Prepared& prepared) {
  const StepTiming& t = c.each;
  const double n = prepared.topology.elements();
  fmt::print("{} elements, {} thread{}, {} steps of {:.3g} fs\n", n, c.threads, c.threads == 1 ? "" : "s", a.steps,
             prepared.time_step / units::fs);
  fmt::print("{:9.1f} ns per element-step, {:.1f} of processor time\n", t.wall, t.processor);
  fmt::print("{:9.1f} pairs per element (half list)\n", c.pairs);
  fmt::print(
      "  contact {:.1f}  bonds {:.1f}  list {:.1f}  integration {:.1f} ns; {} lists, the last with "
      "a skin of {:.3g} nm\n",
      t.contact, t.bonds, t.list, t.integration, t.builds, c.skin);
  if (c.radial.spans > 0)
    fmt::print(
        "{:9.1f} spans of neighbours per element, {:.1f} nodes each; {:.0f} radial evaluations, {:.0f} % of them "
        "within the "
        "cutoff, {:.3f} ns each; {:.1f} GFLOP/s in contact\n",
        c.radial.spans, per(c.radial.nodes, c.radial.spans), c.radial.evaluations,
        100 * per(c.radial.useful, c.radial.evaluations), per(t.contact, c.radial.evaluations),
        operations_per_ns(c, prepared.interaction));
  fmt::print("{:9.0f} bytes per element, and {:.0f} for the list; {:.0f} MB resident at most\n", c.bytes,
             c.list_bytes, c.peak_bytes * 1e-6);
  fmt::print("{:9.2f} s of wall time per simulated ns\n", t.wall * n * 1e-9 / prepared.time_step * 1e3);
}

void print(const Rates& rates, int threads) {
  const double share = rates.share_of_transfer();
  fmt::print("{:9.1f} GB/s moved on {} thread{}, about; memory gives {:.1f} here, {}", rates.moved, threads,
             threads == 1 ? "" : "s", rates.peak.transfer,
             share <= 1 ? fmt::format("{:.0f} % of it is used", 100 * share) : "caches the rest");
  if (rates.operations > 0)
    fmt::print("; contact at {:.0f} % of {:.0f} GFLOP/s", 100 * rates.share_of_arithmetic(), rates.peak.arithmetic);
  fmt::print("\n");
}

}  // namespace

int bench_command(const BenchArguments& a) {
  if (a.list) {
    for (const BenchScene& s : bench_scenes()) fmt::print("{:18} {}\n", s.name, s.description);
    return 0;
  }
  if (a.scene.empty())
    throw InputError({"", 0, "scene"}, "is missing", "give a file, or see `ropewalk bench --list`");
  if (a.lammps > 0) return bench_lammps(a);
  if (a.parts > 0) return bench_parts(a);
  if (names_device(a.device)) return bench_device(a);
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  use_instructions(a.instructions);
  const double after = a.after < 0 ? bench_after(a.scene) : a.after;
  std::vector<StepCost> costs;
  for (const int threads : a.threads) {
    use_threads(threads);
    costs.push_back(cost_of_step(scene, prepared, after, a.steps));
    if (!a.json) print(costs.back(), a, prepared);
  }
  // The machine last: what is measured there takes more memory than most scenes, and would be in their peaks.
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const StepCost& cost : costs) {
    const Rates rates = rates_of(cost, prepared);
    if (a.json) {
      all.push_back(json_of(cost, rates, a.scene, a.steps, prepared));
    } else {
      print(rates, cost.threads);
    }
  }
  if (a.json) fmt::print("{}\n", (all.size() == 1 ? all[0] : all).dump(1));
  return 0;
}

}  // namespace ropewalk
