#include "plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "plan/model_changes.hpp"
#include "plan/outcome.hpp"
#include "plan/pilot_scene.hpp"
#include "plan/scene_edit.hpp"
#include "plan/sliding_rope.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/end_drives.hpp"

namespace ropewalk {
namespace {

constexpr int seeds = 3;
constexpr double least_error = 1e-3;  // what a promise never goes below
constexpr double worth = 0.9;         // of the default's time: a smaller gain is no gain

Scene scene_with_features(const std::string& text, const std::string& path, SceneFeatures& features) {
  Scene scene = scene_of_text(text, path);
  const Prepared prepared = prepare(scene);
  features = features_of(scene, prepared);
  return scene;
}

bool has_random_numbers(const Scene& scene) {
  const auto* rope = dynamic_cast<const RopeSource*>(scene.source.get());
  return is_warm(scene) || scene.bath() || (rope && rope->perturbation > 0);
}

class Planner {
 public:
  // Only the default and the finest model, or all that might do.
  enum class Pilots { first_two, all };

  Planner(const Scene& scene, const PlanRequest& request, double seconds, double affordable, const RunPilots& run,
          Pilots pilots)
      : request_(request), run_(run) {
    scene_ = scene_with_features(scene.text, scene.path, features_);
    const double in_all = pilots == Pilots::all ? pilots_in_all() : finest_in_defaults() + 1;
    const PilotScene pilot = pilot_scene(scene_, seconds, affordable / in_all);
    plan_.pilots = pilot.words;
    caution_ = pilot.caution;
    plan_.until = pilot.until;
    pilot_ = scene_with_features(pilot.text, scene.path, pilot_features_);
    relaxes_ = scene_.run.mode == RunOptions::Mode::relax;
    for (const std::string& name : request.observables)
      if (name != "energy") column_of_log(name, {"", 0, "--observables"});
  }

  Plan go() {
    const std::vector<ModelChange> finest = finest_of_pilot();
    std::vector<std::string> not_tried;
    const std::vector<ModelChange> cheaper =
        cheaper_changes(pilot_, pilot_features_, request_.end_state, not_tried);
    for (const std::string& words : not_tried) plan_.remarks.push_back("Not tried: " + words + ".");

    first_pilots(finest, cheaper, true);
    if (!plan_.standard.holds && halves_ && !relaxes_) try_together({finest.front()});
    combine(cheaper);
    choose();
    return std::move(plan_);
  }

  // The default model, if it holds the error.
  std::optional<Plan> default_if_it_holds() {
    first_pilots(finest_of_pilot(), {}, false);
    if (!plan_.standard.holds) return {};
    choose();
    plan_.remarks.push_back(
        "The default model is accurate enough. Trying cheaper ones would cost more time than they save; --runs N "
        "plans for more runs, and --pilot-seconds gives the pilots more time.");
    return std::move(plan_);
  }

 private:
  // --- pilots ---

  std::vector<ModelChange> finest_of_pilot() {
    halves_ = kept_length(pilot_).empty();
    if (!halves_)
      plan_.remarks.push_back("The error of the element length is not in the promise: " + kept_length(pilot_) +
                              ".");
    return finest_changes(pilot_, pilot_features_);
  }
  double finest_in_defaults() const { return kept_length(scene_).empty() ? 5 : 2; }

  // The time of all pilots together, in runs of the default model, about.
  double pilots_in_all() const {
    std::vector<std::string> not_tried;
    const auto changes =
        static_cast<double>(cheaper_changes(scene_, features_, request_.end_state, not_tried).size());
    const double together = std::clamp(changes - 1, 0.0, 2.0);
    return finest_in_defaults() + 1 + (has_random_numbers(scene_) ? seeds - 1 : 0) + changes + together;
  }

  static std::string name_of(const std::vector<ModelChange>& changes) {
    std::string name;
    for (const ModelChange& c : changes) name += (name.empty() ? "" : ", ") + c.name;
    return name.empty() ? "default" : name;
  }

