#include "scene/scene_place.hpp"

#include <filesystem>
#include <sstream>

#include "io/toml_text.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

// The table of a list that is meant.
const toml::node* one_of(const toml::array& list, const std::string& key, int of_list) {
  if (of_list >= 0) return list.get(static_cast<std::size_t>(of_list));
  for (const toml::node& one : list)
    if (const toml::table* table = one.as_table(); table && table->contains(key)) return &one;
  return list.get(0);
}

int line_in(const toml::table& top, const std::string& key, int of_list) {
  std::istringstream parts(key);
  const toml::node* at = &top;
  int line = 0;
  for (std::string part; std::getline(parts, part, '.');) {
    if (const toml::array* list = at->as_array()) at = one_of(*list, part, of_list);
    if (at && at != &top && line_of(*at) > 0) line = line_of(*at);
    const toml::table* table = at ? at->as_table() : nullptr;
    at = table ? table->get(part) : nullptr;
    if (!at) return line;
    if (line_of(*at) > 0) line = line_of(*at);
  }
  if (const toml::array* list = at->as_array(); list && list->is_array_of_tables() && of_list >= 0)
    if (const toml::node* one = one_of(*list, "", of_list)) line = line_of(*one);
  return line;
}

}  // namespace

InputError::Place place_in(const Scene& scene, const std::string& key, int of_list) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(scene.path, none)) return {scene.path, 0, key};
  return {scene.path, line_in(parsed_toml(scene.text, scene.path), key, of_list), key};
}

}  // namespace ropewalk
