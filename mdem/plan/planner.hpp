// Which model a scene needs: of those that the chart has measured, the cheapest that holds an error.
//
// The nearest scene of the chart stands for the scene to be planned. Nearest means, in this order: driven in the
// same way, not much shorter, then alike in curvature, twist and number of tubes. There, a knob that is set to o
// instead of its best value b changes an observable by |value(o) - value(b)|. The planner adds the sizes of these
// changes over all knobs, and the part of the default's error against the finest model that no knob explains. It
// multiplies the costs. How the element length changes the number of elements and the stable step follows from the
// scene itself. That changes add up is an assumption; where they cancel, the sum is too large. spot_check() tests
// it on a run.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "plan/chart.hpp"
#include "plan/features.hpp"

namespace ropewalk {

// Added to the error of a rope, since it is not the rope of the chart. In five ropes outside of the chart the error
// exceeded the sum over the knobs by at most 0.44 %, in the energy of ropes that start unrelaxed
// (data/chart/README.md). Tubes that touch nothing stayed within the sums.
inline constexpr double between_scenes = 0.005;

struct PlanRequest {
  double error = 0.02;                   // largest, of each observable
  std::vector<std::string> observables;  // empty: all that the chart has of the scene
  bool end_state = false;                // the motion itself does not matter
};

struct Plan {
  std::string stands_for;                  // scene of the chart; empty: none is near, and the model is the default
  std::string driven_otherwise;            // what it means that the scene of the chart is driven in another way
  bool holds = false;                      // whether the error is held, as the chart has it
  std::map<std::string, double> expected;  // error by observable
  bool energy_above_start = true;          // what "energy" is there
  std::map<std::string, double> atoms;     // that of the chart's default model against atoms, where it has it
  double ns_per_element_step = 0;          // of CPU time, on the chart's machine
  double cost = 1;                         // CPU time per simulated time, in that of the default model
  std::vector<std::string> why;            // one line for each choice
  std::string text;                        // of the scene
  // The same with the default model, and whether that holds the error too.
  std::string standard_text;
  std::map<std::string, double> standard_expected;
  bool standard_holds = false;
};

// Whether the default model is to be taken in the place of the planned one: it holds the error, and takes no
// longer, or by less than timings are worth (a tenth).
bool default_serves(const Plan& plan, double planned_seconds, double standard_seconds);

// `scene` with its text. Throws InputError for an observable that the chart does not have.
Plan plan_scene(const Scene& scene, const std::vector<ChartedScene>& chart, const PlanRequest& request);

// What stands in a planned scene's text about itself; nothing in others.
struct Expectations {
  double asked = 0;                      // the error that was to be held
  std::map<std::string, double> errors;  // that the chart lets one expect, by observable
};
Expectations expectations_of(const std::string& text);

}  // namespace ropewalk
