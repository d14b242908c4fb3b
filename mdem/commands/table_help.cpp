#include "commands/table_help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "io/plain_text.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/scene_keys.hpp"

namespace ropewalk {
namespace {

constexpr const char* keys_heading = "Keys";

std::string stripped(const std::string& text) {
  const std::size_t from = text.find_first_not_of('\n'), to = text.find_last_not_of('\n');
  return from == std::string::npos ? "" : text.substr(from, to + 1 - from);
}

std::string page_name(const SceneTable& table) { return table.name.empty() ? "top" : table.name; }

// Lines of docs/tables.md below "## name" and "### heading"; without a heading those before the first one.
std::string written(const std::string& name, const std::string& heading) {
  std::istringstream page(tables_page);
  std::string text, table, part;
  bool code = false;  // a line of it that begins with # is a comment
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) code = !code;
    if (!code && line.rfind("## ", 0) == 0) {
      table = line.substr(3), part.clear();
    } else if (!code && line.rfind("### ", 0) == 0) {
      part = line.substr(4);
    } else if (table == name && part == heading) {
      text += line + "\n";
    }
  }
  return stripped(text);
}

// The parts of docs/theory.md between <!-- [name] --> and <!-- end -->.
std::string theory_of(const std::string& name) {
  std::istringstream page(theory_page);
  std::string text;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line == "<!-- end -->") {
      if (inside) text += "\n";
      inside = false;
    } else if (line == "<!-- [" + name + "] -->") {
      inside = true;
    } else if (inside) {
      text += line + "\n";
    }
  }
  return stripped(text);
}

bool is_kind(const SceneTable& table) {
  return std::any_of(scene_kinds().begin(), scene_kinds().end(),
                     [&](const SceneKind& kind) { return kind.table.name == table.name; });
}

std::string syntax_of(const SceneTable& table) {
  std::string text;
  if (table.name.empty()) {
    text = "At the top of the file, before the first table.";
  } else {
    text = fmt::format("`{}`, {}.", table.header(),
                       table.listed       ? "any number of times"
                       : is_kind(table)   ? "at most once: a scene has exactly one table that places its elements"
                       : table.optional() ? "at most once; without it there is none"
                                          : "at most once; without it all its keys have their defaults");
  }
  std::vector<std::string> required;
  for (const SceneKey& key : table.keys)
    if (key.required()) required.push_back(fmt::format("`{} = {}`", key.key, key.value));
  if (!required.empty())
    text += fmt::format(" {} to be given, with a value of your own: {}.",
                        required.size() == 1 ? "This key has" : "These keys have", fmt::join(required, ", "));
  return text;
}

std::string one_after_the_other(const std::string& a, const std::string& b) {
  return a + (a.empty() || b.empty() ? "" : "\n\n") + b;
}

}  // namespace

std::vector<TablePart> table_parts(const SceneTable& table) {
  const std::string name = page_name(table);
  const auto as_written = [&](const char* heading) { return TablePart{heading, written(name, heading)}; };
  return {as_written(""),
          {"Syntax", syntax_of(table)},
          as_written("Example"),
          {"Formula", one_after_the_other(theory_of(name), written(name, "Formula"))},
          {keys_heading, "Key, unit and default; below them the meaning.\n\n" + stripped(key_lines(table))},
          as_written("Does not go with"),
          as_written("Related")};
}

std::string table_help(const std::string& name) {
  for (const SceneTable& table : scene_tables()) {
    if (name.empty() || (name != page_name(table) && (table.name.empty() || name != table.header()))) continue;
    std::string text = (table.name.empty() ? "The top of a scene" : table.header()) + "\n";
    for (const TablePart& part : table_parts(table)) {
      if (part.text.empty()) continue;
      text += (part.heading.empty() ? "\n" : "\n## " + part.heading + "\n\n") +
              (part.heading == keys_heading ? part.text + "\n" : markdown_within_width(part.text));
    }
    return text;
  }
  return "";
}

std::string load_help(const std::string& name) {
  for (const LoadKind& kind : load_kinds())
    if (kind.name == name)
      return fmt::format("[[load]] with kind = \"{}\"; `ropewalk help load` has the keys of all loads\n{}", name,
                         key_lines({"load", "", kind.keys}));
  return "";
}

std::vector<std::string> described_tables() {
  std::vector<std::string> out;
  std::istringstream page(tables_page);
  for (std::string line; std::getline(page, line);)
    if (line.rfind("## ", 0) == 0) out.push_back(line.substr(3));
  return out;
}

}  // namespace ropewalk
