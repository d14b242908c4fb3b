#include "campaign/static_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "campaign/rest.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "observe/mode_shape.hpp"
#include "run/equilibrium_of.hpp"
#include "sim/statics/end_words.hpp"
#include "sim/statics/load_steps.hpp"
#include "sim/statics/newton.hpp"
#include "sim/statics/reduction.hpp"
#include "sim/statics/stiffness.hpp"

namespace ropewalk {

Scene static_scene(Scene scene) {
  const auto refuse = [&](const std::string& key, const std::string& what) {
    throw InputError({scene.path, 0, key}, what + ", and --static solves for states of rest", "leave out --static");
  };
  if (scene.bath()) refuse("thermostat", "keeps the rope warm");
  scene.run.mode = RunOptions::Mode::relax;
  scene.run.solver = RunOptions::Solver::automatic;
  scene.statics.steps = 0;
  scene.stops.clear();
  scene.expected.clear();
  for (auto& drive : scene.drives) {
    if (auto held = drive->at_its_end()) drive = std::move(held);
    if (drive->needs_time().empty()) continue;
    if (!drive->goes_by_load_steps()) refuse(drive->table().name, drive->needs_time());
    scene.statics.steps = 1;
  }
  return scene;
}

std::string StaticRest::branch() const {
  RestSide side;
  side.shape = shape;
  side.Q = Q;
  return side.branch();
}

namespace {

Simulation simulation_of(const Scene& scene, Prepared prepared, const State* begin) {
  if (begin) prepared.state = *begin;
  return start(scene, prepared);
}

LogRow row_of(const MovingScene& m) {
  return log_row(m.observer, m.scene, m.prepared.topology, m.state(), m.account());
}

}  // namespace

StaticRest static_rest(const Scene& scene, const std::string& from, const State* begin) {
  MovingScene moving(scene);
  const LogRow first = row_of(moving);
  if (begin) moving.simulation = simulation_of(moving.scene, moving.prepared, begin);
  Simulation& s = moving.simulation;
  NewtonOptions how;
  how.fire = scene.run.solver == RunOptions::Solver::automatic;
  how.most_overloaded = enough_overloaded;
  NewtonStatics newton(s, how);
  const auto progress = [](long) { return stop_signal == 0; };
  Statics end;
  end.end = Statics::End::at_rest;
  if (scene.statics.steps > 0)
    end = newton.follow(load_step_times(s.loads(), scene.statics.steps).back(), scene.run.goal, progress);
  if (end.end == Statics::End::at_rest) end = newton.relax(scene.run.goal, scene.run.max_steps, progress);
  if (end.end == Statics::End::interrupted) throw StaticsStopped{};
  s.end_relaxation();
  StaticRest out;
  out.from = from;
  out.at_rest = end.relaxed.at_rest;
  if (!out.at_rest) out.why = end_words(s, end, how.fire, false).why;
  const LogRow row = row_of(moving);
  out.twist = row["geometric_twist_deg"];
  out.beta = row["beta_deg"];
  out.Q = row["Q"];
  out.shape = shape_of(row, first);
  out.steps = end.newton_steps;
  out.state = s.state();
  if (out.at_rest) out.stability = judge_stability(s, end);
  out.found = equilibrium_of(end, out.stability);
  return out;
}

namespace {

const char* kind_of(const StaticRest& r) { return r.at_rest ? name_of(r.found.stability) : "not at rest"; }

}  // namespace

std::string static_rest_words(const std::vector<StaticRest>& rests, double tolerance) {
  std::vector<const StaticRest*> different;
  bool all_stable = true;
  for (const StaticRest& r : rests) {
    if (!r.at_rest) return fmt::format("No state of rest was found from {}: {}.", r.from, r.why);
    all_stable = all_stable && r.stability.kind == StabilityVerdict::Kind::stable;
    const bool known = std::any_of(different.begin(), different.end(), [&](const StaticRest* d) {
      return d->branch() == r.branch() && std::fabs(d->twist - r.twist) <= tolerance * std::fabs(d->twist);
    });
    if (!known) different.push_back(&r);
  }
  const StaticRest& first = *different.front();
  if (different.size() == 1)
    return fmt::format("Rests {}: all come to a geometric twist of {:.6g} degrees, beta {:.4g}{}.", first.branch(),
                       first.twist, first.beta, all_stable ? "; it is stable" : "");
  std::string words = fmt::format("{} states of rest without friction:", different.size());
  for (const StaticRest* d : different)
    words += fmt::format(" {} at {:.6g} degrees ({}){}", d->branch(), d->twist, kind_of(*d),
                         d == different.back() ? "." : ",");
  return words;
}

std::vector<OutputColumn> static_rest_columns() {
  std::vector<OutputColumn> all = {
      {"from", "", "where Newton's method began: below, above, or along a motion that grows"},
      {"geometric_twist_deg", "deg", "geometric twist"},
      {"beta_deg", "deg", "angle of the outermost tubes"},
      {"Q", "", "packing charge"},
      {"branch", "", "compact, compact with defects, or open with its shape"},
      {"at_rest", "", "1: it is a state of rest, 0: none was found"}};
  const std::vector<OutputColumn> of_rest = rest_columns();
  all.insert(all.end(), of_rest.begin(), of_rest.end());
  all.push_back({"steps", "", "of Newton's method"});
  return all;
}

std::string static_rest_csv(const std::vector<StaticRest>& rests) {
  std::string text = column_names(static_rest_columns()) + "\n";
  for (const StaticRest& r : rests)
    text += fmt::format("{},{},{},{},{},{:d},{},{}\n", r.from, r.twist, r.beta, r.Q, r.branch(), r.at_rest,
                        rest_cells(r.found), r.steps);
  return text;
}

std::string static_rest_json(const std::vector<StaticRest>& rests, const std::string& words) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json out = {{"words", words}, {"states", Json::array()}};
  for (const StaticRest& r : rests)
    out["states"].push_back({{"from", r.from},
                             {"at_rest", r.at_rest},
                             {"why_not", r.why},
                             {"geometric_twist_deg", number(r.twist)},
                             {"beta_deg", number(r.beta)},
                             {"Q", number(r.Q)},
                             {"branch", r.branch()},
                             {"stability", kind_of(r)},
                             {"stability_words", r.at_rest ? r.stability.words() : ""},
                             {"growth_per_ns", number(r.found.growth)},
                             {"error_per_ns", number(r.found.error)},
                             {"force_eV_per_nm", number(r.found.force)},
                             {"moment_eV", number(r.found.moment)},
                             {"above_eV", number(r.found.above)},
                             {"saddles", r.found.saddles},
                             {"steps", r.steps}});
  return out.dump(2) + "\n";
}

