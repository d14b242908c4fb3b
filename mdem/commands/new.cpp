// `new`: a commented scene to start from.
#include <fmt/format.h>

#include <filesystem>

#include "commands/verb.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/toml_table.hpp"
#include "model/error.hpp"
#include "scene/templates.hpp"

namespace ropewalk {
namespace {

struct NewArguments {
  std::string name;
  std::string kind = "rope";
  bool list = false;
  bool brief = false;  // without the keys that have their defaults
  bool force = false;
};

const SceneTemplate& find_template(const std::string& kind) {
  for (const SceneTemplate& t : scene_templates())
    if (t.name == kind) return t;
  std::vector<std::string> names;
  for (const SceneTemplate& t : scene_templates()) names.push_back(t.name);
  const std::string near = nearest_word(kind, names);
  throw InputError({"", 0, "--kind"}, fmt::format("there is no template \"{}\"", printable(kind)),
                   near.empty() ? "see `ropewalk new --list`" : fmt::format("did you mean {}?", near));
}

int new_command(const NewArguments& a) {
  if (a.list) {
    for (const SceneTemplate& t : scene_templates()) fmt::print("{:12} {}\n", t.name, t.description);
    return 0;
  }
  if (a.name.empty())
    throw InputError({"", 0, "name"}, "is missing", "give the scene a name: ropewalk new my-rope --kind rope");
  const SceneTemplate& t = find_template(a.kind);
  const std::string path =
      a.name.size() > 5 && a.name.compare(a.name.size() - 5, 5, ".toml") == 0 ? a.name : a.name + ".toml";
  if (std::filesystem::exists(path) && !a.force)
    throw InputError({path, 0, ""}, "exists", "choose another name or give --force");
  write_file_atomically(path, a.brief ? t.brief : t.text);
  fmt::print("{} written: {}\n{}Look it over, then: ropewalk check {}; ropewalk run {} --out {}\n", path,
             t.description, t.dissipation.empty() ? "" : t.dissipation + "\n", path, path,
             "runs/" + std::filesystem::path(path).stem().string());
  return 0;
}

}  // namespace

void add_new(CLI::App& app, Program& program) {
  const auto a = std::make_shared<NewArguments>();
  CLI::App* c = app.add_subcommand("new", "Write a commented scene to start from");
  c->add_option("name", a->name, "Name of the scene; NAME.toml is written");
  c->add_option("--kind", a->kind, "Which template, see --list")->capture_default_str();
  c->add_flag("--list", a->list, "List the templates");
  c->add_flag("--short", a->brief, "Only the keys that matter, without those that have their defaults");
  c->add_flag("--force", a->force, "Overwrite an existing file");
  c->callback([a, &program] { program.code = new_command(*a); });
}

}  // namespace ropewalk