  PlannedModel model_of(const std::vector<ModelChange>& changes) const {
    PlannedModel m;
    m.name = name_of(changes);
    m.relaxed = std::any_of(changes.begin(), changes.end(), [](const ModelChange& c) { return c.key == "mode"; });
    m.pilot_text = text_with(pilot_, pilot_features_, changes);
    m.text = text_with(scene_, features_, changes, &m.why);
    return m;
  }

  Outcome outcome(const PilotEnd& end, bool relaxed) const {
    std::vector<std::string> observables = request_.observables;
    if (observables.empty()) {
      observables = usual_observables();
      if (features_.prescribes_moment)
        observables.erase(std::find(observables.begin(), observables.end(), "torque_upper_nN_nm"));
    }
    return outcome_of(end.log, observables, relaxed);
  }
  Outcome outcome(const PlannedModel& m, const PilotEnd& end) const { return outcome(end, relaxes_ || m.relaxed); }

  // The finest model, the default, with its seeds if asked for, and every change alone.
  void first_pilots(const std::vector<ModelChange>& finest, const std::vector<ModelChange>& cheaper,
                    bool by_seeds) {
    plan_.finest = model_of(finest);
    plan_.standard = model_of({});
    std::vector<PilotTask> tasks = {task(plan_.finest), task(plan_.standard)};
    const int more = by_seeds && has_random_numbers(pilot_) ? seeds - 1 : 0;
    for (int k = 1; k <= more; ++k) tasks.push_back(by_chance(k));
    for (const ModelChange& change : cheaper) {
      plan_.tried.push_back(model_of({change}));
      tasks.push_back(task(plan_.tried.back()));
    }
    const std::vector<PilotEnd> ends = run_(tasks);
    for (const std::size_t k : {std::size_t{1}, std::size_t{0}})
      if (!ends[k].failure.empty() || ends[k].log.empty())
        throw InputError({scene_.path, 0, ""},
                         fmt::format("a pilot ({}) failed: {}", tasks[k].name, ends[k].failure),
                         "try the scene with `ropewalk run`");
    plan_.finest.seconds = ends[0].seconds;
    finest_ = outcome(plan_.finest, ends[0]);
    add_scatter(ends, more);
    const std::map<std::string, double> off = differences(outcome(plan_.standard, ends[1]), finest_);
    for (const auto& [name, error] : off) own_[name] = halves_ ? error / 3 : 0;
    judge(plan_.standard, ends[1]);
    for (std::size_t k = 0; k < plan_.tried.size(); ++k)
      judge(plan_.tried[k], ends[2 + static_cast<std::size_t>(more) + k]);
  }

  // The default model once more, as good as before. Another seed would make another film; there a step that is a
  // little shorter does, which leads to other motions as soon as they are chaotic.
  PilotTask by_chance(int k) const {
    if (pilot_.kind == "film") return task(model_of({step_change(1 - 0.03 * k)}));
    PilotTask seeded = task(plan_.standard);
    const std::uint64_t seed = pilot_.start.seed + static_cast<std::uint64_t>(k);
    seeded.name = fmt::format("default, seed {}", seed);
    seeded.text = with_value(seeded.text, "start.seed", std::to_string(seed), pilot_.path);
    return seeded;
  }

  PilotTask task(const PlannedModel& m) const { return {m.name, m.pilot_text, plan_.until}; }

  void add_scatter(const std::vector<PilotEnd>& ends, int more) {
    std::vector<Outcome> all;
    for (int k = 0; k <= more; ++k) {
      const PilotEnd& end = ends[static_cast<std::size_t>(1 + k)];
      if (end.failure.empty() && !end.log.empty()) all.push_back(outcome(plan_.standard, end));
    }
    if (all.size() < 2) return;
    for (const auto& [name, v] : finest_.of) {
      double mean = 0, squares = 0;
      for (const Outcome& o : all) mean += o.of.at(name).value / static_cast<double>(all.size());
      for (const Outcome& o : all) squares += std::pow(o.of.at(name).value - mean, 2);
      if (v.scale > 0 && std::isfinite(squares))
        plan_.scatter[name] = std::sqrt(squares / static_cast<double>(all.size() - 1)) / v.scale;
    }
  }

