// ropewalk-validate, also called as `ropewalk validate`: compares the model with references it was not fitted to.
#include <CLI/CLI.hpp>
#include <cstring>

#include "cli/command_line.hpp"
#include "io/data_files.hpp"
#include "io/program.hpp"
#include "version.hpp"

namespace ropewalk::validate {

// The verbs: of runner/, chart/ and parametrize/.
void add_list(CLI::App& app, Program& program);
void add_run(CLI::App& app, Program& program);
void add_stability(CLI::App& app, Program& program);
void add_report(CLI::App& app, Program& program);
void add_chart(CLI::App& app, Program& program);
void add_parametrize(CLI::App& app, Program& program);

}  // namespace ropewalk::validate

int main(int argc, char** argv) {
  using namespace ropewalk;
  using namespace ropewalk::validate;
  begin_program("ropewalk validate");
  // `ropewalk parametrize` comes here as it was typed.
  const bool parametrize = argc > 1 && std::strcmp(argv[1], "parametrize") == 0;
  const char* name = parametrize ? "ropewalk" : "ropewalk validate";
  const char* spoken = parametrize ? "ropewalk parametrize" : name;
  CLI::App app(
      "ropewalk validate compares the model with exact theory, LAMMPS references and other codes.\n"
      "Exit code: 0 all hold, 1 some miss, 2 wrong input, 3 a case could not be run.",
      name);
  keep_help_within_width(app);
  app.set_version_flag("--version", std::string("ropewalk-validate ") + version + " (" + git_id + ")");
  app.require_subcommand(1);
  Program program{argv, ""};
  add_list(app, program);
  add_run(app, program);
  add_stability(app, program);
  add_report(app, program);
  add_chart(app, program);
  add_parametrize(app, program);
  add_describe(app, [] {
    return Description{
        "ropewalk-validate", version, "", nlohmann::ordered_json::object(), {{"--parameters", shipped_sets()}}};
  });
  return run_program(app, argc, program, spoken, name);
}
