// `check`: what a scene would do and how long it would take.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "commands/verb.hpp"
#include "io/clocks.hpp"
#include "observe/rope_size.hpp"
#include "plan/energy_check.hpp"
#include "plan/forecast.hpp"
#include "run/accuracy.hpp"
#include "run/expectations.hpp"
#include "run/moving_scene.hpp"
#include "run/run_directory.hpp"
#include "run/run_manifest.hpp"
#include "run/run_schedule.hpp"
#include "scene/memory_size.hpp"
#include "scene/network_words.hpp"
#include "scene/parts_in_use.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_files.hpp"
#include "scene/watch.hpp"
#include "sim/contact/line/law.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/dynamics/shorter_steps.hpp"
#include "sim/statics/cost.hpp"
#include "sim/statics/load_steps.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

struct CheckArguments {
  std::string path;       // a scene, or the directory of a run
  bool accuracy = false;  // compares a run with a finer model
  double stretch = 4;     // ps
  std::string against;    // directory of a finer run of the same scene; empty: a stretch is run
};

void say_source(const Scene& scene, const Prepared& p) {
  const Topology& t = p.topology;
  fmt::print("{} tubes, {} elements of {:.4g} nm", t.tubes(), t.elements(), t.longest_element());
  const std::string description = scene.source->description(t, p.state, p.spacing);
  fmt::print("{}{}\n", description.empty() ? "" : ": ", description);
  if (const std::string network = network_words(scene, t, p.state); !network.empty()) fmt::print("{}\n", network);
  if (holds_elements(scene) && !scene.has_ends(Drive::Ends::endless)) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    const Topology strands = strands_of(t);
    for (int strand = 0; strand < strands.tubes(); ++strand) {
      least = std::min(least, free_length(scene, strands, strand));
      most = std::max(most, free_length(scene, strands, strand));
    }
    fmt::print("free length {}{:.5g} nm, from centre to centre of the innermost elements held at both ends\n",
               least < most ? fmt::format("{:.5g} to ", least) : "", most);
  }
  for (const ParameterSet& set : scene.sets) {
    const BondStiffness& k = set.bond;
    std::string bend = fmt::format("{:.5g}", (k.bend + k.bend_difference) * units::eV_in_nN_nm);
    if (k.bend_difference != 0) bend += fmt::format(" and {:.5g}", (k.bend - k.bend_difference) * units::eV_in_nN_nm);
    fmt::print("parameters {} ({}), EA {:.5g} nN, EI {} nN nm^2, GJ {:.5g} nN nm^2, {} bonds\n", set.name, set.path,
               k.stretch * units::eV_in_nN_nm, bend, k.twist * units::eV_in_nN_nm,
               scene.bond.anharmonic ? "anharmonic" : "harmonic");
    if (vector(k.natural).norm() > 0)
      fmt::print("at rest {} has curvatures of {:.4g} and {:.4g}/nm about its axes and a twist of {:.4g} deg/nm\n",
                 set.name, k.natural.x, k.natural.y, k.natural.z / units::degree);
  }
  for (const std::string& grade : grades_of(scene)) fmt::print("grade of {}\n", grade);
  if (t.tubes() > 1)
    if (const std::string size =
            size_words(rope_size(t, packing_cells(t, p.spacing, p.interaction.law.get()), scene.run.mass_scale));
        !size.empty())
      fmt::print("{}\n", size);
  fmt::print("contact law {}", scene.contact.law);
  if (const auto* line = dynamic_cast<const LineLaw*>(p.interaction.law.get()))
    fmt::print(", {} nodes on an element", line->nodes());
  fmt::print("\n");
}

// What tubes do to one another at the start, which forecasts leave out: they come nearer only as the scene moves.
void say_begun(const Scene& scene, const Prepared& p, const Simulation& simulation) {
  const Watched watched = watched_by_run(scene, p, make_observer(scene, p));
  const State& state = simulation.state();
  Peaks now = peaks(p.topology, state, simulation.list(), watched);
  for (std::size_t k = 0; k < limit_count; ++k) {
    const LimitKind& kind = limit_kinds()[k];
    if (kind.limit == &Limits::pressure) now[k] = pressure_peak(p.topology, state, watched);
    if ((kind.limit != &Limits::pressure && kind.limit != &Limits::overlap) || !now[k].passed()) continue;
    fmt::print("note: The scene begins with {} at {:.3g}{}{}, in {}, beyond its limit of {:.3g}: {}; {}.\n", kind.key,
               now[k].value / kind.unit_size, *kind.unit ? " " : "", kind.unit,
               place_in_words(p.topology, watched.held, now[k].element), now[k].limit / kind.unit_size,
               kind.consequence, kind.remedy);
  }
}

