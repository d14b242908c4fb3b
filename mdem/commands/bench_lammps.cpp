// `bench --lammps N`: the simulator on N threads and LAMMPS on N ranks, by turns in one run, since the speed of a
// machine wanders from minute to minute.
#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/bench_scenes.hpp"
#include "commands/commands.hpp"
#include "commands/siblings.hpp"
#include "io/files.hpp"
#include "model/error.hpp"
#include "run/cores.hpp"
#include "run/processor_time.hpp"
#include "run/threads.hpp"
#include "scene/prepare.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() : path_((fs::temp_directory_path() / "ropewalk-bench-XXXXXX").string()) {
    if (!mkdtemp(path_.data()))
      throw InputError({path_, 0, ""}, "cannot be made", "set TMPDIR to a directory that can be written");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

// Of all steps, in s; processor time is that of all threads or ranks, waiting included.
struct Seconds {
  double wall = 1e300, processor = 1e300;

  void take_shorter(const Seconds& o) {
    wall = std::min(wall, o.wall);
    processor = std::min(processor, o.processor);
  }
};

Seconds native_seconds(const Scene& scene, const Prepared& prepared, const BenchArguments& a) {
  use_threads(a.lammps);
  Simulation simulation = start(scene, prepared);
  const double began = omp_get_wtime(), used = processor_seconds();
  simulation.steps(a.steps, false);
  return {omp_get_wtime() - began, processor_seconds() - used};
}

// The number that follows `said`; 0: there is none.
double number_behind(const std::string& text, const std::string& said) {
  const std::size_t at = text.find(said);
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + said.size(), nullptr);
}

// As LAMMPS prints them.
Seconds lammps_seconds(const std::string& folder, const BenchArguments& a) {
  const std::string program = find_program("lammps", "lmp-ropewalk"), out = folder + "/bench.txt",
                    ranks = a.lammps > 1 ? fmt::format("mpirun --oversubscribe -np {} ", a.lammps) : "";
  give_back_cores();
  const std::string command = fmt::format(
      "cd '{}' && OMP_NUM_THREADS=1 {}'{}' -in in.rope -log none -var steps {} -var every {} -var forces {} > '{}' "
      "2>&1 "
      "< /dev/null",
      folder, ranks, program, a.steps, a.steps + 1, a.plain ? "plain" : "engine", out);
  const int status = std::system(command.c_str());
  const std::string text = read_file(out), loop = "Loop time of ";
  const std::size_t at = text.find(loop);
  if (status != 0 || at == std::string::npos)
    throw InputError(
        {program, 0, ""},
        fmt::format("has failed: {}", text.substr(text.size() - std::min<std::size_t>(text.size(), 300))),
        "build all targets, with LAMMPS's library and mpirun installed");
  const double wall = number_behind(text, loop);
  const std::size_t use = text.find("% CPU use with", at), from = text.rfind('\n', use) + 1;
  const double share = use == std::string::npos ? 0 : std::strtod(text.c_str() + from, nullptr) / 100;
  return {wall, wall * share * a.lammps};
}

}  // namespace

int bench_lammps(const BenchArguments& a) {
  constexpr int rounds = 5;
  const TemporaryFolder folder;
  std::string file = a.scene;
  Scene scene = bench_scene(a.scene, a.law);
  if (const std::string text = bench_scene_text(a.scene, a.law); !text.empty()) {
    file = folder.file("bench.toml");
    write_file_atomically(file, text);
  }
  ExportArguments to;
  to.scene = file;
  to.lammps = folder.file("lammps");
  to.quiet = true;
  export_command(to);
  const Prepared prepared = prepare(scene);
  Seconds native, lammps;
  for (int round = 0; round < rounds; ++round) {
    native.take_shorter(native_seconds(scene, prepared, a));
    lammps.take_shorter(lammps_seconds(to.lammps, a));
  }
  const double each = 1e9 / (static_cast<double>(prepared.topology.elements()) * static_cast<double>(a.steps)),
               ratio = lammps.wall / native.wall, processor_ratio = lammps.processor / native.processor;
  if (a.json) {
    nlohmann::ordered_json out;
    out["scene"] = a.scene;
    out["elements"] = prepared.topology.elements();
    out["steps"] = a.steps;
    out["rounds"] = rounds;
    out["threads_or_ranks"] = a.lammps;
    out["forces"] = a.plain ? "plain" : "engine";
    out["native_ns_per_element_step"] = native.wall * each;
    out["lammps_ns_per_element_step"] = lammps.wall * each;
    out["lammps_over_native"] = ratio;
    out["native_processor_ns_per_element_step"] = native.processor * each;
    out["lammps_processor_ns_per_element_step"] = lammps.processor * each;
    out["lammps_over_native_processor"] = processor_ratio;
    fmt::print("{}\n", out.dump(1));
    return 0;
  }
  const char* s = a.lammps == 1 ? "" : "s";
  fmt::print(
      "{} elements, {} steps from the start, the shortest of {} rounds by turns\n"
      "{:9.1f} ns per element-step, {:.1f} of processor time: native on {} thread{}\n"
      "{:9.1f} ns per element-step, {:.1f} of processor time: LAMMPS on {} rank{}{}\n"
      "{:9.2f} times as long, {:.2f} times the processor time\n",
      prepared.topology.elements(), a.steps, rounds, native.wall * each, native.processor * each, a.lammps, s,
      lammps.wall * each, lammps.processor * each, a.lammps, s, a.plain ? ", by the plain forms" : "", ratio,
      processor_ratio);
  return 0;
}

}  // namespace ropewalk
