#include "campaign/numeric_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "campaign/repeated_run.hpp"
#include "campaign/sweep_file.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "scene/finer.hpp"
#include "scene/slower.hpp"

namespace ropewalk {
namespace {

constexpr int other_starts = 3;
constexpr double first_order = 2, second_order = 4.0 / 3;  // 1/(1 - 2^-p)
constexpr double half_error = 0.71;                        // factor on a setting of second order that halves its error
constexpr double nudge = 0.01;  // temperature of velocities that are far too small to matter by themselves, K

class Planning {
 public:
  Planning(const RunDirectory& base, const Scene& scene, const Prepared& prepared, const std::vector<LogRow>& log)
      : base_(base),
        scene_(scene),
        prepared_(prepared),
        log_(log),
        inputs_(inputs_of(base, scene, prepared)),
        text_(repeatable_scene(inputs_.scene, scene, prepared)) {}

  NumericPlan go() {
    elements();
    if (relaxes()) {
      tolerance();
    } else {
      time_step();
      rate();
    }
    starts();
    return std::move(plan_);
  }

 private:
  bool relaxes() const { return scene_.run.mode == RunOptions::Mode::relax; }

  void leave_out(const std::string& what, const std::string& why) {
    plan_.what.remarks.push_back("Not repeated, " + what + ": " + why);
  }

  std::string with(const std::string& text, const char* key, double value) const {
    return with_value(text, key, fmt::format("{:.17g}", value), scene_.path);
  }

  // Adds a run of the scene in this text; false: the scene cannot be run.
  bool add(const std::string& name, const std::string& folder, const std::string& words, const std::string& text,
           double elements, double times) {
    const TemporaryFolder at;
    try {
      Scene changed = scene_in(at.path(), text);
      const Prepared p = prepare(changed);
      refuse_cooling(changed, p);
      const double steps = relaxes() ? elements : times * prepared_.time_step / p.time_step;
      plan_.runs.push_back({folder, words, text, elements * steps, times});
      return true;
    } catch (const InputError& e) {
      std::string why = e.what();
      if (const std::size_t place = why.find(at.path() + "/"); place != std::string::npos)
        why.erase(place, at.path().size() + 1);
      leave_out(name, why);
      return false;
    }
  }

  void elements() {
    const std::string name = "elements";
    std::string why = scene_.from_file() ? "they come from a file; run the scene that made it with shorter ones"
                                         : why_not_finer(scene_, prepared_.topology);
    if (!why.empty()) return leave_out(name, why);
    const double length = scene_.element_length;
    const std::string text =
        finer_scene_text(scene_, prepared_, "Elements of half the length, by `ropewalk errors`.");
    if (!add(name, "half-elements", "elements half as long", without_frames(text), 2, 1)) return;
    plan_.what.sources.push_back(
        {name, "half-elements", second_order, 1,
         fmt::format("elements of {:.4g} nm in the place of {:.4g} nm", 0.5 * length, length),
         fmt::format("element_length_nm = {:.3g}", half_error * length)});
    if (splitting_of(scene_) == Splitting::between)
      plan_.what.remarks.push_back(
          "Shorter elements: clamps stay in their places, and the tubes end a quarter of an element nearer to "
          "them. Energies of the whole rope contain this difference");
    if (is_warm(scene_))
      plan_.what.remarks.push_back(
          "Shorter elements: a warm scene then has more elements and so more heat, and its energies cannot be "
          "compared");
  }

  std::string without_frames(const std::string& text) const {
    return relaxes() ? text : with(text, "run.frames_every_ps", prepared_.duration);
  }

  // The shortest step of the run: half of a longer one would be divided to the same step again.
  double shortest_step() const {
    double least = prepared_.time_step / units::fs;
    for (const LogRow& row : log_)
      if (row["time_step_fs"] > 0) least = std::min(least, row["time_step_fs"]);
    return least * units::fs;
  }

