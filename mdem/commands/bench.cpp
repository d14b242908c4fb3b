// `bench`: the cost of a step and where it goes.
#include <fmt/format.h>
#include <omp.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

struct Timing {
  double wall = 0, frames = 0, contact = 0, bonds = 0, list = 0, integration = 0;
  long builds = 0;
};

Timing timing(const Simulation& s, double wall) {
  const auto& t = s.engine().times();
  return {wall, t.frames, t.contact, t.bonds, s.list_seconds(), s.integration_seconds(), s.list().builds()};
}

}  // namespace

int bench_command(const BenchArguments& a) {
  use_threads(a.threads);
  Scene scene = read_scene(a.scene);
  const Prepared prepared = prepare(scene);
  Simulation simulation = start(scene, prepared);
  for (long k = 0; k < std::max(5L, a.steps / 10); ++k) simulation.step();  // warm caches
  const Timing before = timing(simulation, omp_get_wtime());
  for (long k = 0; k < a.steps; ++k) simulation.step();
  const Timing after = timing(simulation, omp_get_wtime());

  const double n = prepared.topology.elements();
  const double scale = 1e9 / (n * static_cast<double>(a.steps));
  const double wall = (after.wall - before.wall) * scale;
  const double contact = (after.contact - before.contact) * scale, bonds = (after.bonds - before.bonds) * scale;
  const double frames = (after.frames - before.frames) * scale, list = (after.list - before.list) * scale;
  const double integration = (after.integration - before.integration) * scale;
  const double pairs = static_cast<double>(simulation.list().pairs()) / n;
  const double bytes = static_cast<double>(simulation.bytes() - simulation.list().bytes()) / n;
  const double list_bytes = static_cast<double>(simulation.list().bytes()) / n;
  if (a.json) {
    nlohmann::ordered_json out;
    out["scene"] = a.scene;
    out["elements"] = prepared.topology.elements();
    out["threads"] = omp_get_max_threads();
    out["steps"] = a.steps;
    out["time_step_fs"] = prepared.time_step / units::fs;
    out["ns_per_element_step"] = wall;
    out["pairs_per_element"] = pairs;
    out["ns_per_pair"] = pairs > 0 ? contact / pairs : 0.0;
    out["split_ns_per_element_step"] = {
        {"contact", contact}, {"bonds", bonds}, {"frames", frames}, {"list", list}, {"integration", integration}};
    out["list_builds"] = after.builds - before.builds;
    out["bytes_per_element"] = bytes;
    out["list_bytes_per_element"] = list_bytes;
    fmt::print("{}\n", out.dump(1));
    return 0;
  }
  fmt::print("{} elements, {} threads, {} steps of {:.3g} fs\n", prepared.topology.elements(),
             omp_get_max_threads(), a.steps, prepared.time_step / units::fs);
  fmt::print("{:9.1f} ns per element-step\n{:9.1f} pairs per element (half list)\n", wall, pairs);
  fmt::print("  contact {:.1f}  bonds {:.1f}  frames {:.1f}  list {:.1f}  integration {:.1f} ns\n", contact, bonds,
             frames, list, integration);
  fmt::print("{:9.0f} bytes per element, and {:.0f} for the list\n", bytes, list_bytes);
  fmt::print("{:9.2f} s of wall time per simulated ns\n", wall * n * 1e-9 / prepared.time_step * 1e3);
  return 0;
}

}  // namespace ropewalk
