#include "exchange/lammps_timing.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>

#include "exchange/export_run.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "run/cores.hpp"
#include "run/threads.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

StepsTime native_seconds(const Scene& scene, const Prepared& prepared, int threads, long steps) {
  use_threads(threads);
  Simulation simulation = start(scene, prepared);
  const double began = omp_get_wtime(), used = processor_seconds();
  simulation.steps(steps, false);
  return {omp_get_wtime() - began, processor_seconds() - used};
}

// The number that follows `said`; 0: there is none.
double number_behind(const std::string& text, const std::string& said) {
  const std::size_t at = text.find(said);
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + said.size(), nullptr);
}

// The times that LAMMPS prints.
StepsTime lammps_seconds(const std::string& folder, const std::string& program, int ranks, long steps, bool plain) {
  const std::string out = folder + "/bench.txt",
                    start = ranks > 1 ? fmt::format("mpirun --oversubscribe -np {} ", ranks) : "";
  give_back_cores();
  const std::string command = fmt::format(
      "cd '{}' && OMP_NUM_THREADS=1 {}'{}' -in in.rope -log none -var steps {} -var every {} -var forces {} > '{}' "
      "2>&1 < /dev/null",
      folder, start, program, steps, steps + 1, plain ? "plain" : "engine", out);
  const int status = std::system(command.c_str());
  const std::string text = read_file(out), loop = "Loop time of ";
  const std::size_t at = text.find(loop);
  if (text.find("OMPI_ALLOW_RUN_AS_ROOT") != std::string::npos)
    throw InputError({"mpirun", 0, ""}, "does not start programs for root",
                     "in a container, set OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
  if (status != 0 || at == std::string::npos)
    throw InputError(
        {program, 0, ""},
        fmt::format("has failed: {}", text.substr(text.size() - std::min<std::size_t>(text.size(), 300))),
        "build all targets, with LAMMPS's library and mpirun installed");
  const double wall = number_behind(text, loop);
  const std::size_t use = text.find("% CPU use with", at), from = text.rfind('\n', use) + 1;
  const double share = use == std::string::npos ? 0 : std::strtod(text.c_str() + from, nullptr) / 100;
  return {wall, wall * share * ranks};
}

class Nobody : public RunListener {
  void tell(const std::string&) override {}
};

}  // namespace

LammpsTiming time_beside_lammps(Scene scene, const std::string& program, int ranks, long steps, bool plain,
                                int rounds) {
  const TemporaryFolder folder;
  const RunDirectory to{folder.file("lammps")};
  Nobody nobody;
  export_scene(scene, to, false, nobody);
  const Prepared prepared = prepare(scene);
  LammpsTiming best;
  for (int round = 0; round < rounds; ++round) {
    best.native.take_shorter(native_seconds(scene, prepared, ranks, steps));
    best.lammps.take_shorter(lammps_seconds(to.path, program, ranks, steps, plain));
  }
  return best;
}

}  // namespace ropewalk
