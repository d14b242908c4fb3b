#include "bench/step_cost.hpp"

#include <omp.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/step_bytes.hpp"
#include "io/clocks.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/shorter_steps.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

// The lists of the contact engine are part of the list.
StepTiming timing(const Simulation& s, double wall, double processor) {
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

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024;
}

StepTiming per_element_step(const StepTiming& a, const StepTiming& b, double scale) {
  return {b.wall,
          b.processor,
          (b.contact - a.contact) * scale,
          (b.bonds - a.bonds) * scale,
          (b.list - a.list) * scale,
          (b.integration - a.integration) * scale,
          b.builds - a.builds};
}

constexpr int max_counted = 16000;  // elements

StepCost cost_in(Simulation& simulation, const Prepared& prepared, double after, long steps) {
  simulation.steps(std::llround(after / prepared.time_step), false);
  simulation.steps(std::max(5L, steps / 10), false);  // warm caches
  StepCost c;
  const StepTiming before = timing(simulation, 0, 0);
  // Counted a few times on the way: the pairs within reach change between two builds of the list.
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
  c.threads = threads_in_use();
  c.after = after;
  c.pairs = static_cast<double>(simulation.list().pairs()) / n;
  c.skin = simulation.list().skin;
  c.list_bytes = static_cast<double>(simulation.list().bytes()) / n;
  c.bytes = static_cast<double>(simulation.bytes()) / n - c.list_bytes;
  c.moved = step_bytes(simulation) / n;
  c.peak_bytes = peak_bytes();
  return c;
}

}  // namespace

StepCost cost_of_step(const Scene& scene, const Prepared& prepared, double after, long steps) {
  return with_shorter_steps(start(scene, prepared),
                            [&](Simulation& simulation) { return cost_in(simulation, prepared, after, steps); });
}

double per(double sum, double count) { return count > 0 ? sum / count : 0.0; }

double operations_per_ns(const StepCost& c, const Interaction& in) {
  return per(c.radial.evaluations * radial_operations(in.precision), c.each.contact);
}

nlohmann::ordered_json json_of(const StepCost& c, const std::string& scene, long steps, const Prepared& prepared) {
  nlohmann::ordered_json out;
  out["scene"] = scene;
  out["elements"] = prepared.topology.elements();
  out["threads"] = c.threads;
  out["steps"] = steps;
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
    out["contact_GFLOP_per_s"] = operations_per_ns(c, prepared.interaction);
  }
  out["moved_bytes_per_element_step"] = c.moved;
  out["moved_GB_per_s"] = per(c.moved, c.each.wall);
  out["bytes_per_element"] = c.bytes;
  out["list_bytes_per_element"] = c.list_bytes;
  out["peak_resident_MB"] = c.peak_bytes * 1e-6;
  return out;
}

}  // namespace ropewalk
