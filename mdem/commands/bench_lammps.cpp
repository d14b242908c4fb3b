// `bench --lammps N`: the simulator on N threads beside LAMMPS on N ranks.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "commands/commands.hpp"
#include "commands/siblings.hpp"
#include "exchange/lammps_timing.hpp"

namespace ropewalk {

int bench_lammps(const BenchArguments& a) {
  constexpr int rounds = 5;
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  const auto [native, lammps] =
      time_beside_lammps(scene, find_program("lammps", "lmp-ropewalk"), a.lammps, a.steps, a.plain, rounds);
  const double each = 1e9 / (static_cast<double>(prepared.topology.elements()) * static_cast<double>(a.steps)),
               ratio = lammps.wall / native.wall, processor_ratio = lammps.processor / native.processor;
  if (a.json) {
    nlohmann::ordered_json out;
    out["scene"] = a.scene;
    out["elements"] = prepared.topology.elements();
    out["steps"] = a.steps;
    out["rounds"] = rounds;
    out["threads_or_ranks"] = a.lammps;
    out["forces"] = a.plain ? "plain" : "engine";
    out["native_ns_per_element_step"] = native.wall * each;
    out["lammps_ns_per_element_step"] = lammps.wall * each;
    out["lammps_over_native"] = ratio;
    out["native_processor_ns_per_element_step"] = native.processor * each;
    out["lammps_processor_ns_per_element_step"] = lammps.processor * each;
    out["lammps_over_native_processor"] = processor_ratio;
    fmt::print("{}\n", out.dump(1));
    return 0;
  }
  const char* s = a.lammps == 1 ? "" : "s";
  fmt::print(
      "{} elements, {} steps from the start, the shortest of {} rounds by turns\n"
      "{:9.1f} ns per element-step, {:.1f} of processor time: native on {} thread{}\n"
      "{:9.1f} ns per element-step, {:.1f} of processor time: LAMMPS on {} rank{}{}\n"
      "{:9.2f} times as long, {:.2f} times the processor time\n",
      prepared.topology.elements(), a.steps, rounds, native.wall * each, native.processor * each, a.lammps, s,
      lammps.wall * each, lammps.processor * each, a.lammps, s, a.plain ? ", by the plain forms" : "", ratio,
      processor_ratio);
  return 0;
}

}  // namespace ropewalk
