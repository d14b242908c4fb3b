// A point of the chart and its file.
#pragma once

#include <map>
#include <optional>
#include <string>

namespace ropewalk::validate {

// One model in one scene, as in the file of its result.
struct ChartPoint {
  std::string key;    // hash of program, scene and settings; a result with another key is stale
  std::string error;  // why the model could not be run
  std::string scene, model, kind, law, integrator, mode, precision;
  int nodes = 0, elements = 0;
  double cutoff = 0, element_length = 0;  // nm
  double time_step = 0;                   // time step of the bonds, ps
  double mass_scale = 1, contact_viscosity = 0, bond_damping = 0;
  double simulated = 0;  // ps
  double steps = 0;
  double cpu = 0;                      // s
  std::optional<double> instructions;  // per element-step
  std::map<std::string, double> values;

  double element_steps_per_ns() const { return elements * steps / (1e-3 * simulated); }
  double cpu_per_ns() const { return cpu / (1e-3 * simulated); }
  double cpu_per_element_step() const { return cpu / (elements * steps); }
};

std::string point_json(const ChartPoint& point);
// Throws InputError where the file is not such a point.
ChartPoint read_point(const std::string& path);

}  // namespace ropewalk::validate
