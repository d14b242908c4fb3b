#include "io/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* manifest_format = "ropewalk-manifest-1";
constexpr const char* remedy = "is this the manifest.json of a run? Restore it, or run the scene again";

// One list for writer, reader and documentation, in the order of the file.
template <class M, class Visit>
void visit(M& m, const Visit& v) {
  v({"version", "", "version of the program"}, m.version);
  v({"git_id", "", "commit of the program"}, m.git_id);
  v({"compiler", "", "compiler of the program"}, m.compiler);
  v({"build_type", "", "build type of the program"}, m.build_type);
  v({"instructions", "", "instruction set, which `--instructions` takes to give the same bits elsewhere"},
    m.instructions);
  v({"device", "", "the device that moved the elements, of `--device`; empty: there was none"}, m.device);
  v({"program", "", "name of the program"}, m.program);
  v({"own_parts", "", "drives, loads, laws and kinds of this program alone that the run needs; may be empty"},
    m.own_parts);
  v({"own_forces", "", "forces of one's own, functions of Python, by their names; empty: there were none"},
    m.own_forces);
  v({"threads", "", "threads"}, m.threads);
  v({"seed", "", "seed of the scene"}, m.seed);
  v({"scene_hash", "", "xxh64 of scene.toml"}, m.scene_hash);
  v({"parameter_hash", "", "xxh64 of parameters.toml"}, m.parameter_hash);
  v({"grade", "", "how far each parameter set holds: good, limited or unfit, with the reasons"}, m.grade);
  v({"started", "", "date and time of the start, UTC"}, m.started);
  v({"wall_seconds", "s", "wall time"}, m.wall_seconds);
  v({"steps", "", "time steps"}, m.steps);
  v({"time_step_fs", "fs", "time step"}, m.time_step_fs);
  v({"status", "", "running, finished, interrupted, stopped, refined, failed, not relaxed, or taken from atoms"},
    m.status);
  v({"reason", "", "why it ended, in words; may be empty"}, m.reason);
  v({"scene", "", "name of the scene"}, m.scene);
}

int line_of_byte(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

Json parse(const std::string& path, const std::string& text) {
  try {
    Json json = Json::parse(text);
    if (json.is_object() && json.value("format", "") == manifest_format) return json;
  } catch (const Json::parse_error& e) {
    throw InputError({path, line_of_byte(text, e.byte), ""}, "is not JSON", remedy);
  } catch (const Json::out_of_range&) {
    throw InputError({path, 0, ""}, "holds a number that is too large", remedy);
  } catch (const Json::type_error&) {  // format is not a string
  }
  throw InputError({path, 0, "format"}, fmt::format("\"{}\" is needed", manifest_format), remedy);
}

template <class T>
T value_of(const std::string& path, const Json& json, const char* key) {
  if (!json.contains(key)) throw InputError({path, 0, key}, "is missing", remedy);
  const Json& value = json.at(key);
  const bool fits = std::is_same_v<T, std::string>     ? value.is_string()
                    : std::is_floating_point_v<T>      ? value.is_number()
                    : std::is_same_v<T, std::uint64_t> ? value.is_number_unsigned()
                                                       : value.is_number_integer();
  if (!fits)
    throw InputError({path, 0, key}, fmt::format("{} is not of the right kind", printable(value.dump(), 40)),
                     remedy);
  const T out = value.get<T>();
  // The reason quotes what went wrong; whoever shows it makes it printable.
  if constexpr (std::is_same_v<T, std::string>)
    if (std::string("reason") != key && has_control_character(out))
      throw InputError({path, 0, key}, "holds a control character", remedy);
  if constexpr (std::is_integral_v<T>)
    if (Json(out) != value) throw InputError({path, 0, key}, fmt::format("{} is too large", value.dump()), remedy);
  return out;
}

}  // namespace

std::string manifest_json(const Manifest& manifest) {
  Json json;
  json["format"] = manifest_format;
  visit(manifest, [&](const OutputColumn& key, const auto& value) { json[key.name] = value; });
  // A message may quote a file that is not UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<OutputColumn> manifest_keys() {
  std::vector<OutputColumn> keys = {{"format", "", manifest_format}};
  const Manifest manifest;
  visit(manifest, [&](const OutputColumn& key, const auto&) { keys.push_back(key); });
  return keys;
}

Manifest read_manifest(const std::string& path) {
  const Json json = parse(path, read_file(path));
  Manifest manifest;
  visit(manifest, [&](const OutputColumn& key, auto& value) {
    // Not written by earlier versions.
    for (const char* later : {"grade", "instructions", "device", "program", "own_parts", "own_forces"})
      if (std::string(later) == key.name && !json.contains(key.name)) return;
    value = value_of<std::decay_t<decltype(value)>>(path, json, key.name);
  });
  return manifest;
}

}  // namespace ropewalk
