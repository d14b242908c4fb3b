// The knobs of a model that the chart has varied. One table says of each which charted models vary it, what is
// better, where it may be used, and what it writes into a scene.
#pragma once

#include <string>
#include <vector>

#include "plan/chart.hpp"
#include "plan/planned_scene.hpp"

namespace ropewalk {

struct KnobUse {
  const ChartedScene& charted;  // the scene of the chart that stands for this one
  const Scene& scene;
  const SceneFeatures& features;
  bool end_state;  // the motion itself does not matter
};

struct Knob {
  enum class Id { cutoff, integrator, length, levels, mass, mode, nodes, precision, step };
  struct Key {
    const char *table, *key;
    bool (*typed)(const Scene&);
  };

  Id id;
  std::vector<std::string> kinds;          // ChartedModel::kind of the models that vary it
  double (*quality)(const ChartedModel&);  // larger is better, whatever the number means
  bool (*applies)(const KnobUse&, const ChartedModel&);
  void (*write)(PlannedScene&, const ChartedModel& chosen, const ChartedModel& standard, const std::string& why);
  std::vector<Key> keys = {};  // that are left to the program before anything is chosen
  bool in_time = false;        // without effect on a relaxation
};

const std::vector<Knob>& all_knobs();

// None where the model varies something else, or nothing.
const Knob* knob_of(const ChartedModel& model);

// Why there is no relaxation in the place of the motion; empty: there can be.
std::string needs_time(const Scene& scene);

}  // namespace ropewalk
