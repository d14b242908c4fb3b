#include "scene/expectation.hpp"

#include <fmt/format.h>

#include <set>

#include "io/files.hpp"
#include "io/toml_text.hpp"

namespace ropewalk {
namespace {

const std::set<std::string> no_part_of_it = {"name", "expect", "run.frames_every_ps", "run.frames_format",
                                             "run.checkpoint_every_s"};

// Every value on a line behind its path. toml++ has the keys of a table in alphabetical order.
void add_lines(const toml::node& node, const std::string& path, std::string& text) {
  if (no_part_of_it.count(path)) return;
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      add_lines(value, path + (path.empty() ? "" : ".") + std::string(key.str()), text);
  } else if (const toml::array* list = node.as_array()) {
    for (std::size_t k = 0; k < list->size(); ++k) add_lines(*list->get(k), fmt::format("{}.{}", path, k), text);
  } else if (node.is_number()) {
    text += fmt::format("{} = {:.17g}\n", path, *node.value<double>());
  } else if (node.is_boolean()) {
    text += fmt::format("{} = {}\n", path, *node.value<bool>());
  } else {
    text += fmt::format("{} = \"{}\"\n", path, node.value_or(std::string()));
  }
}

}  // namespace

std::string what_is_run_hash(const std::string& scene_text) {
  std::string text;
  add_lines(parsed_toml(scene_text, "scene"), "", text);
  return hash_hex(text);
}

}  // namespace ropewalk
