// The front door of `ropewalk`: reads the command line, calls the verb, and makes one line and an exit code of an
// error.
#include "commands/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "commands/limit_help.hpp"
#include "commands/siblings.hpp"
#include "commands/table_help.hpp"
#include "commands/verb.hpp"
#include "io/data_files.hpp"
#include "io/error_exit.hpp"
#include "io/plain_text.hpp"
#include "io/program.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "observe/limits.hpp"
#include "scene/scene_keys.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"
#include "sim/contact/line/engine.hpp"
#include "version.hpp"

namespace ropewalk {

// Each verb has a file, a line here, and one in ropewalk_main().
void add_new(CLI::App& app, Program& program);
void add_check(CLI::App& app, Program& program);
void add_run(CLI::App& app, Program& program);
void add_resume(CLI::App& app, Program& program);
void add_observe(CLI::App& app, Program& program);
void add_report(CLI::App& app, Program& program);
void add_convert(CLI::App& app, Program& program);
void add_picture(CLI::App& app, Program& program);
void add_view(CLI::App& app, Program& program);
void add_errors(CLI::App& app, Program& program);
void add_compare(CLI::App& app, Program& program);
void add_sweep(CLI::App& app, Program& program);
void add_threshold(CLI::App& app, Program& program);
void add_rest(CLI::App& app, Program& program);
void add_modes(CLI::App& app, Program& program);
void add_gather(CLI::App& app, Program& program);
void add_cite(CLI::App& app, Program& program);
void add_export(CLI::App& app, Program& program);
void add_import(CLI::App& app, Program& program);
void add_atoms(CLI::App& app, Program& program);
void add_coarsen(CLI::App& app, Program& program);
void add_energy(CLI::App& app, Program& program);
void add_bench(CLI::App& app, Program& program);

namespace {

// A verb of earlier versions.
void add_plan(CLI::App& app) {
  CLI::App* c = app.add_subcommand("plan", "")->group("");
  c->allow_extras();
  c->callback([] {
    throw InputError({"", 0, "plan"}, "is no verb any more: the default model is what it chose in most scenes",
                     "run the scene, and hold the run against a finer model: ropewalk check RUN --accuracy");
  });
}

std::vector<std::string> listed_verbs(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    names.push_back(verb->get_name());
  return names;
}

// The page on what is neither a verb nor a key.
std::string page_of(const std::string& topic) {
  if (topic == "yarn")
    return "yarn: docs/how-to/yarn.md says what of a yarn a slice tells; begin with: ropewalk new my-yarn --kind "
           "yarn\n";
  if (topic == "filament")
    return "filament: docs/how-to/filament.md says how to write the parameters of what is no carbon tube, such as "
           "f-actin\n";
  if (topic == "multi-walled" || topic == "multiwalled" || topic == "multi-wall")
    return "multi-walled: tubes inside of one another are refused; docs/how-to/yarn.md has two estimates\n";
  return "";
}

// Help on the keys of a scene. verb_before_help() gives the help of verbs.
void add_help(CLI::App& app) {
  const auto topic = std::make_shared<std::string>();
  CLI::App* c = app.add_subcommand("help", "The help of a verb; help scene: every key of a scene, with its unit");
  c->add_option("topic", *topic,
                "A verb; scene; a table of a scene, as links or [run]; one of its keys; or a limit that a run has "
                "passed [default: the list of verbs]");
  c->callback([&app, topic] {
    if (*topic == "scene") {
      std::puts(scene_key_help().c_str());
      return;
    }
    std::string text;  // one word may be a table, a load, a key, a limit and a page
    for (const std::string& part : {table_help(*topic), load_help(*topic), scene_key_help(*topic), limit_help(*topic),
                                    page_of(*topic)})
      text += (text.empty() || part.empty() ? "" : "\n") + part;
    if (!text.empty()) {
      std::fputs(text.c_str(), stdout);
      return;
    }
    std::vector<std::string> topics = listed_verbs(app);
    topics.emplace_back("scene");
    for (const std::string& limit : limit_headings()) topics.push_back(limit);
    for (const SceneTable& t : scene_tables()) {
      topics.push_back(t.name.empty() ? "top" : t.name);
      for (const SceneKey& k : t.keys) topics.push_back(k.key);
    }
    const std::string near = nearest_word(*topic, topics);
    throw InputError({"", 0, "help"}, "there is nothing on \"" + printable(*topic, 60) + "\"",
                     near.empty() ? "see ropewalk help" : "did you mean " + near + "?");
  });
}

// For describe json: the keys of a scene, and the limits that a run watches.
nlohmann::ordered_json scenes_and_limits() {
  auto scene = nlohmann::ordered_json::array(), limits = scene;
  for (const SceneTable& t : scene_tables()) {
    auto keys = nlohmann::ordered_json::array();
    for (const SceneKey& k : t.keys)
      keys.push_back({{"key", k.key},
                      {"unit", k.unit},
                      {"standard", k.standard.empty() ? k.value : k.standard},
                      {"meaning", k.meaning}});
    auto parts = nlohmann::ordered_json::array();
    for (const TablePart& part : table_parts(t)) parts.push_back({{"heading", part.heading}, {"text", part.text}});
    scene.push_back(
        {{"table", t.name.empty() ? "" : t.header()}, {"meaning", t.meaning}, {"keys", keys}, {"parts", parts}});
  }
  for (const LimitKind& kind : limit_kinds())
    limits.push_back({{"key", kind.key},
                      {"unit", kind.unit},
                      {"what", kind.what},
                      {"consequence", kind.consequence},
                      {"remedy", kind.remedy}});
  return {{"scene", scene}, {"described_tables", described_tables()}, {"limits", limits}};
}

Description description() {
  std::vector<std::string> kinds;
  for (const SceneTemplate& t : scene_templates()) kinds.push_back(t.name);
  const std::vector<std::string> sets = shipped_sets();
  return {"ropewalk",
          version,
          scene_key_help(),
          scenes_and_limits(),
          {{"--kind", kinds}, {"--parameters", sets}, {"compare", sets}},
          {"calibrate", "validate"}};
}

// "help run" as "run --help", and "help" as "--help".
void verb_before_help(const CLI::App& app, int argc, char** argv) {
  static char help[] = "--help";
  if (argc < 2 || argc > 3 || std::string(argv[1]) != "help") return;
  if (argc == 2) argv[1] = help;
  const std::vector<std::string> verbs = listed_verbs(app);
  if (argc == 2 || !std::count(verbs.begin(), verbs.end(), argv[2])) return;
  argv[1] = argv[2];
  argv[2] = help;
}

}  // namespace

int ropewalk_main(int argc, char** argv) {
  begin_program("ropewalk");
  CLI::App app(
      "ropewalk twists carbon-nanotube ropes by the mesoscopic distinct element method.\n"
      "Units: nm, ps, eV; moments nN nm. Every key of a scene carries its unit: ropewalk help scene.\n"
      "Exit code: 0 done, 2 wrong input, 3 stopped with the reason, 4 not relaxed within run.max_steps, 5 stopped "
      "at a limit, 6 stopped by --wall-time, 7 done but more than three times beyond a limit, 8 done but not as "
      "[[expect]] says, 128 + signal.");
  keep_help_within_width(app);
  app.set_version_flag("--version", fmt::format("ropewalk {} ({}), {}, {}, {}", version, git_id, compiler,
                                                build_type, instruction_sets().front()));
  app.require_subcommand(1);
  Program program{argv, ""};
  add_new(app, program);
  add_check(app, program);
  add_run(app, program);
  add_resume(app, program);
  add_observe(app, program);
  add_report(app, program);
  add_convert(app, program);
  add_picture(app, program);
  add_view(app, program);
  add_errors(app, program);
  add_compare(app, program);
  add_sweep(app, program);
  add_threshold(app, program);
  add_rest(app, program);
  add_modes(app, program);
  add_gather(app, program);
  add_cite(app, program);
  add_plan(app);
  add_export(app, program);
  add_import(app, program);
  add_atoms(app, program);
  add_coarsen(app, program);
  // Handed over before anything is parsed; named here for --help.
  app.add_subcommand("calibrate", "Derive a parameter set for any (n,m) from atomistic data");
  app.add_subcommand("validate", "Hold the model against theory, atoms and other codes");
  app.add_subcommand("parametrize",
                     "From a chirality to a validated parameter set: calibrate, make atoms, validate");
  add_energy(app, program);
  add_bench(app, program);
  add_help(app);
  add_describe(app, description);
  return run_program(app, argc, program, "ropewalk", "ropewalk", [&] {
    verb_before_help(app, argc, argv);
    hand_over_to_sibling(argv);
  });
}

}  // namespace ropewalk
