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
  fmt::print("{:9.1f} GB/s moved, about\n", per(c.moved, t.wall));
  fmt::print("{:9.2f} s of wall time per simulated ns\n", t.wall * n * 1e-9 / prepared.time_step * 1e3);
}

}  // namespace

int bench_command(const BenchArguments& a) {
  if (a.list) {
    for (const BenchScene& s : bench_scenes()) fmt::print("{:18} {}\n", s.name, s.description);
    return 0;
  }
  if (a.scene.empty())
    throw InputError({"", 0, "scene"}, "is missing", "give a file, or see `ropewalk bench --list`");
  if (names_device(a.device)) return bench_device(a);
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  use_instructions(a.instructions);
  const double after = a.after < 0 ? bench_after(a.scene) : a.after;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const int threads : a.threads) {
    use_threads(threads);
    const StepCost cost = cost_of_step(scene, prepared, after, a.steps);
    if (a.json) {
      all.push_back(json_of(cost, a.scene, a.steps, prepared));
    } else {
      print(cost, a, prepared);
    }
  }
  if (a.json) fmt::print("{}\n", (all.size() == 1 ? all[0] : all).dump(1));
  return 0;
}

}  // namespace ropewalk
