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
    bracket();
    out_.why = unclear_ + (unclear_.empty() || no_state_.empty() ? "" : "; ") + no_state_;
    return out_;
  }

 private:
  // A load is lost where its state of rest is unstable, or where no state of rest was found.
  enum class Outcome { stable, lost, unclear };

  void bracket() {
    const ThresholdQuestion& q = *sweep_.threshold;
    if (look_at(q.from) != Outcome::stable) {
      if (unclear_.empty() && no_state_.empty())
        unclear_ = fmt::format("it is not stable at {:g}, where the search begins", q.from);
      out_.above = StaticThreshold::none;
      return;
    }
    const Outcome at_end = look_at(q.to);
    if (at_end == Outcome::stable) unclear_ = fmt::format("it is stable at all values up to {:g}", q.to);
    if (at_end != Outcome::lost) return;
    while (out_.above - out_.below > q.accuracy * out_.value()) {
      const double middle = out_.value();
      if (look_at(middle) == Outcome::unclear) return narrow_about(middle);
    }
  }

  // At a value between the ends of the bracket the state is neither called stable nor lost. Both ends come as near to
  // such values as the accuracy asks for.
  void narrow_about(double unclear) {
    const double within = sweep_.threshold->accuracy * unclear;
    for (double first = unclear; first - out_.below > within;) {
      const double middle = 0.5 * (out_.below + first);
      if (look_at(middle) != Outcome::stable) first = middle;
    }
    for (double last = unclear; out_.above - last > within;) {
      const double middle = 0.5 * (last + out_.above);
      if (look_at(middle) != Outcome::lost) last = middle;
    }
  }

  Outcome look_at(double value) {
    const Scene scene = static_scene(scene_of_text(trial_text(sweep_, point_, value), sweep_.scene_path));
    ++out_.states;
    StaticRest rest;
    try {
      rest = static_rest(scene, "", last_ ? &*last_ : nullptr);
    } catch (const NumericalError& e) {  // the other points have their thresholds all the same
      return none_at(value, e.what());
    } catch (const InputError& e) {  // tubes that have parted hold each other no more
      if (!last_) throw;
      return none_at(value, e.what());
    }
    if (!rest.at_rest) return none_at(value, rest.why);
    // A solution that left a saddle of the energy is another state than the first one.
    if (rest.stability.kind == Kind::unstable || rest.found.saddles > 0) {
      out_.above = value;
      no_state_.clear();
      out_.growth = rest.stability.kind == Kind::unstable ? rest.found.growth : StaticThreshold::none;
      out_.motion = rest.stability.kind == Kind::unstable ? growing_motion_words(scene, rest)
                                                          : "it left a saddle of the energy";
      return Outcome::lost;
    }
    if (rest.stability.kind == Kind::unknown) {
      unclear_ = fmt::format("at {:g}: {}", value, rest.stability.words());
      return Outcome::unclear;
    }
    out_.below = value;
    last_ = rest.state;
    return Outcome::stable;
  }

  Outcome none_at(double value, const std::string& why) {
    out_.above = value;
    out_.growth = StaticThreshold::none;
    out_.motion.clear();
    no_state_ = fmt::format("no state of rest at {:g}: {}", value, why);
    return Outcome::lost;
  }

  const Sweep& sweep_;
  const SweepPoint& point_;
  StaticThreshold out_;
  std::string unclear_, no_state_;  // remarks
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
          {"remark", "", "why there is no bracket, or a wide one, or no state of rest at its upper end"}};
}

std::string static_thresholds_csv(const std::vector<StaticThreshold>& all) {
  std::string text = column_names(static_threshold_columns()) + "\n";
  for (const StaticThreshold& t : all)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", t.point, t.value(), t.error(), t.theory, t.growth,
                        csv_cell(t.motion), t.states, csv_cell(t.why));
  return text;
}

}  // namespace ropewalk
