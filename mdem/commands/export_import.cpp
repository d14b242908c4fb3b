// `export` and `import`: a run goes to LAMMPS and comes back.
#include <fmt/format.h>

#include <filesystem>

#include "commands/commands.hpp"
#include "commands/siblings.hpp"
#include "exchange/export_run.hpp"
#include "exchange/import_run.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "run/terminal_listener.hpp"
#include "scene/lammps_files.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {

int export_command(const ExportArguments& a) {
  const RunDirectory to{a.lammps};
  TerminalListener terminal(a.quiet);
  if (std::filesystem::is_directory(a.scene))
    export_run({a.scene}, to, a.force, terminal);
  else
    export_scene(read_scene(a.scene), to, a.force, terminal);
  if (!a.quiet)
    fmt::print("{0} written. Go on with: cd {0} && mpirun -np 2 {1} -in in.rope\n", to.path,
               shell_quoted(find_program("lammps", "lmp-ropewalk")));
  return 0;
}

int import_command(const ImportArguments& a) {
  const RunDirectory dir{a.dir};
  if (!std::filesystem::exists(LammpsDirectory{a.dir}.start()))
    throw InputError({a.dir, 0, ""}, "was not made by `ropewalk export` (no lammps.json in it)",
                     "name the directory behind --lammps");
  TerminalListener terminal(false);
  const ImportedRun run = import_run(dir, a.accept_changes, terminal);
  fmt::print("{} states taken over, up to step {}, {:.4g} ps{}\n", run.states, run.step, run.time,
             std::filesystem::exists(dir.report()) ? ". Report: " + dir.report() : "");
  if (!run.passed.empty()) fmt::print("Limits passed: {}\n", run.passed);
  return run.at_rest ? 0 : 4;
}

}  // namespace ropewalk
