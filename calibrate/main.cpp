// ropewalk-calibrate, also reached as `ropewalk calibrate`: parameter sets from atomistic data. Exit codes: 0
// done, 2 wrong input, 3 a calculation that failed.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/command_line.hpp"
#include "io/data_files.hpp"
#include "io/program.hpp"
#include "model/error.hpp"
#include "verbs/verbs.hpp"
#include "version.hpp"

namespace ropewalk::calibrate {

// Each verb has a file, a line here, and one in main(). The first is what the program does without a verb.
void add_calibrate(CLI::App& app, Program& program);
void add_fit(CLI::App& app, Program& program);
void add_show(CLI::App& app, Program& program);
void add_check_shipped(CLI::App& app, Program& program);
void add_friction(CLI::App& app, Program& program);
void add_pull(CLI::App& app, Program& program);
void add_fluctuations(CLI::App& app, Program& program);
void add_universal(CLI::App& app, Program& program);

}  // namespace ropewalk::calibrate

namespace {

using namespace ropewalk;
using namespace ropewalk::calibrate;

// The command as it can be typed in a shell.
std::string command_line(int argc, char** argv) {
  std::string text = "ropewalk calibrate";
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    text += word.find_first_of(" \t\n\"'$`\\()") == std::string::npos ? " " + word : " '" + word + "'";
  }
  return text;
}

int failed(const char* name, const std::exception& error) {
  if (interrupted_by() == 0 || error_code(error) != 3) return report_error(name, error);
  std::fprintf(stderr, "\n%s: interrupted; nothing was written\n", name);
  return 128 + interrupted_by();
}

}  // namespace

int main(int argc, char** argv) {
  begin_program("ropewalk calibrate");
  CLI::App app(
      "ropewalk calibrate derives a tube's parameter set from atomistic data: stiffnesses from relaxed LAMMPS\n"
      "cells, van der Waals contact from the surface integral, both fitted with NLopt.\n"
      "Example: ropewalk calibrate --chirality 12,6",
      "ropewalk calibrate");
  keep_help_within_width(app);
  app.set_version_flag("--version", std::string("ropewalk-calibrate ") + version + " (" + git_id + ")");
  app.require_subcommand(0, 1);
  Program program{argv, command_line(argc, argv)};
  add_calibrate(app, program);
  add_fit(app, program);
  add_show(app, program);
  add_check_shipped(app, program);
  add_friction(app, program);
  add_pull(app, program);
  add_fluctuations(app, program);
  add_universal(app, program);
  add_describe(app, [] {
    const std::vector<std::string> sets = shipped_sets();
    return Description{"ropewalk-calibrate",
                       version,
                       "",
                       nlohmann::ordered_json::object(),
                       {{"show", sets}, {"friction", sets}, {"pull", sets}}};
  });
  catch_interrupts();
  return run_program(app, argc, program, "ropewalk calibrate", "ropewalk calibrate", {}, failed);
}
