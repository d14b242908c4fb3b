// `bench --parts N` measures the cost of copied elements when a scene is divided among N processes.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "bench/parts.hpp"
#include "commands/commands.hpp"
#include "scene/prepare.hpp"
#include "sim/dynamics/shorter_steps.hpp"

namespace ropewalk {
namespace {

// Sums over all parts of a cut.
struct PartsRow {
  double parts = 0, own = 0, copies = 0;  // elements, of a part on average
  double seconds = 0, longest = 0;        // all parts one after another, and the slowest one
};

PartsRow row_of(const std::vector<PartCost>& parts) {
  PartsRow row;
  row.parts = static_cast<double>(parts.size());
  for (const PartCost& p : parts) {
    row.own += p.own / row.parts;
    row.copies += p.copies / row.parts;
    row.seconds += p.seconds;
    row.longest = std::max(row.longest, p.seconds);
  }
  return row;
}

}  // namespace

int bench_parts(const BenchArguments& a) {
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  const State in_motion = with_shorter_steps(start(scene, prepared), [&](Simulation& simulation) {
    simulation.steps(a.steps, false);
    return simulation.state();
  });
  const auto cuts =
      cost_of_parts(prepared.topology, prepared.interaction, in_motion, a.parts, scene.source->is_parallel());
  const ElementCost each = fit(cuts);
  const double whole = row_of(cuts.front()).seconds;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!a.json)
    fmt::print("{:>6} {:>14} {:>10} {:>14} {:>10} {:>10}\n", "parts", "own, each", "copies", "us, all parts",
               "of whole", "slowest");
  for (const auto& parts : cuts) {
    const PartsRow r = row_of(parts);
    const double slowest = r.longest * r.parts / r.seconds;  // of the mean
    if (a.json) {
      rows.push_back({{"parts", parts.size()},
                      {"own", r.own},
                      {"copies", r.copies},
                      {"microseconds", r.seconds * 1e6},
                      {"of_whole", r.seconds / whole},
                      {"slowest_of_mean", slowest}});
    } else {
      fmt::print("{:6} {:14.0f} {:10.0f} {:14.1f} {:10.3f} {:10.3f}\n", parts.size(), r.own, r.copies,
                 r.seconds * 1e6, r.seconds / whole, slowest);
    }
  }
  if (a.json) {
    nlohmann::ordered_json out;
    out["scene"] = a.scene;
    out["elements"] = prepared.topology.elements();
    out["cuts"] = rows;
    out["ns_per_own_element"] = each.own * 1e9;
    out["ns_per_copy"] =
        each.copy * 1e9;  // less than zero where smaller parts gain more by caches than copies cost
    fmt::print("{}\n", out.dump(1));
  } else if (each.copy > 0) {
    fmt::print("An evaluation of all forces takes {:.1f} ns for each own element and {:.1f} ns for each copy\n",
               each.own * 1e9, each.copy * 1e9);
  } else if (cuts.size() > 1) {
    fmt::print("Smaller parts gain more by the caches than the copies cost\n");
  }
  return 0;
}

}  // namespace ropewalk