void say_limits(const Scene& scene, const Prepared& p) {
  const std::vector<Limits> all = watched_of(scene, p.topology, p.loads, p.interaction.law.get()).limits;
  for (std::size_t type = 0; type < all.size(); ++type) {
    std::string text;
    for (const LimitKind& kind : limit_kinds()) {
      if (!(all[type].*kind.limit > 0)) continue;
      text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", kind.key, all[type].*kind.limit / kind.unit_size);
      const double pressed = kind.limit == &Limits::strain ? all[type].compression : 0;
      if (pressed > 0 && pressed != all[type].strain) text += fmt::format(" and {:.4g}", -pressed);
    }
    fmt::print("watched{}: {}\n", all.size() > 1 ? " in " + scene.sets[type].name : "",
               text.empty() ? "nothing" : text);
  }
}

// The largest files and the memory of a run, as measured on ropes of thousands of elements.
void say_sizes(const Scene& scene, const Prepared& p) {
  const double elements = p.topology.elements(), steps = p.duration / p.time_step;
  const auto outputs = [&](double every, double otherwise) {
    return std::min(every > 0 ? p.duration / every : otherwise, steps) + 1;
  };
  constexpr double row = 810, page = 2e5;                                        // bytes
  constexpr double checkpoints = 600, end = 280;                                 // bytes of an element
  const double frame = scene.run.frames_format == FrameFormat::dump ? 153 : 44;  // likewise
  const double frames = outputs(scene.run.frames_every, 40), rows = outputs(scene.run.log_every, 400);
  const double files = elements * (frames * frame + checkpoints + end) + rows * row + page;
  fmt::print("about {:.2g} MB of memory and {:.2g} MB of files, {:.0f} frames in them\n",
             10 + memory_needed(elements) / 1e6, files / 1e6, frames);
}

// One state of rest by Newton's method, or a curve of them.
void say_statics(const Scene& scene, const Simulation& simulation) {
  const StaticsCost cost = statics_cost(simulation);
  double seconds = cost.first_seconds + cost.stability_seconds;
  std::string what = "one state of rest";
  if (scene.statics.steps > 0) {
    const std::vector<double> times = load_step_times(simulation.loads(), scene.statics.steps);
    seconds += static_cast<double>(times.size() - 1) * (cost.next_seconds + cost.stability_seconds);
    const EndDrives drives = end_drives(simulation.loads(), simulation.topology());
    what = fmt::format("{} states of rest along the schedules, from {:.4g} to {:.4g} ps in them", times.size(),
                       times.front(), times.back());
    if (end_moment(drives))
      what += fmt::format(", {:.4g} to {:.4g} nN nm", moment_at(drives, times.front()) / units::nN_nm,
                          moment_at(drives, times.back()) / units::nN_nm);
  }
  fmt::print(
      "{}, by Newton's method to {:.3g} eV/nm and an energy of the bonds within {:.2g} of the minimum's, at most "
      "{} "
      "steps each\n",
      what, scene.run.goal.force, scene.run.goal.energy, scene.run.max_steps);
  const std::string stability = cost.stability_seconds > 0
                                    ? fmt::format("{:.2g} s each and {:.2g} MB for whether it is stable",
                                                  cost.stability_seconds, cost.decomposition_bytes / 1e6)
                                    : "the rope is too thick for the modes that tell whether it is stable";
  fmt::print("about {:.2g} s in all if each start is near rest, {:.2g} MB of memory; {}\n", seconds,
             10 + (cost.bytes + cost.decomposition_bytes) / 1e6, stability);
}

