// `ropewalk calibrate fluctuations RUN`: stiffnesses of tubes from how they move in heat.
#include "fluctuations/fluctuations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/data_files.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/parameters_toml.hpp"
#include "observe/time_mean.hpp"
#include "run/run_directory.hpp"
#include "scene/missing_forces.hpp"
#include "sim/dynamics/thermostat.hpp"
#include "verbs/verbs.hpp"
#include "version.hpp"

namespace ropewalk::calibrate {
namespace {

struct FluctuationsArguments {
  std::string run;         // its directory
  double temperature = 0;  // K; 0: that of the run's thermostat
  double after = 0;        // ps, which are left out
  std::string against;     // set to compare with; empty: the run's
  std::string out;         // set to write; empty: none
  bool json = false, force = false;
  std::string command;
};

constexpr auto fewest_frames = static_cast<long>(least_independent);
constexpr double much_static = 0.1;

// One number of the result, with that of a set.
struct Line {
  const char* key;  // of the set
  const char* name;
  const char* unit;
  Measured RodStiffness::*value;
};
constexpr double in_nN = units::eV_in_nN_nm;
constexpr Line lines[] = {{"bond.EA", "EA", "nN", &RodStiffness::EA},
                          {"bond.EI", "EI_x", "nN nm^2", &RodStiffness::EI_x},
                          {"bond.EI", "EI_y", "nN nm^2", &RodStiffness::EI_y},
                          {"bond.GJ", "GJ", "nN nm^2", &RodStiffness::GJ},
                          {"atomistic.coupling", "coupling", "nN nm", &RodStiffness::coupling}};

double temperature_of(const Scene& scene, const FluctuationsArguments& a) {
  if (a.temperature > 0) return a.temperature;
  const ThermostatOptions* bath = scene.bath();
  if (!bath)
    throw InputError({scene.path, 0, "--temperature"}, "is missing, and the run has no thermostat",
                     "give the temperature of the motion in K");
  const double end = bath->temperature.last();
  if (std::fabs(bath->temperature.value(a.after) - end) > 1e-9 * end)
    throw InputError({scene.path, 0, "thermostat"}, fmt::format("changes the temperature after {:g} ps", a.after),
                     "skip that time by --after");
  return end;
}

// The sums of each type of tube.
std::vector<FluctuationSums> read_motion(const RunDirectory& dir, Scene& scene, const FluctuationsArguments& a) {
  const Prepared prepared = prepare(scene);
  const Topology& topology = prepared.topology;
  std::vector<FluctuationSums> sums;
  for (const TubeType& type : topology.types) sums.emplace_back(type.element_length);
  const auto frames = open_frames(dir.frames());
  StoredFrame frame;
  long read = 0, used = 0;
  for (; frames->next(topology, frame); ++read) {
    if (frame.state.time < a.after) continue;
    ++used;
    for (int t = 0; t < topology.tubes(); ++t)
      if (topology.length_of(t) > 2)
        sums[static_cast<std::size_t>(topology.tube_type[static_cast<std::size_t>(t)])].add_chain(
            frame.state, static_cast<std::size_t>(topology.tube_begin[static_cast<std::size_t>(t)]),
            topology.length_of(t));
    for (FluctuationSums& sum : sums) sum.end_frame();
  }
  if (used < fewest_frames)
    throw InputError(
        {dir.frames(), 0, "--after"},
        fmt::format("{} of its {} frames lie after {:g} ps, and {} are needed", used, read, a.after, fewest_frames),
        "take a longer run, or more frames: run.frames_every_ps");
  return sums;
}

std::string number(const Measured& m) {
  if (!std::isfinite(m.standard_error)) return fmt::format("{:.5g} +- ?", m.value * in_nN);
  return fmt::format("{:.5g} +- {:.2g}", m.value * in_nN, m.standard_error * in_nN);
}

void print_result(const Fluctuation& f, const ParameterSet& against, double temperature) {
  fmt::print("{}: {} bonds, {} frames, {:g} K\n", tube_name(against), f.bonds, f.frames, temperature);
  fmt::print("{:>8} {:>20} {:>20} {:>20} {:>20} {:>20}\n", "bonds", "EA (nN)", "EI x (nN nm^2)", "EI y (nN nm^2)",
             "GJ (nN nm^2)", "coupling (nN nm)");
  const auto row = [](const std::string& name, const RodStiffness& k) {
    fmt::print("{:>8} {:>20} {:>20} {:>20} {:>20} {:>20}\n", name, number(k.EA), number(k.EI_x), number(k.EI_y),
               number(k.GJ), number(k.coupling));
  };
  for (const RodStiffness& k : f.windows) row(fmt::format("{}", k.window), k);
  row("rod", f.rod);
  fmt::print("{:>8}", "set");
  for (const Line& line : lines) {
    const Quantity* q = find_quantity(against, line.key);
    fmt::print(" {:>20}", q ? fmt::format("{:.5g}", q->value) : "-");
  }
  fmt::print("\n{:>8}", "ratio");
  for (const Line& line : lines) {
    const Quantity* q = find_quantity(against, line.key);
    const Measured& m = f.rod.*line.value;
    const bool known = q && std::fabs(q->value) > 0.01 * m.standard_error * in_nN;
    fmt::print(" {:>20}", known ? fmt::format("{:.3f} +- {:.2g}", m.value * in_nN / q->value,
                                              std::fabs(m.standard_error * in_nN / q->value))
                                : "-");
  }
  fmt::print("\n");
  if (!f.local)
    fmt::print(
        "note: short and long pieces of the tubes give different stiffnesses: neighbouring bonds are correlated, "
        "or the time is too short. The row \"rod\" is free of what the ends of the pieces add\n");
  if (f.static_part > much_static)
    fmt::print(
        "note: {:.0f} % of the mean square of bends or twist does not fluctuate in this time and is left out: the "
        "tubes are bent or twisted without any heat. Where the time is too short for it, the stiffnesses are too "
        "large\n",
        100 * f.static_part);
  if (f.frames_needed > 0)
    fmt::print(
        "note: \"?\" stands where the motion is too slow for an error: fewer than {:.0f} frames are independent. "
        "Take a run of {:.1f} times the length\n",
        least_independent, f.frames_needed / static_cast<double>(f.frames));
}

nlohmann::ordered_json as_json(const Fluctuation& f, const ParameterSet& against, double temperature) {
  const auto row = [](const RodStiffness& k) {
    nlohmann::ordered_json out = {{"bonds", k.window}};
    for (const Line& line : lines)
      out[fmt::format("{} ({})", line.name, line.unit)] = {
          {"value", (k.*line.value).value * in_nN}, {"standard_error", (k.*line.value).standard_error * in_nN}};
    return out;
  };
  auto windows = nlohmann::ordered_json::array();
  for (const RodStiffness& k : f.windows) windows.push_back(row(k));
  return {{"set", against.name}, {"temperature_K", temperature}, {"frames", f.frames},
          {"bonds", f.bonds},    {"windows", windows},           {"rod", row(f.rod)},
          {"local", f.local},    {"static_part", f.static_part}};
}

// The set with the stiffnesses of the motion.
ParameterSet with_stiffness(ParameterSet set, const Fluctuation& f, double temperature,
                            const FluctuationsArguments& a) {
  const Measured bend{0.5 * (f.rod.EI_x.value + f.rod.EI_y.value),
                      0.5 * std::hypot(f.rod.EI_x.standard_error, f.rod.EI_y.standard_error)};
  const std::pair<const char*, Measured> numbers[] = {
      {"bond.EA", f.rod.EA}, {"bond.EI", bend}, {"bond.GJ", f.rod.GJ}, {"atomistic.coupling", f.rod.coupling}};
  for (const auto& [key, m] : numbers)
    if (!std::isfinite(m.standard_error))
      throw InputError(
          {a.run, 0, "--out"}, fmt::format("{} has no error: the motion is too slow for this time", key),
          fmt::format("take a run of {:.1f} times the length", f.frames_needed / static_cast<double>(f.frames)));
  for (const auto& [key, m] : numbers)
    for (Quantity& q : set.quantities)
      if (q.key == key) {
        q.value = m.value * in_nN;
        q.standard_error = m.standard_error * in_nN;
        q.origin = "calibrated";
        q.doi.clear();
        q.note = fmt::format("from fluctuations at {:g} K, {} bonds and {} frames", temperature, f.bonds, f.frames);
      }
  // Their errors are no longer those of the fit that the correlations come from.
  set.correlations.erase(std::remove_if(set.correlations.begin(), set.correlations.end(),
                                        [&](const Correlation& c) {
                                          return std::any_of(c.of.begin(), c.of.end(), [&](const std::string& key) {
                                            return std::any_of(std::begin(numbers), std::end(numbers),
                                                               [&](const auto& n) { return key == n.first; });
                                          });
                                        }),
                         set.correlations.end());
  set.provenance.emplace_back("fluctuations_command", a.command);
  set.provenance.emplace_back("fluctuations_program", fmt::format("ropewalk {} ({})", version, git_id));
  return set;
}

int fluctuations_command(const FluctuationsArguments& a) {
  if (!a.out.empty()) check_output(a.out, "--out", a.force);
  const RunDirectory dir{a.run};
  Scene scene = read_run_scene(dir);
  refuse_missing_forces(scene.missing_forces, dir.path);
  if (!a.out.empty() && scene.sets.size() > 1)
    throw InputError({a.run, 0, "--out"}, "the run has several kinds of tubes",
                     "write one set at a time: coarsen them alone");
  std::vector<ParameterSet> against = scene.sets;
  if (!a.against.empty())
    for (ParameterSet& set : against) set = read_parameters(find_parameters(a.against, "", {"", 0, "--against"}));
  const double temperature = temperature_of(scene, a);
  const std::vector<FluctuationSums> sums = read_motion(dir, scene, a);
  auto json = nlohmann::ordered_json::array();
  for (std::size_t type = 0; type < sums.size(); ++type) {
    Fluctuation f;
    try {
      f = sums[type].evaluate(temperature);
    } catch (const std::invalid_argument& e) {
      throw InputError({dir.frames(), 0, ""}, e.what(),
                       "take tubes of three elements or more: --element-length-nm of coarsen");
    }
    if (a.json)
      json.push_back(as_json(f, against[type], temperature));
    else
      print_result(f, against[type], temperature);
    if (a.out.empty()) continue;
    const std::string text = parameters_text(
        with_stiffness(against[type], f, temperature, a),
        "# Stiffnesses from fluctuations at a temperature; all else of " + against[type].name + ".\n");
    parameters_of_text(text, a.out);  // throws where other commands would refuse it
    write_file_atomically(a.out, text);
    fmt::print(a.json ? stderr : stdout, "Set: {}\n", a.out);
  }
  if (a.json) fmt::print("{}\n", json.dump(1));
  return 0;
}

}  // namespace

void add_fluctuations(CLI::App& app, Program& program) {
  const auto a = std::make_shared<FluctuationsArguments>();
  a->command = program.command;
  CLI::App* c = app.add_subcommand(
      "fluctuations",
      "EA, EI, GJ and their coupling from how the tubes of a run move in heat, beside those of a set");
  c->add_option("run", a->run, "Directory of a run: of ropewalk run with a thermostat, or of ropewalk coarsen")
      ->required();
  c->add_option("--temperature", a->temperature, "Of the motion, K [default: that of the run's thermostat]")
      ->check(number_within(Bounds::range(1, 1e4)));
  c->add_option("--after", a->after, "Leave out so much time at the start, ps")
      ->capture_default_str()
      ->check(number_within(Bounds::non_negative()));
  c->add_option("--against", a->against, "Set to compare with: a file or a name [default: that of the run]");
  c->add_option("--out", a->out, "Write that set with these stiffnesses to this file");
  c->add_flag("--json", a->json, "JSON");
  c->add_flag("--force", a->force, "Replace an existing file");
  c->callback([a, &program] { program.code = fluctuations_command(*a); });
}

}  // namespace ropewalk::calibrate
