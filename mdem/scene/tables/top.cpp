// The top of a scene: format, name, parameter sets and the length of the elements.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "io/data_files.hpp"
#include "io/parameters_toml.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

void read_format(const TomlTable& top, const Scene&, Scene&) {
  if (!top.has("format"))
    throw top.error("format", "is missing", fmt::format("a scene starts with format = \"{}\"", scene_format));
  const std::string format = top.string("format");
  if (format != scene_format)
    throw top.error("format", fmt::format("is \"{}\"", printable(format, 40)),
                    fmt::format("this program reads \"{}\"", scene_format));
}

void read_name(const TomlTable& top, const Scene& scene, Scene& out) {
  out.name = top.string_or("name", fs::path(scene.path).stem().string());
}

// parameters = "set", or one set for each tube type: ["set", "other"].
std::vector<std::string> read_set_names(const TomlTable& top) {
  if (top.is_string("parameters") || !top.has("parameters")) return {top.string("parameters")};
  return top.strings("parameters");
}

std::vector<ParameterSet> read_sets(const TomlTable& top, const Scene& scene,
                                    const std::vector<std::string>& copies) {
  const std::string folder = fs::path(scene.path).parent_path().string();
  const std::vector<std::string> names = read_set_names(top);
  std::vector<ParameterSet> sets;
  for (std::size_t k = 0; k < names.size(); ++k)
    sets.push_back(read_parameters(
        k < copies.size() ? copies[k]
                          : find_parameters(names[k], folder, {scene.path, top.line("parameters"), "parameters"})));
  return sets;
}

void read_tube_types(const TomlTable& top, const Scene&, Scene& out) {
  const auto sets = static_cast<long>(out.sets.size());
  if (top.has("tube_types")) {
    const std::vector<long> types = top.integers("tube_types", 0, sets - 1);
    out.tube_types = {types.begin(), types.end()};
  } else if (sets > 1 && !top.has("type_shares")) {
    throw top.error(
        "tube_types", "is missing",
        "say the number of the set of each tube: tube_types = [0, 1, ...]; or the part of each: type_shares "
        "= [0.7, 0.3]");
  }
}

void read_type_shares(const TomlTable& top, const Scene&, Scene& out) {
  if (!top.has("type_shares")) return;
  if (!out.tube_types.empty())
    throw top.error("type_shares", "stands beside tube_types", "take one of the two away");
  out.type_shares = top.numbers("type_shares", Bounds::range(0, 1), out.sets.size());
  double sum = 0;
  for (const double share : out.type_shares) sum += share;
  if (std::fabs(sum - 1) > 1e-6)
    throw top.error("type_shares", fmt::format("add up to {:.4g}", sum), "they must add up to 1");
}

void read_element_length(const TomlTable& top, const Scene&, Scene& out) {
  out.element_length = top.number_or("element_length_nm", out.parameters().element_length, Bounds::range(0.05, 50));
}

}  // namespace

KeyTable<Scene> top_table(const std::vector<std::string>& copies) {
  using Key = KeyOf<Scene>;
  return {"",
          "the top of the file, before the first table",
          {Key::custom("format", "", required(fmt::format("\"{}\"", scene_format)), "the version of this format",
                       read_format),
           Key::custom("name", "", otherwise("\"my rope\"", "the file's name"), "title in reports", read_name),
           Key::custom("parameters", "", required("\"cnt-10-10-paper\""),
                       "the tube: a file, looked for beside the scene, or the name of a shipped set; [\"a\", "
                       "\"b\"]: tube types",
                       [copies](const TomlTable& top, const Scene& scene, Scene& out) {
                         out.sets = read_sets(top, scene, copies);
                       }),
           Key::custom("tube_types", "", otherwise("[0, 1, 1]", "all of the first"),
                       "number of the parameter set of each tube, from 0; in a rope of finite tubes one for each "
                       "strand will do",
                       read_tube_types),
           Key::custom("type_shares", "", otherwise("[0.7, 0.3]", "tube_types"),
                       "or the part of the tubes that are of each set: drawn at random with start.seed",
                       read_type_shares),
           Key::custom("element_length_nm", "nm", otherwise("1.356", "the set's"),
                       "length of an element; law \"paper\" needs the set's", read_element_length)},
          {}};
}

}  // namespace ropewalk