  void time_step() {
    const double step = shortest_step() / units::fs;
    if (!add("time step", "half-step", "half the time step", with(text_, "run.time_step_fs", 0.5 * step), 1, 1))
      return;
    plan_.what.sources.push_back({"time step", "half-step", second_order, 1,
                                  fmt::format("steps of {:.4g} fs in the place of {:.4g} fs", 0.5 * step, step),
                                  fmt::format("run.time_step_fs = {:.3g}", half_error * step)});
    if (scene_.bath())
      plan_.what.remarks.push_back(
          "A bath: the velocities at the end of a step are too cold, which counts in kinetic_eV as an error of the time "
          "step; places and energies of bonds are not concerned");
  }

  void rate() {
    if (const std::string why = why_not_slower(scene_); !why.empty()) return leave_out("rate", why);
    const std::string text =
        slower_scene_text(scene_, 2, "All that is prescribed at half its rate, by `ropewalk errors`.");
    const std::string whole = with(with(text, "run.time_step_fs", prepared_.time_step / units::fs),
                                   "run.frames_every_ps", 2 * prepared_.duration);
    if (!add("rate", "half-rate", "half the rate", whole, 1, 2)) return;
    plan_.what.sources.push_back({"rate", "half-rate", first_order, 2,
                                  fmt::format("{:.4g} ps in the place of {:.4g} ps for all that is prescribed",
                                              2 * prepared_.duration, prepared_.duration),
                                  "half of every rate, and twice the times"});
  }

  void tolerance() {
    constexpr double part = 0.1;
    const RelaxGoal& goal = scene_.run.goal;
    const double force = part * goal.force / units::nN_nm;
    const std::string text = with(with(text_, "run.force_tolerance_nN", force), "run.energy_tolerance",
                                  std::max(1e-9, part * goal.energy));
    if (!add("tolerance", "tenth-tolerance", "a tenth of the tolerance", text, 1, 1)) return;
    plan_.what.sources.push_back(
        {"tolerance", "tenth-tolerance", 1 / (1 - part), 1,
         fmt::format("forces below {:.3g} nN in the place of {:.3g} nN", force, force / part),
         fmt::format("run.force_tolerance_nN = {:.3g}, and half of run.energy_tolerance", 0.5 * force / part)});
  }

  std::string other_start(const std::string& text, int k) const {
    const auto number = [&](std::uint64_t first) { return std::to_string(first + static_cast<std::uint64_t>(k)); };
    return with_value(with_value(text, "start.seed", number(scene_.start.seed), scene_.path), "start.stream",
                      number(scene_.start.stream), scene_.path);
  }

  Scene scene_in(const std::string& folder, const std::string& text) const {
    RunInputs inputs = inputs_;
    inputs.scene = text;
    return scene_of(inputs, base_, scene_, folder);
  }

  void starts() {
    std::string text = text_;
    const TemporaryFolder here, there;
    Scene one = scene_in(here.path(), text), other = scene_in(there.path(), other_start(text, 1));
    if (!seeds_differ(one, other)) {
      if (relaxes())
        return leave_out("another start", "nothing in the scene is random, and a relaxation takes no velocities");
      if (scene_.from_file()) return leave_out("another start", "it comes from a file, and nothing else is random");
      text = with_value(with(text, "start.temperature_K", nudge), "start.may_cool", "true", scene_.path);
    }
    for (int k = 1; k <= other_starts; ++k) {
      const std::string folder = fmt::format("start-{}", k);
      if (!add("another start", folder, fmt::format("another start, {}", k), other_start(text, k), 1, 1)) return;
      plan_.what.starts.push_back(folder);
    }
  }

  const RunDirectory& base_;
  const Scene& scene_;
  const Prepared& prepared_;
  const std::vector<LogRow>& log_;
  RunInputs inputs_;
  std::string text_;
  NumericPlan plan_;
};

}  // namespace

NumericPlan numeric_plan(const RunDirectory& base, const Scene& scene, const Prepared& prepared,
                         const std::vector<LogRow>& log) {
  return Planning(base, scene, prepared, log).go();
}

}  // namespace ropewalk
