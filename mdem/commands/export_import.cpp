// `export` and `import`: a run goes to LAMMPS and comes back.
#include <fmt/format.h>

#include <filesystem>

#include "commands/siblings.hpp"
#include "commands/verb.hpp"
#include "exchange/export_run.hpp"
#include "exchange/import_run.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"
#include "run/terminal_listener.hpp"
#include "scene/lammps_files.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

struct ImportArguments {
  std::string dir;              // that of the export, after LAMMPS has run in it
  bool accept_changes = false;  // of in.rope and what it reads
};

struct ExportArguments {
  std::string scene;   // a file, or the directory of a run
  std::string lammps;  // directory to make
  bool force = false;
  bool quiet = false;
};

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

}  // namespace

void add_export(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ExportArguments>();
  CLI::App* c =
      app.add_subcommand("export", "Write a scene, or the present state of a run, for lmp-ropewalk (MPI)");
  c->add_option("scene", a->scene, "Scene file (TOML), or the directory of a run")->required();
  c->add_option("--lammps", a->lammps, "Directory to make: data, input and a README that says how to run")
      ->required();
  c->add_flag("--force", a->force, "Replace an earlier run or export in it");
  c->callback([a, &program] { program.code = export_command(*a); });
}

void add_import(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ImportArguments>();
  CLI::App* c = app.add_subcommand(
      "import", "Take the results of lmp-ropewalk into the run, to observe, report or resume it");
  c->add_option("dir", a->dir, "Directory of the export, in which lmp-ropewalk has run")->required();
  c->add_flag("--accept-changes", a->accept_changes,
              "Take the states although in.rope, or what it reads, is not what was exported");
  c->callback([a, &program] { program.code = import_command(*a); });
}

}  // namespace ropewalk
