// `bench --device NAME` measures the step of a scene whose elements are on a device.
#include <fmt/format.h>
#include <omp.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "commands/commands.hpp"
#include "model/error.hpp"
#include "run/use_device.hpp"
#include "scene/prepare.hpp"
#include "sim/device/device_stepper.hpp"
#include "sim/threads/threads.hpp"
#include "sim/threads/vector_unit.hpp"

namespace ropewalk {
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

}  // namespace ropewalk