  double scatter(const std::string& name) const {
    const auto at = plan_.scatter.find(name);
    return at == plan_.scatter.end() ? 0 : at->second;
  }

  void judge(PlannedModel& m, const PilotEnd& end) const {
    m.seconds = end.seconds;
    m.failure = end.failure;
    if (m.failure.empty() && end.log.empty()) m.failure = "it has no log";
    if (!m.failure.empty()) return;
    m.error = differences(outcome(m, end), finest_);
    m.holds = true;
    for (const auto& [name, error] : m.error) {
      // The difference that other seeds make as well is no error of the model.
      const double by_chance = 2 * scatter(name), model = std::max(0.0, error - by_chance) + own_.at(name);
      const double promised = caution_ * (model + least_error);
      m.expect[name] = promised + by_chance;
      m.holds = m.holds && promised <= request_.error;
    }
  }

  PlannedModel& try_together(const std::vector<ModelChange>& changes) {
    plan_.tried.push_back(model_of(changes));
    PlannedModel& m = plan_.tried.back();
    judge(m, run_({task(m)}).front());
    return m;
  }

  // --- the choice ---

  // All changes that hold the error alone, the cheapest of each key; without the one that is farthest off where
  // they do not hold it together.
  void combine(const std::vector<ModelChange>& cheaper) {
    std::vector<std::size_t> taken;  // of `cheaper` and of plan_.tried alike
    for (std::size_t k = 0; k < cheaper.size(); ++k) {
      const PlannedModel& m = plan_.tried[k];
      if (!m.holds || m.seconds > 0.97 * plan_.standard.seconds) continue;
      const auto same =
          std::find_if(taken.begin(), taken.end(), [&](std::size_t t) { return excludes(cheaper[t], cheaper[k]); });
      if (same == taken.end())
        taken.push_back(k);
      else if (m.seconds < plan_.tried[*same].seconds)
        *same = k;
    }
    while (taken.size() > 1) {
      std::vector<ModelChange> changes;
      for (const std::size_t k : taken) changes.push_back(cheaper[k]);
      if (try_together(changes).holds) return;
      taken.erase(std::max_element(taken.begin(), taken.end(), [&](std::size_t a, std::size_t b) {
        return largest(plan_.tried[a]) < largest(plan_.tried[b]);
      }));
    }
  }

  static bool excludes(const ModelChange& a, const ModelChange& b) {
    const auto timed = [](const ModelChange& c) { return c.key == "mass_scale" || c.key == "mode"; };
    return a.key == b.key || (timed(a) && timed(b));
  }

  static double largest(const PlannedModel& m) {
    double most = m.failure.empty() ? 0 : INFINITY;
    for (const auto& [name, e] : m.expect) most = std::max(most, e);
    return most;
  }

  void choose() {
    plan_.chosen = plan_.standard;
    for (const PlannedModel& m : plan_.tried) {
      if (!m.failure.empty()) continue;
      const PlannedModel& best = plan_.chosen;
      const bool better =
          m.holds ? !best.holds || m.seconds < best.seconds : !best.holds && largest(m) < largest(best);
      if (better) plan_.chosen = m;
    }
    if (plan_.standard.holds && plan_.chosen.seconds > worth * plan_.standard.seconds)
      plan_.chosen = plan_.standard;
    for (const auto& [name, s] : plan_.scatter)
      if (2 * s > request_.error)
        plan_.remarks.push_back(
            fmt::format("Chance alone makes runs differ by {:.2g} % in {} (one standard deviation): a single run "
                        "is no better than that, whatever "
                        "its model.",
                        100 * s, name, 100 * request_.error));
    if (!plan_.chosen.holds)
      plan_.remarks.push_back(
          fmt::format("No model that was tried keeps the error below {:g} %: this is the most accurate one.",
                      100 * request_.error));
    if (!plan_.pilots.empty() && features_.prescribes_moment && scene_.source->is_parallel()) add_buckling();
    add_slice();
  }

