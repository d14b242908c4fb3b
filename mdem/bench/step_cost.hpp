// The cost of a step and where it goes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/line_count.hpp"
#include "scene/prepare.hpp"

namespace ropewalk {

struct StepTiming {
  double wall = 0, processor = 0, contact = 0, bonds = 0, list = 0, integration = 0;
  long builds = 0;
};

// Everything but the numbers of bytes is per element and step, times in ns.
struct StepCost {
  StepTiming each;
  RadialCount radial;
  int threads = 1;
  double after = 0;  // ps: when it was measured
  double pairs = 0;
  double skin = 0;                   // skin of the last list, nm
  double bytes = 0, list_bytes = 0;  // per element
  double moved = 0;                  // bytes per element and step, about the least
  double peak_bytes = 0;             // largest resident memory of the program so far
};

// After so much time (ps), on as many threads as OpenMP has now.
StepCost cost_of_step(const Scene& scene, const Prepared& prepared, double after, long steps);

// a/b, and 0 where b is 0.
double per(double sum, double count);

// Operations of the contact, 1e9/s.
double operations_per_ns(const StepCost& cost, const Interaction& interaction);

// `scene`: its name.
nlohmann::ordered_json json_of(const StepCost& cost, const std::string& scene, long steps,
                               const Prepared& prepared);

}  // namespace ropewalk