namespace {

// The state's simulation, and the motion that grows fastest there.
struct Growing {
  Simulation simulation;
  Tangent tangent;
  Mode mode;
};
std::optional<Growing> growing_motion(const Scene& scene, const StaticRest& rest) {
  if (rest.stability.kind != StabilityVerdict::Kind::unstable || std::isnan(rest.stability.growth)) return {};
  Scene copy = scene;
  const Prepared prepared = prepare(copy);
  Simulation s = simulation_of(copy, prepared, &rest.state);
  std::string why;
  const auto reduction = reduction_of(s, why);
  if (!reduction) return {};
  Tangent tangent = tangent_by_blocks(s);
  Mode mode = modes_of(tangent, *reduction, {}).modes.front();
  return Growing{std::move(s), std::move(tangent), std::move(mode)};
}

}  // namespace

std::string growing_motion_words(const Scene& scene, const StaticRest& rest) {
  const auto growing = growing_motion(scene, rest);
  if (!growing) return "";
  const Simulation& s = growing->simulation;
  const ModeShape shape = shape_of(s.topology(), s.state(), growing->tangent.mass, growing->mode);
  if (std::isnan(shape.half_waves) || shape.shares.sideways <= 0.25) return shape.name();
  return fmt::format("{}, {:.0f} half wave{}, {:+.2f} windings", shape.name(), shape.half_waves,
                     shape.half_waves == 1 ? "" : "s", shape.windings);
}

std::vector<State> along_growing_motion(const Scene& scene, const StaticRest& rest) {
  const auto growing = growing_motion(scene, rest);
  if (!growing) return {};
  const Simulation& s = growing->simulation;
  const Eigen::VectorXd shape = growing->mode.shape.real();
  double most = 0;
  for (Eigen::Index row = 0; row < shape.size(); row += 6)
    most = std::max(
        {most, shape.segment<3>(row).norm(), s.topology().largest_radius() * shape.segment<3>(row + 3).norm()});
  const double by = 0.1 * s.topology().largest_radius() / most;
  return {moved(s.state(), by * shape), moved(s.state(), -by * shape)};
}

}  // namespace ropewalk
