// `bench`: the cost of a step and where it goes.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "bench/step_cost.hpp"
#include "commands/verb.hpp"
#include "model/error.hpp"
#include "run/use_device.hpp"
#include "scene/prepare.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/device/device_stepper.hpp"
#include "sim/threads/threads.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
namespace {

struct BenchArguments {
  std::string scene;         // a file, or a name of --list
  std::string law;           // contact law of a named scene; empty: line
  std::string instructions;  // for the contact; empty: the machine's best
  std::string device;        // empty: none
  long steps = 200;
  double after = -1;               // ps that the scene runs before it is measured; less than zero: as --list has it
  std::vector<int> threads = {1};  // measured one after another
  bool list = false;
  bool json = false;
};

void print(const StepCost& c, const BenchArguments& a, const Prepared& prepared) {
  const StepTiming& t = c.each;
  const double n = prepared.topology.elements();
  fmt::print("{} elements, {} thread{}, {} steps of {:.3g} fs\n", n, c.threads, c.threads == 1 ? "" : "s", a.steps,
             prepared.time_step / units::fs);
  fmt::print("{:9.1f} ns per element-step, {:.1f} of processor time\n", t.wall, t.processor);
  fmt::print("{:9.1f} pairs per element (half list)\n", c.pairs);
  fmt::print(
      "  contact {:.1f}  bonds {:.1f}  list {:.1f}  integration {:.1f} ns; {} lists, the last with "
      "a skin of {:.3g} nm\n",
      t.contact, t.bonds, t.list, t.integration, t.builds, c.skin);
  if (c.radial.spans > 0)
    fmt::print(
        "{:9.1f} spans of neighbours per element, {:.1f} nodes each; {:.0f} radial evaluations, {:.0f} % of them "
        "within the "
        "cutoff, {:.3f} ns each; {:.1f} GFLOP/s in contact\n",
        c.radial.spans, per(c.radial.nodes, c.radial.spans), c.radial.evaluations,
        100 * per(c.radial.useful, c.radial.evaluations), per(t.contact, c.radial.evaluations),
        operations_per_ns(c, prepared.interaction));
  fmt::print("{:9.0f} bytes per element, and {:.0f} for the list; {:.0f} MB resident at most\n", c.bytes,
             c.list_bytes, c.peak_bytes * 1e-6);
  fmt::print("{:9.1f} GB/s moved, about\n", per(c.moved, t.wall));
  fmt::print("{:9.2f} s of wall time per simulated ns\n", t.wall * n * 1e-9 / prepared.time_step * 1e3);
}

// Times the steps of a scene whose elements a device moves.
int bench_device(const BenchArguments& a) {
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  if (a.threads.size() > 1)
    throw InputError({"", 0, "--threads"}, "is a list, and a device is measured once", "give one number");
  use_threads(a.threads.front());
  use_instructions(a.instructions);
  const double after = a.after < 0 ? bench_after(a.scene) : a.after;
  Simulation simulation = start(scene, prepared);
  use_device(simulation, a.device);
  simulation.steps(std::llround(after / prepared.time_step), false);
  simulation.steps(std::max(5L, a.steps / 10), false);
  const long lists = simulation.list().builds();
  const double listed = simulation.list_seconds(), began = omp_get_wtime();
  simulation.steps(a.steps, false);
  const double seconds = omp_get_wtime() - began, of_lists = simulation.list_seconds() - listed;
  const double n = prepared.topology.elements(), each = 1e9 / (n * static_cast<double>(a.steps));
  const DeviceStepper& device = *simulation.device();
  if (a.json) {
    nlohmann::ordered_json out;
    out["scene"] = a.scene;
    out["device"] = device.name();
    out["elements"] = prepared.topology.elements();
    out["moved_by_the_host"] = device.hosted().size();
    out["threads"] = threads_in_use();
    out["steps"] = a.steps;
    out["after_ps"] = after;
    out["time_step_fs"] = prepared.time_step / units::fs;
    out["ns_per_element_step"] = seconds * each;
    out["list_ns_per_element_step"] = of_lists * each;
    out["list_builds"] = simulation.list().builds() - lists;
    out["device_bytes_per_element"] = static_cast<double>(device.bytes()) / n;
    fmt::print("{}\n", out.dump(1));
    return 0;
  }
  fmt::print("{:.0f} elements on \"{}\", {} of them moved by the host, {} steps of {:.3g} fs\n", n, device.name(),
             device.hosted().size(), a.steps, prepared.time_step / units::fs);
  fmt::print("{:9.2f} ns per element-step, {:.2f} of them for {} lists, which {} thread{} of the host made\n",
             seconds * each, of_lists * each, simulation.list().builds() - lists, threads_in_use(),
             threads_in_use() == 1 ? "" : "s");
  fmt::print("{:9.3f} ms a step; {:.0f} bytes per element on the device, about\n",
             seconds * 1e3 / static_cast<double>(a.steps), static_cast<double>(device.bytes()) / n);
  fmt::print("{:9.2f} s of wall time per simulated ns\n",
             seconds / static_cast<double>(a.steps) / prepared.time_step * 1e3);
  return 0;
}

int bench_command(const BenchArguments& a) {
  if (a.list) {
    for (const BenchScene& s : bench_scenes()) fmt::print("{:18} {}\n", s.name, s.description);
    return 0;
  }
  if (a.scene.empty())
    throw InputError({"", 0, "scene"}, "is missing", "give a file, or see `ropewalk bench --list`");
  if (names_device(a.device)) return bench_device(a);
  Scene scene = bench_scene(a.scene, a.law);
  const Prepared prepared = prepare(scene);
  use_instructions(a.instructions);
  const double after = a.after < 0 ? bench_after(a.scene) : a.after;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const int threads : a.threads) {
    use_threads(threads);
    const StepCost cost = cost_of_step(scene, prepared, after, a.steps);
    if (a.json) {
      all.push_back(json_of(cost, a.scene, a.steps, prepared));
    } else {
      print(cost, a, prepared);
    }
  }
  if (a.json) fmt::print("{}\n", (all.size() == 1 ? all[0] : all).dump(1));
  return 0;
}

