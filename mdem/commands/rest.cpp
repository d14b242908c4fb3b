// `rest`: where a rope comes to rest, approached from both sides.
#include "campaign/rest.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "campaign/static_rest.hpp"
#include "campaign/sweep_runs.hpp"
#include "commands/sweep_progress.hpp"
#include "commands/verb.hpp"
#include "io/file_group.hpp"
#include "io/files.hpp"
#include "io/stop_signals.hpp"
#include "model/error.hpp"
#include "run/results.hpp"
#include "scene/dissipation.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

struct RestArguments {
  std::string scene;
  std::string out;                  // empty: runs/NAME-rest
  std::optional<double> viscosity;  // eV ps/nm^3
  double tolerance = 0.02;          // part of the geometric twist, within which both sides agree
  int jobs = 0;                     // 0: one for each core
  bool by_statics = false;          // by Newton's method, without runs
  bool force = false;
  bool json = false;
  bool quiet = false;
};

namespace fs = std::filesystem;

// A tenth of the default: ropes of 7 to 91 tubes come to rest several times sooner, and hardly swing.
constexpr double of_the_default = 0.1;

double viscosity_of(const RestArguments& a, const Scene& scene) {
  if (a.viscosity) return *a.viscosity;
  const double standard = contact_viscosity(default_viscosity, scene.element_length, scene.sets);
  return scene.damping.contact.eta == standard ? of_the_default * default_viscosity : -1;
}

void print_theory(const RestTheory& theory, double length) {
  fmt::print(
      "theory: {:.4g} deg if tubes are packed like a solid disc (a fifth too small for few tubes), {:.4g} deg if "
      "they do not touch\n",
      theory.compact * length / units::degree, theory.open * length / units::degree);
}

void print_sides(const std::array<RestSide, 2>& sides, const RestTheory& theory, double length) {
  fmt::print("{:<8} {:>10} {:>12} {:>15} {:>18} {:>22} {:>6}  {}\n", "from", "time, ps", "twist, deg",
             "in 100 ps, deg", "goes to, deg", "beta, deg (range)", "Q", "branch");
  for (const RestSide& s : sides)
    fmt::print("{:<8} {:>10.4g} {:>12.4g} {:>15.2g} {:>19} {:>22} {:>6.3g}  {}\n",
               &s == &sides[0] ? "below" : "above", s.time, s.twist, 100 * s.drift,
               fmt::format("{:.4g} ± {:.1g}", s.to_twist.limit, s.to_twist.error()),
               fmt::format("{:.3g} ({:.3g} to {:.3g})", s.beta, s.least, s.most), s.Q, s.branch());
  print_theory(theory, length);
}

void print_static_rests(const std::vector<StaticRest>& rests, const RestTheory& theory, double length) {
  fmt::print("{:<16} {:>12} {:>10} {:>6} {:>12} {:>10}  {}\n", "from", "twist, deg", "beta, deg", "Q",
             "left, eV/nm", "left, eV", "branch");
  for (const StaticRest& r : rests) {
    fmt::print("{:<16} {:>12.6g} {:>10.4g} {:>6.3g} {:>12.1e} {:>10.1e}  {}\n", r.from, r.twist, r.beta, r.Q,
               r.found.force, r.found.above, r.branch());
    fmt::print("  {}\n", r.at_rest ? r.stability.words() : "not at rest: " + r.why);
  }
  print_theory(theory, length);
}

int rest_by_statics(const RestArguments& a, const Scene& scene, const Prepared& p, const RestTheory& theory,
                    double length, const std::string& name) {
  if (a.viscosity)
    throw InputError({"", 0, "--viscosity"}, "has no part in statics", "leave it out, or leave out --static");
  // The file that is written last: with it all are there.
  const std::string out = a.out.empty() ? "runs/" + name + "-static-rest" : a.out, last = out + "/static-rest.json";
  if (!a.force && fs::exists(last))
    throw InputError({out, 0, "--out"}, "holds static-rest.json", "choose another name, or give --force");
  const Scene plain = static_scene(scene);
  std::vector<StaticRest> rests;
  const std::array<double, 2> starts = rest_starts(p, theory);
  for (std::size_t side = 0; side < 2; ++side) {
    Scene wound = plain;
    wound.start.turn = starts[side];
    rests.push_back(static_rest(wound, side == 0 ? "below" : "above"));
    const std::string from = rests.back().from;
    for (const State& begin : along_growing_motion(wound, rests.back()))
      rests.push_back(static_rest(wound, from + ", growing", &begin));
  }
  const std::string words = static_rest_words(rests, a.tolerance), json = static_rest_json(rests, words);
  fs::create_directories(out);
  write_files_together({{out + "/static-rest.csv", static_rest_csv(rests)}, {last, json}});
  if (a.json) {
    fmt::print("{}", json);
    return 0;
  }
  print_static_rests(rests, theory, length);
  fmt::print("{}\nFriction has no part in it. Numbers: {}/static-rest.csv, static-rest.json\n", words, out);
  return std::all_of(rests.begin(), rests.end(), [](const StaticRest& r) { return r.at_rest; }) ? 0 : 4;
}