// Batch systems wait for some seconds after TERM, often 30. `each`: seconds of a step.
void say_stop(const Simulation& simulation, double each) {
  constexpr double disk = 1e8, worth_a_word = 2;  // bytes per second, as disks that many share take them; s
  const double bytes =
                   2.0 * static_cast<double>(simulation.serialise().size()),  // the state, and one to go back to
      seconds = std::max(RunSchedule::patience, 2 * each) + bytes / disk;
  if (seconds < worth_a_word) return;
  fmt::print(
      "told to stop, a run ends after about {:.0f} s: it writes its checkpoint of {:.2g} MB first, here counted "
      "with "
      "100 MB per second\n",
      seconds, bytes / 1e6);
}

// Expectations that were written for another scene than this.
void say_not_judged(const Scene& scene) {
  for (const Expectation& e : scene.expected)
    if (e.of_other_scene)
      fmt::print(
          "not judged: {} {:.6g} ± {:.2g}, since the scene has changed: its scene_hash is \"{}\", and was \"{}\"\n",
          e.column, e.value, e.tolerance, what_is_run_hash(scene.text), e.scene_hash);
}

// A run against the [[expect]] tables of its scene.
int check_run(const RunDirectory& run) {
  Scene scene = read_run_scene(run);
  if (scene.expected.empty())
    throw InputError({run.scene(), 0, ""}, "has no [[expect]] table, so that there is nothing to judge the run by",
                     "write one into the scene: ropewalk help scene expect");
  const Manifest m = read_manifest(run.manifest());
  const Prepared p = prepare(scene);
  const double reached = read_log(run.log()).back()["time_ps"];
  if (m.status != "finished" || (m.reason.empty() && reached < p.duration - 0.75 * p.time_step))
    throw InputError({run.path, 0, ""},
                     fmt::format("is a run that is {} at {:.4g} ps, and is judged at its end", m.status, reached),
                     "go on with it: ropewalk resume " + run.path);
  const std::vector<Judgement> all = judge(scene.expected, run);
  say_not_judged(scene);
  for (const Judgement& j : all) fmt::print("{}\n", j.words);
  return missed(all) > 0 ? not_as_expected : 0;
}

// A run against a finer model.
int check_accuracy(const CheckArguments& a) {
  const RunDirectory dir{a.path};
  const Accuracy accuracy =
      a.against.empty() ? accuracy_by_stretch(dir, a.stretch) : accuracy_against(dir, {a.against});
  fmt::print("{}\n{:20} {:>12} {:>12} {:>10}\n", accuracy.against, "", "here", "finer", "error");
  double largest = 0;
  for (const auto& [name, v] : accuracy.found) {
    fmt::print("{:20} {:12.6g} {:12.6g} {:8.2f} %\n", name, v.here, v.finer, 100 * v.error);
    largest = std::max(largest, v.error);
  }
  fmt::print("at most {:.2f} % off\n", 100 * largest);
  return 0;
}

// Whoever has written a law or a force term has no other test of a wrong sign.
void say_own_forces(const Scene& scene, const Simulation& simulation) {
  constexpr double agrees = 1e-6;
  std::string parts;
  for (const PartInUse& part : parts_in_use(scene))
    if (part.key == "contact.law" || part.words.rfind("drive ", 0) == 0)
      parts += (parts.empty() ? "" : ", ") + part.words;
  if (parts.empty() || simulation.topology().groups.images > 0) return;
  const EnergyCheck found = energy_check(simulation);
  if (found.error() < agrees)
    fmt::print("forces with {}: they follow from the energy to {:.1g}\n", parts, found.error());
  else
    fmt::print(
        "note: With {} the forces do not follow from the energy: along a random motion they give {:.6g} eV/nm, and "
        "the energy {:.6g} eV/nm. If this part has an energy, one of its signs or factors is wrong.\n",
        parts, found.by_forces, found.by_energy);
}

