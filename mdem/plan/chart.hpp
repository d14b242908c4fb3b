// The chart of speed against accuracy, as the planner reads it.
//
//   points.csv   one row per scene, model and observable: the model's knobs, its cost, the observable and how far
//   it
//                is off (a fraction) the finest model of the scene or atoms. Every model differs from that of kind
//                "default" in one knob, its kind.
//   scenes.csv   what each scene of the chart covers: the largest curvature and twist per length of its tubes, the
//                angles at which they cross, and what leads it.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace ropewalk {

// What a scene is driven by answers with the rest: moments with the end moment, loads with angles and bends.
enum class DrivenBy { rotation, load, nothing };  // nothing: free, or held where it is
const char* words_of(DrivenBy by);               // "rotation", ...

struct ChartedValue {
  std::string unit;
  double value = 0, reference = 0, error = 0;
};

struct ChartedModel {
  std::string name, kind, law, integrator, mode, precision;
  int nodes = 0, contact_every = 1, elements = 0;
  double cutoff = 0, element_length = 0;  // nm
  double time_step = 0;                   // fs
  double mass_scale = 1;
  double simulated = 0;                        // ps
  double cpu_per_ns = 0;                       // s
  double ns_per_element_step = 0;              // of CPU time
  std::map<std::string, ChartedValue> finest;  // by observable, against the finest model
  std::map<std::string, ChartedValue> atoms;   // against molecular dynamics
};

struct ChartedScene {
  std::string name;
  bool contact = false;
  int tubes = 1;
  double radius = 0;                          // nm
  double curvature = 0, twist = 0;            // 1/nm, rad/nm
  double crossing_from = 0, crossing_to = 0;  // deg
  DrivenBy driven_by = DrivenBy::rotation;
  bool energy_above_start = true;  // or all of it
  std::vector<ChartedModel> models;

  // Of kind "default"; null where there is none.
  const ChartedModel* standard() const;
};

// Scenes of scenes.csv with their models of points.csv. Throws InputError.
std::vector<ChartedScene> read_chart(const std::string& directory);

}  // namespace ropewalk
