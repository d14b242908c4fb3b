// `bench`: the cost of a step and where it goes.
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "bench/line_count.hpp"
#include "bench/machine_peak.hpp"
#include "bench/step_bytes.hpp"
#include "commands/commands.hpp"
#include "model/error.hpp"
#include "run/processor_time.hpp"
#include "scene/prepare.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/contact/line/law.hpp"

namespace ropewalk {
namespace {

struct Timing {
  double wall = 0, processor = 0, contact = 0, bonds = 0, list = 0, integration = 0;
  long builds = 0;
};

// The lists of the contact engine are part of the list.
Timing timing(const Simulation& s, double wall, double processor) {
  const auto& t = s.engine().times();
  const double runs = s.engine().contact() ? s.engine().contact()->list_seconds() : 0;
  return {wall,
          processor,
          t.contact - runs,
          t.bonds,
          s.list_seconds() + runs,
          s.integration_seconds(),
          s.list().builds()};
}

// Everything but the numbers of bytes is per element and step, times in ns.
struct Cost {
  Timing each;
  RadialCount radial;
  int threads = 1;
  double after = 0;  // ps: when it was measured
  double pairs = 0;
  double skin = 0;                   // nm, of the last list
  double bytes = 0, list_bytes = 0;  // per element
  double moved = 0;                  // bytes per element and step, about the least
  double peak_bytes = 0;             // of the program so far
};

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

Timing per_element_step(const Timing& a, const Timing& b, double scale) {
  return {b.wall,
          b.processor,
          (b.contact - a.contact) * scale,
          (b.bonds - a.bonds) * scale,
          (b.list - a.list) * scale,
          (b.integration - a.integration) * scale,
          b.builds - a.builds};
}

constexpr int max_counted = 16000;  // elements

Cost measure(const Scene& scene, const Prepared& prepared, double after, long steps, int threads) {
  use_threads(threads);
  Simulation simulation = start(scene, prepared);
  simulation.steps(std::lround(after / prepared.time_step), false);
  simulation.steps(std::max(5L, steps / 10), false);  // warm caches
  Cost c;
  const Timing before = timing(simulation, 0, 0);
  // Counted a few times on the way: what is within reach changes between two builds of the list.
  const long samples = std::min(10L, steps);
  double wall = 0, processor = 0;
  for (long part = 0; part < samples; ++part) {
    const double began = omp_get_wtime(), used = processor_seconds();
    simulation.steps(steps * (part + 1) / samples - steps * part / samples, false);
    wall += omp_get_wtime() - began;
    processor += processor_seconds() - used;
    if (const auto* line = dynamic_cast<const LineEngine*>(simulation.engine().contact()))
      c.radial.add(count_radial(simulation.topology(), simulation.interaction(), simulation.state(),
                                simulation.list(), line->list(), max_counted),
                   1.0 / static_cast<double>(samples));
  }
  const double n = prepared.topology.elements(), scale = 1e9 / (n * static_cast<double>(steps));
  c.each = per_element_step(before, timing(simulation, wall * scale, processor * scale), scale);
  c.threads = omp_get_max_threads();
  c.after = after;
  c.pairs = static_cast<double>(simulation.list().pairs()) / n;
  c.skin = simulation.list().skin;
  c.list_bytes = static_cast<double>(simulation.list().bytes()) / n;
  c.bytes = static_cast<double>(simulation.bytes()) / n - c.list_bytes;
  c.moved = step_bytes(simulation) / n;
  c.peak_bytes = peak_bytes();
  return c;
}

double per(double sum, double count) { return count > 0 ? sum / count : 0.0; }

double operations_per_ns(const Cost& c, const Interaction& in) {
  return per(c.radial.evaluations * radial_operations(in.precision), c.each.contact);
}

// The rates of a scene and those of the machine: GFLOP/s in contact and GB/s.
struct Rates {
  double operations = 0, moved = 0;
  MachinePeak peak;

  double share_of_arithmetic() const { return per(operations, peak.arithmetic); }
  double share_of_transfer() const { return per(moved, peak.transfer); }
};

// The machine with as many threads as work on a scene of this size.
Rates rates_of(const Cost& c, const Prepared& prepared) {
  const bool parallel = prepared.topology.elements() > static_cast<int>(parallel_from);
  return {operations_per_ns(c, prepared.interaction), per(c.moved, c.each.wall),
          machine_peak(parallel ? c.threads : 1, prepared.interaction.precision == Interaction::Precision::full)};
}

nlohmann::ordered_json json_of(const Cost& c, const Rates& rates, const BenchArguments& a,
                               const Prepared& prepared) {
  nlohmann::ordered_json out;
  out["scene"] = a.scene;
  out["elements"] = prepared.topology.elements();
  out["threads"] = c.threads;
  out["steps"] = a.steps;
  out["after_ps"] = c.after;
  out["time_step_fs"] = prepared.time_step / units::fs;
  out["ns_per_element_step"] = c.each.wall;
  out["processor_ns_per_element_step"] = c.each.processor;
  out["pairs_per_element"] = c.pairs;
  out["ns_per_pair"] = per(c.each.contact, c.pairs);
  out["split_ns_per_element_step"] = {{"contact", c.each.contact},
                                      {"bonds", c.each.bonds},
                                      {"list", c.each.list},
                                      {"integration", c.each.integration}};
  out["list_builds"] = c.each.builds;
  out["list_skin_nm"] = c.skin;
  out["list_share"] = per(c.each.list, c.each.wall);
  if (dynamic_cast<const LineLaw*>(prepared.interaction.law.get())) {
    out["instructions"] = instructions_in_use();
    out["lanes"] = radial_lanes(prepared.interaction.precision);
    out["spans_per_element"] = c.radial.spans;
    out["nodes_per_span"] = per(c.radial.nodes, c.radial.spans);
    out["radial_evaluations_per_element_step"] = c.radial.evaluations;
    out["radial_evaluations_useful"] = c.radial.useful;
    out["ns_per_radial_evaluation"] = per(c.each.contact, c.radial.evaluations);
    out["contact_GFLOP_per_s"] = rates.operations;
    out["contact_share_of_peak"] = rates.share_of_arithmetic();
  }
  out["moved_bytes_per_element_step"] = c.moved;
  out["moved_GB_per_s"] = rates.moved;
  out["moved_share_of_peak"] = rates.share_of_transfer();
  out["machine"] = {{"peak_GFLOP_per_s", rates.peak.arithmetic}, {"peak_GB_per_s", rates.peak.transfer}};
  out["bytes_per_element"] = c.bytes;
  out["list_bytes_per_element"] = c.list_bytes;
  out["peak_resident_MB"] = c.peak_bytes * 1e-6;
  return out;
}

void print(const Cost& c, const BenchArguments& a, const Prepared& prepared) {
  const Timing& t = c.each;
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
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  use_instructions(a.instructions);
  const double after = a.after < 0 ? bench_after(a.scene) : a.after;
  std::vector<Cost> costs;
  for (const int threads : a.threads) {
    costs.push_back(measure(scene, prepared, after, a.steps, threads));
    if (!a.json) print(costs.back(), a, prepared);
  }
  // The machine last: what is measured there takes more memory than most scenes, and would be in their peaks.
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const Cost& cost : costs) {
    const Rates rates = rates_of(cost, prepared);
    if (a.json) {
      all.push_back(json_of(cost, rates, a, prepared));
    } else {
      print(rates, cost.threads);
    }
  }
  if (a.json) fmt::print("{}\n", (all.size() == 1 ? all[0] : all).dump(1));
  return 0;
}

}  // namespace ropewalk
