#include "exchange/lammps_timing.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>

#include "exchange/export_run.hpp"
#include "io/child_process.hpp"
#include "io/clocks.hpp"
#include "io/files.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "run/cores.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/shorter_steps.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

StepsTime native_seconds(const Scene& scene, const Prepared& prepared, int threads, long steps) {
  use_threads(threads);
  return with_shorter_steps(start(scene, prepared), [&](Simulation& simulation) {
    const double began = omp_get_wtime(), used = processor_seconds();
    simulation.steps(steps, false);
    return StepsTime{omp_get_wtime() - began, processor_seconds() - used};
  });
}

// The number that follows `said`; 0: there is none.
double number_behind(const std::string& text, const std::string& said) {
  const std::size_t at = text.find(said);
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + said.size(), nullptr);
}

// The times that LAMMPS prints.
StepsTime lammps_seconds(const std::string& folder, const std::string& program, int ranks, long steps, bool plain) {
  ChildOptions options;
  options.folder = folder;
  options.output = folder + "/bench.txt";
  options.quiet_seconds = options.max_seconds = 24 * 3600;
  options.starts_ranks = ranks > 1;
  give_back_cores();
  std::vector<std::string> command;
  if (ranks > 1) command = {"mpirun", "--oversubscribe", "-np", std::to_string(ranks)};
  for (const std::string& word :
       {program, std::string("-in"), std::string("in.rope"), std::string("-log"), std::string("none"),
        std::string("-var"), std::string("steps"), std::to_string(steps), std::string("-var"), std::string("every"),
        std::to_string(steps + 1), std::string("-var"), std::string("forces"),
        std::string(plain ? "plain" : "engine")})
    command.push_back(word);
  const ChildEnd end = run_child(command, options);
  const std::string text = read_file(options.output), loop = "Loop time of ";
  const std::size_t at = text.find(loop);
  if (text.find("OMPI_ALLOW_RUN_AS_ROOT") != std::string::npos)
    throw InputError({"mpirun", 0, ""}, "does not start programs for root",
                     "in a container, set OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
  if (end.kind != ChildEnd::Kind::exited || end.code != 0 || at == std::string::npos)
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
