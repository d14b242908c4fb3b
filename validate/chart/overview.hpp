// All scenes of the chart together: what a model costs and how far it is off, beside the default of the same scene.
#pragma once

#include <string>
#include <vector>

#include "chart/chart.hpp"
#include "report/page.hpp"

namespace ropewalk::validate {

struct Quartiles {
  double lower = 0, median = 0, upper = 0;
};
// Between neighbours in order they are interpolated; those of one value are the value. Throws std::invalid_argument
// for none.
Quartiles quartiles(std::vector<double> values);

// A model in one scene.
struct ScenePlace {
  const ChartPoint* point = nullptr;
  double cost = 0;           // CPU time per simulated time over that of the default
  double error = 0;          // the largest of the scene's observables against the finest model, a fraction
  std::string observable;    // which has it
  double default_error = 0;  // error of the default in this scene
};

struct ModelPlaces {
  std::string model, kind, words;
  std::vector<ScenePlace> scenes;
  std::vector<std::string> failed;  // scenes that it could not be run in
  Quartiles cost, error;
  double default_error = 0;  // median of the default in these scenes

  const ScenePlace& worst() const;  // the scene of the largest error
};

// Every model but the finest, over the scenes that it and the default went through, in the order of the points.
// Errors against atoms do not count: few scenes have atoms. A model that ran in no scene is left out.
std::vector<ModelPlaces> places_over_scenes(const std::vector<ChartPoint>& points,
                                            const std::vector<ChartRow>& rows);

// What the medians say.
enum class Worth {
  cheap_and_right,  // saves a tenth of the time or more, errs at most twice as much as the default
  cheap_at_a_price,
  wrong,            // errs by more than a tenth
  dear_and_better,  // takes a tenth more time or more, errs less than half as much as the default
  dear_for_nothing,
  like_the_default,  // costs about the same
};
Worth worth_of(const ModelPlaces& model);

// The figure, what follows from it, and the table of its numbers; empty where no scene has a default.
std::string overview_part(const std::vector<ChartPoint>& points, const std::vector<ChartRow>& rows,
                          Figures& figures);

// The words of the model with this name. A model that no scene has keeps its name.
std::string model_words(const std::string& name);

}  // namespace ropewalk::validate