int rest_command(const RestArguments& a) {
  Scene scene = read_scene(a.scene);
  if (scene.start.turn != 0)
    throw InputError({a.scene, 0, "start.twist_deg_per_nm"}, "is what this command varies", "take it away");
  const Prepared p = prepare(scene);
  const RestTheory theory = rest_theory(scene, p);
  const double length = p.topology.length_of(0) * p.topology.longest_element();
  const std::string name = fs::path(a.scene).stem().string();
  if (a.by_statics) return solve_here(a.jobs, [&] { return rest_by_statics(a, scene, p, theory, length, name); });
  const CampaignDirectory dir{a.out.empty() ? "runs/" + name + "-rest" : a.out};
  scene.path = fs::absolute(a.scene).string();
  const Sweep sweep = sweep_of_text(rest_sweep(scene, p, theory, viscosity_of(a, scene)), dir.sweep());
  const std::vector<SweepPoint> points = points_of(sweep);
  const DirectoryLock lock = create_campaign(dir, sweep, points, a.force);
  listen_to_stop_signals();
  const SweepRuns runs(sweep, dir, points, OnLimit::warn, a.jobs > 0 ? a.jobs : omp_get_num_procs(), false);
  SweepProgress progress(dir, points, runs, a.quiet);
  progress.begin();
  runs.run_points([&](const SweepPoint& point, int status) { progress.ended(point, status); });
  if (stop_signal) return tell_stop();
  progress.clear_line();
  std::array<RestSide, 2> sides;
  for (std::size_t k = 0; k < 2; ++k) {
    const RunDirectory run = dir.point(points.at(k).name);
    if (progress_of(run).stage != PointProgress::Stage::ended) {
      tell_not_ended(dir, points[k].name);
      return 3;
    }
    sides[k] = rest_side(read_log(run.log()), limits_of(run), std::stod(points[k].values.front()));
  }
  const RestVerdict verdict = rest_verdict(sides, a.tolerance);
  write_file_atomically(dir.path + "/rest.csv", rest_csv(sides));
  const std::string json = rest_json(sides, verdict, theory, length);
  write_file_atomically(dir.path + "/rest.json", json);
  if (a.json) {
    fmt::print("{}", json);
    return 0;
  }
  print_sides(sides, theory, length);
  for (const std::string& beyond : beyond_of(sides)) fmt::print("{}\n", beyond);
  const bool quoted = std::isfinite(verdict.twist.value);
  fmt::print("{}\n{}Numbers: {}/rest.csv, rest.json; runs: {}/points\n", verdict.words,
             quoted ? left_out_of_rest() + "\n" : "", dir.path, dir.path);
  return 0;
}

}  // namespace

void add_rest(CLI::App& app, Program& program) {
  const auto a = std::make_shared<RestArguments>();
  CLI::App* c = app.add_subcommand(
      "rest", "Where a rope under a moment comes to rest: approached from below and from above, beside theory");
  c->add_option("scene", a->scene, "Scene (TOML): a [rope] with [twist]")->required();
  c->add_option("--out", a->out, "Directory of both runs; the same command goes on [default: runs/NAME-rest]");
  c->add_option("--viscosity", a->viscosity,
                "Contact viscosity (eV ps/nm^3) [default: the scene's, or a tenth of the default]")
      ->check(CLI::NonNegativeNumber);
  c->add_option("--tolerance", a->tolerance,
                "Relative tolerance of the twist: of a side, to be at rest, and of both, to agree")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 0.5));
  c->add_option("-j,--jobs", a->jobs, "Runs at a time [default: one for each core]")->check(thread_range());
  c->add_flag(
      "--static", a->by_statics,
      "By Newton's method, without runs: the equilibrium states without friction, and whether they are stable");
  c->add_flag("--force", a->force, "Replace runs of another scene");
  c->add_flag("--json", a->json, "JSON");
  c->add_flag("--quiet", a->quiet, "No progress");
  c->callback([a, &program] { program.code = rest_command(*a); });
}

}  // namespace ropewalk
