#include "campaign/static_threshold.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "campaign/static_rest.hpp"
#include "campaign/threshold.hpp"
#include "io/csv_reader.hpp"
#include "observe/mode_shape.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

using Kind = StabilityVerdict::Kind;

class Bisection {
 public:
  Bisection(const Sweep& sweep, const SweepPoint& point) : sweep_(sweep), point_(point) {
    out_.point = point.name;
    out_.theory = point_in_theory(sweep, point).static_theory();
  }

  StaticThreshold go() {
    const ThresholdQuestion& q = *sweep_.threshold;
    if (look_at(q.from) != Outcome::stable) {
      if (out_.why.empty()) out_.why = fmt::format("it is not stable at {:g}, where the search begins", q.from);
      out_.above = StaticThreshold::none;
      return out_;
    }
    const Outcome at_end = look_at(q.to);
    if (at_end == Outcome::stable) out_.why = fmt::format("it is stable at all values up to {:g}", q.to);
    if (at_end != Outcome::unstable) return out_;
    while (out_.above - out_.below > q.accuracy * out_.value())
      if (look_at(out_.value()) == Outcome::unclear) break;
    return out_;
  }

 private:
  enum class Outcome { stable, unstable, unclear };

  Outcome look_at(double value) {
    const Scene scene = static_scene(scene_of_text(trial_text(sweep_, point_, value), sweep_.scene_path));
    ++out_.states;
    StaticRest rest;
    try {
      rest = static_rest(scene, "", last_ ? &*last_ : nullptr);
    } catch (const NumericalError& e) {  // the other points have their thresholds all the same
      return out_.why = fmt::format("no state of rest at {:g}: {}", value, e.what()), Outcome::unclear;
    }
    if (!rest.at_rest)
      return out_.why = fmt::format("no state of rest at {:g}: {}", value, rest.why), Outcome::unclear;
    // A solution that left a saddle of the energy is another state than the first one.
    if (rest.stability.kind == Kind::unstable || rest.found.saddles > 0) {
      out_.above = value;
      out_.growth = rest.stability.kind == Kind::unstable ? rest.found.growth : StaticThreshold::none;
      out_.motion = rest.stability.kind == Kind::unstable ? growing_motion_words(scene, rest)
                                                          : "it left a saddle of the energy";
      return Outcome::unstable;
    }
    if (rest.stability.kind == Kind::unknown)
      return out_.why = fmt::format("at {:g}: {}", value, rest.stability.words()), Outcome::unclear;
    out_.below = value;
    last_ = rest.state;
    return Outcome::stable;
  }

  const Sweep& sweep_;
  const SweepPoint& point_;
  StaticThreshold out_;
  std::optional<State> last_;
};

}  // namespace

StaticThreshold static_threshold(const Sweep& sweep, const SweepPoint& point) {
  return Bisection(sweep, point).go();
}

std::vector<OutputColumn> static_threshold_columns() {
  return {{"point", "", "of the sweep"},
          {"threshold", "", "of the key, in its unit: the middle of the bracket; nan: none was found"},
          {"error", "", "half of the bracket"},
          {"static_theory", "", "in the same unit: no helix grows below; nan: there is no such theory"},
          {"growth_per_ns", "1/ns", "rate of the motion that grows fastest at the upper end of the bracket"},
          {"motion", "", "what it moves"},
          {"states", "", "states of rest that were solved for"},
          {"remark", "", "why there is no bracket, or a wide one"}};
}

std::string static_thresholds_csv(const std::vector<StaticThreshold>& all) {
  std::string text = column_names(static_threshold_columns()) + "\n";
  for (const StaticThreshold& t : all)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", t.point, t.value(), t.error(), t.theory, t.growth,
                        csv_cell(t.motion), t.states, csv_cell(t.why));
  return text;
}

}  // namespace ropewalk
