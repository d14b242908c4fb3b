// The model that a scene needs: the cheapest within an error, found by pilots.
//
// A pilot is the scene itself, or a smaller one like it (pilot_scene.hpp), run with one model. The planner runs it
// with the program's default, with the finest model, with every change that makes it cheaper, and with those
// together that hold the error. The error of a model is the difference of its outcome (outcome.hpp) from the finest
// one's, plus the error of the finest model itself. Where elements are halved, the latter is a third of the
// default's difference, since the error of elements goes as the square of their length. Where the scene has random
// numbers, the default runs with three seeds. The differences between these runs are chance, and no model can
// promise less for a single run.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io/log.hpp"
#include "scene/scene.hpp"

namespace ropewalk {

struct PlanRequest {
  double error = 0.02;                   // largest, of each observable
  std::vector<std::string> observables;  // "energy" and columns of the log; empty: usual_observables()
  bool end_state = false;                // the motion itself does not matter
  // s of processor time for pilots of the default and the finest model alone: if the default holds the error in
  // them, it is the plan. 0: no such look.
  double first_look = 0;
};

struct PilotTask {
  std::string name, text;
  double until = -1;  // ps; negative: to its end
};
struct PilotEnd {
  double seconds = 0;  // of processor time
  std::vector<LogRow> log;
  std::string failure;  // empty: it came to its end
};
// Runs pilots side by side.
using RunPilots = std::function<std::vector<PilotEnd>(const std::vector<PilotTask>&)>;

struct PlannedModel {
  std::string name;
  double seconds = 0;                    // of its pilot
  std::map<std::string, double> error;   // found in the pilot, by observable
  std::map<std::string, double> expect;  // what is promised
  bool holds = false;
  bool relaxed = false;  // in the place of the motion
  std::string failure;
  std::string text, pilot_text;
  std::vector<std::string> why;  // a line for each change
};

struct Plan {
  std::string pilots;  // how they are smaller than the scene: "19 of 91 tubes"; empty: not at all
  double until = -1;   // ps, at which pilots end; negative: at the scene's end
  std::map<std::string, double> scatter;  // of runs that differ by chance, a standard deviation, relative
  PlannedModel finest, standard;
  std::vector<PlannedModel> tried;  // the others, in the order in which they were
  PlannedModel chosen;
  std::vector<std::string> remarks;  // sentences
};

// `scene` with its text; `seconds`: what its run takes with the default model; `affordable`: what all pilots may
// take. Throws InputError where an observable does not exist or a pilot of the default model fails.
Plan plan_scene(const Scene& scene, const PlanRequest& request, double seconds, double affordable,
                const RunPilots& run);

// The text of the scene with the program's default model.
std::string default_text(const Scene& scene);

// The promises in the text of a planned scene; empty for other scenes.
struct Expectations {
  double asked = 0;                      // largest error that the user allows
  double seconds = 0;                    // processor time promised; 0: none
  std::map<std::string, double> errors;  // promised, by observable
};
Expectations expectations_of(const std::string& text);
// The text of a planned scene without its promises, for a scene that differs from the one that was planned by more
// than its seed. The model stays.
std::string without_promises(const std::string& text);
// These lines, to be set before the text of a scene.
std::string expectation_lines(const Expectations& expectations);

}  // namespace ropewalk