// An option of earlier versions: refused with what to do instead.
void add_retired(CLI::App* c, const std::string& name, const std::string& remedy) {
  c->add_option_function<std::string>(
       name,
       [name, remedy](const std::string&) {
         throw InputError({"", 0, name}, "is no option any more", remedy);
       },
       "")
      ->expected(0, 1)
      ->group("");
}

}  // namespace

void add_bench(CLI::App& app, Program& program) {
  const auto a = std::make_shared<BenchArguments>();
  CLI::App* c = app.add_subcommand("bench", "Time the steps of a scene");
  c->add_option("scene", a->scene, "Scene file (TOML), or a name of --list");
  c->add_flag("--list", a->list, "List the scenes that have a name");
  c->add_option("--law", a->law, "Contact law of a named scene: line or paper [default: line]")
      ->check(CLI::IsMember({"line", "paper"}));
  c->add_option("--steps", a->steps, "Time steps")->capture_default_str()->check(whole_number(1));
  c->add_option("--after", a->after,
                "Time that the scene runs before it is measured, ps [default: as --list has it, or 0]")
      ->check(number_within(Bounds::non_negative()));
  c->add_option("--threads", a->threads, "Threads; 1,2: both, one after the other [default: 1]")
      ->delimiter(',')
      ->check(thread_range());
  add_instructions(c, a->instructions, "the contact", instruction_sets().front());
  add_device(c, a->device, "none");
  c->add_flag("--json", a->json, "JSON");
  const std::string export_it =
      "export the scene (ropewalk export SCENE --lammps DIR) and read LAMMPS's own \"Loop time\"";
  add_retired(c, "--lammps", export_it);
  add_retired(c, "--plain", export_it);
  add_retired(c, "--parts", export_it + " on several ranks");
  c->callback([a, &program] {
    wait_briefly(program.argv, *std::max_element(a->threads.begin(), a->threads.end()));
    program.code = bench_command(*a);
  });
}

}  // namespace ropewalk