int check_command(const CheckArguments& a) {
  const std::string& path = a.path;
  const bool is_run = std::filesystem::is_directory(path);
  if (a.accuracy && !is_run)
    throw InputError({"", 0, "--accuracy"}, "is for a run, and " + path + " is none",
                     "name the directory of a run");
  if (!a.against.empty() && !a.accuracy)
    throw InputError({"", 0, "--against"}, "stands without --accuracy", "give both");
  if (is_run) return a.accuracy ? check_accuracy(a) : check_run({path});
  Scene scene = read_scene(path);
  const Prepared p = prepare(scene);
  refuse_cooling(scene, p);
  Simulation simulation = start(scene, p);
  if (!scene.stops.empty()) {
    const EnergyAccount none = account_of(simulation, {}, 0);
    refuse_stops_without_value(scene, log_row(make_observer(scene, p), scene, p.topology, p.state, none));
  }
  say_source(scene, p);
  for (const auto& drive : scene.drives) fmt::print("{}\n", drive->words());
  say_own_forces(scene, simulation);
  for (const std::string& what : forgotten(scene.memory, p.interaction)) fmt::print("note: {}\n", what);
  for (const std::string& warning : warnings_of(scene, p)) fmt::print("note: {}\n", warning);
  for (const std::string& warning : warmth_of(scene, p)) fmt::print("note: {}\n", warning);
  for (const std::string& warning : limits_ahead(scene, p)) fmt::print("note: {}\n", warning);
  say_begun(scene, p, simulation);
  if (const std::string what = not_foreseen(scene, p); !what.empty()) fmt::print("note: {}\n", what);
  if (const auto helix = helix_ahead(scene, p)) fmt::print("note: {}\n", *helix);
  if (const auto turn = quasi_static(scene, p)) fmt::print("note: {}\n", words_of(*turn));
  say_limits(scene, p);
  for (const Expectation& e : scene.expected)
    if (!e.of_other_scene)
      fmt::print("expected: {} {:.6g} ± {:.2g} {}\n", e.column, e.value, e.tolerance,
                 e.at ? fmt::format("at {:.6g} ps", *e.at) : "at the end");
  say_not_judged(scene);
  if (!scene.expected.empty()) fmt::print("scene_hash \"{}\"\n", what_is_run_hash(scene.text));
  fmt::print(
      "time step {:.4g} fs; stability limit {:.4g} fs (chain {:.3g}, contact {:.3g} rad/ps, damping {:.3g} 1/ps)\n",
      p.time_step / units::fs, p.limit.limit / units::fs, p.limit.chain_frequency, p.limit.contact_frequency,
      p.limit.damping_rate);
  const Energies& e = simulation.forces().energy;
  fmt::print("start: {:.6g} eV in bonds, {:.6g} eV van der Waals, largest force {:.3g} eV/nm\n", e.bonds(), e.vdw,
             simulation.largest_force());
  if (scene.run.mode == RunOptions::Mode::relax && scene.run.solver != RunOptions::Solver::fire) {
    say_statics(scene, simulation);
    return 0;
  }
  if (scene.run.mode == RunOptions::Mode::relax) {
    fmt::print(
        "relaxation to {:.3g} eV/nm and an energy of the bonds within {:.2g} of the minimum's, at most {} steps\n",
        scene.run.goal.force, scene.run.goal.energy, scene.run.max_steps);
    return 0;
  }
  // Processor time of one thread: what else runs on this machine has no say in it.
  const int threads = threads_in_use();
  use_threads(1);
  constexpr long sample = 20;
  const double each = with_shorter_steps(simulation, [](Simulation& s) {
    const double began = processor_seconds();
    s.steps(sample);
    return (processor_seconds() - began) / sample;
  });
  use_threads(threads);
  const double steps = p.duration / p.time_step;
  fmt::print("{:.4g} ps = {:.0f} steps, about {:.2g} s on one core\n", p.duration, steps, steps * each);
  say_sizes(scene, p);
  say_stop(simulation, each);
  return 0;
}

}  // namespace

void add_check(CLI::App& app, Program& program) {
  const auto a = std::make_shared<CheckArguments>();
  CLI::App* c = app.add_subcommand(
      "check",
      "Read a scene, say what it would do and how long it would take; or judge a run by the [[expect]] "
      "tables of its scene, or by a finer model");
  c->add_option("scene", a->path, "Scene file (TOML), or the directory of a finished run")->required();
  c->add_flag("--accuracy", a->accuracy,
              "Of a run: continue it with its own model and with a finer one, and print how far they differ");
  c->add_option("--stretch", a->stretch, "With --accuracy: ps that both models go on")
      ->capture_default_str()
      ->check(number_within(Bounds::positive()));
  c->add_option("--against", a->against,
                "With --accuracy: directory of a run of the same scene by a finer model, in place of the stretch");
  c->callback([a, &program] { program.code = check_command(*a); });
}

}  // namespace ropewalk