  // Pilots that are shorter stay straight where the whole rope buckles.
  void add_buckling() {
    const Prepared p = prepare(scene_);
    const std::optional<HelixTheory> helix = helix_theory(scene_, p);
    const double theory = helix ? helix->static_moment / helix->tubes_in_unit : 0;
    if (helix && end_moment(end_drives(p.loads, p.topology))->of_each(features_.tubes) > theory)
      plan_.remarks.push_back(
          fmt::format("The whole rope may buckle: tubes that slide do so from {:.3g} nN nm per tube on, by theory. "
                      "The promise is for the "
                      "time before: when a rope buckles depends on its noise.",
                      theory / units::nN_nm));
  }

  // Whether the interior alone would do.
  void add_slice() {
    if (scene_.kind != "rope" || scene_.has_ends(Drive::Ends::endless) || !features_.turned_between ||
        features_.turn <= 0)
      return;
    const double elements = elements_of(scene_),
                 slice = 3 * std::ceil(prepare(scene_).interaction.cutoff() / scene_.element_length);
    constexpr double much = 3;
    if (elements > much * slice)
      plan_.remarks.push_back(
          fmt::format("If only the rope's interior matters, a slice without ends takes {:.2g} of the time: "
                      "[periodic] with twist_deg_per_nm up "
                      "to {:.3g}, tubes of {:.3g} nm or more.",
                      slice / elements, features_.turn / units::degree, slice * scene_.element_length));
  }

  const PlanRequest& request_;
  const RunPilots& run_;
  Scene scene_, pilot_;
  SceneFeatures features_, pilot_features_;
  bool relaxes_ = false, halves_ = false;
  double caution_ = 1;
  Outcome finest_;
  std::map<std::string, double> own_;  // what the finest model is off
  Plan plan_;
};

}  // namespace

Plan plan_scene(const Scene& scene, const PlanRequest& request, double seconds, double affordable,
                const RunPilots& run) {
  using Pilots = Planner::Pilots;
  if (request.first_look > 0 && request.first_look < affordable)
    if (std::optional<Plan> plan =
            Planner(scene, request, seconds, request.first_look, run, Pilots::first_two).default_if_it_holds())
      return *std::move(plan);
  return Planner(scene, request, seconds, affordable, run, Pilots::all).go();
}

std::string default_text(const Scene& scene) {
  SceneFeatures features;
  const Scene built = scene_with_features(scene.text, scene.path, features);
  return text_with(built, features, {});
}

Expectations expectations_of(const std::string& text) {
  Expectations out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, plan, what, name, number;
    if (!(words >> hash >> plan >> what) || hash != "#" || plan != "plan:") continue;
    if (what == "expect") words >> name;
    words >> number;
    const double value = leading_number(number).value_or(0);
    if (what == "expect") out.errors[name] = value;
    if (what == "asked") out.asked = value;
    if (what == "seconds") out.seconds = value;
  }
  return out;
}

std::string without_promises(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const std::string planned = "# Planned for";
    if (line.rfind("# plan:", 0) == 0) continue;
    if (line.rfind(planned, 0) == 0)
      line = "# The scene that this one was made from was planned for" + line.substr(planned.size());
    out += line + "\n";
  }
  return out;
}

std::string expectation_lines(const Expectations& e) {
  std::string text = fmt::format("# plan: asked {:.6g}\n", e.asked);
  if (e.seconds > 0) text += fmt::format("# plan: seconds {:.4g}\n", e.seconds);
  for (const auto& [name, error] : e.errors) text += fmt::format("# plan: expect {} {:.6g}\n", name, error);
  return text;
}

}  // namespace ropewalk
