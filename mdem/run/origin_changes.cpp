#include "run/origin_changes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "io/toml_table.hpp"
#include "io/toml_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Values = std::map<std::string, std::string>;  // as TOML, by path

void collect(const toml::node& node, const std::string& path, Values& out) {
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  const toml::array* list = node.as_array();
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) collect(value, below(std::string(key.str())), out);
  } else if (list && list->is_array_of_tables()) {
    for (std::size_t k = 0; k < list->size(); ++k) collect((*list)[k], below(std::to_string(k)), out);
  } else {
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    out[path] = text.str();
  }
}

Values values_of(const std::string& text, const std::string& file) {
  Values out;
  collect(parsed_toml(text, file), "", out);
  return out;
}

// Keys that the motion up to here does not depend on; a point at the end stands for a whole table.
constexpr const char* harmless_keys[] = {"name",
                                         "twist.hold_ps",
                                         "run.duration_ps",
                                         "run.frames_every_ps",
                                         "run.frames_format",
                                         "run.log_every_ps",
                                         "run.paraview",
                                         "run.checkpoint_every_s",
                                         "run.force_tolerance_nN",
                                         "run.energy_tolerance",
                                         "run.max_steps",
                                         "observe.",
                                         "limits.",
                                         "stop."};

bool is_harmless(const std::string& key) {
  return std::any_of(std::begin(harmless_keys), std::end(harmless_keys), [&](const std::string& known) {
    return known.back() == '.' ? key.compare(0, known.size(), known) == 0 : key == known;
  });
}

}  // namespace

std::vector<KeyChange> changed_keys(const std::string& before, const std::string& now, const std::string& file) {
  const Values old = values_of(before, file), current = values_of(now, file);
  Values all = old;
  all.insert(current.begin(), current.end());
  const auto words = [](const Values& values, const std::string& key) {
    const auto at = values.find(key);
    return at == values.end() ? std::string("not set") : printable(at->second, 40);
  };
  std::vector<KeyChange> out;
  for (const auto& [key, value] : all) {
    const std::string a = words(old, key), b = words(current, key);
    if (old.count(key) != current.count(key) || (old.count(key) && old.at(key) != current.at(key)))
      out.push_back({key, fmt::format("{}: {} -> {}", printable(key, 60), a, b)});
  }
  return out;
}

OriginChanges changes_of(const RunOrigin& before, const RunOrigin& now, const RunDirectory& dir) {
  OriginChanges out;
  if (before.scene != now.scene)
    for (const KeyChange& c : changed_keys(before.scene, now.scene, dir.scene()))
      (is_harmless(c.key) ? out.harmless : out.others).push_back(c.words);
  for (std::size_t k = 0; k < std::max(before.sets.size(), now.sets.size()); ++k)
    if (k >= before.sets.size() || k >= now.sets.size() || before.sets[k] != now.sets[k])
      out.others.push_back(std::filesystem::path(dir.parameters(k)).filename().string() + " is another one");
  if (before.files != now.files) out.others.push_back("friction-*.toml: another file of friction");
  if (before.own_forces != now.own_forces)
    out.others.push_back(fmt::format("forces of one's own: {} -> {}", before.own_forces, now.own_forces));
  if (before.state != now.state) out.others.push_back("state.csv is another one");
  if (before.version != now.version)
    out.others.push_back(fmt::format("ropewalk {} -> {}", before.version, now.version));
  else if (before.git_id != now.git_id)
    out.harmless.push_back(
        fmt::format("another build of ropewalk {}: {} -> {}", now.version, before.git_id, now.git_id));
  if (before.instructions != now.instructions)
    out.others.push_back(fmt::format("instruction set {} -> {}", before.instructions, now.instructions));
  return out;
}

std::vector<std::string> judged_changes(const OriginChanges& changes, bool accepted, const RunDirectory& dir) {
  if (!changes.others.empty() && !accepted)
    throw InputError({dir.path, 0, ""},
                     fmt::format("is not what the run was begun with: {}", fmt::join(changes.others, "; ")),
                     "put it back, or give --accept-changes to go on all the same");
  std::vector<std::string> remarks;
  for (const auto* list : {&changes.harmless, &changes.others})
    if (!list->empty())
      remarks.push_back(fmt::format("changed since the run was begun: {}", fmt::join(*list, "; ")));
  return remarks;
}

}  // namespace ropewalk
