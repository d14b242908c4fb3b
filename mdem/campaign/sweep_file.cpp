#include "campaign/sweep_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "io/files.hpp"
#include "io/log.hpp"
#include "io/plain_text.hpp"
#include "io/toml_table.hpp"
#include "io/toml_text.hpp"
#include "model/error.hpp"
#include "plan/scene_edit.hpp"
#include "scene/kinds/scene_kind.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"

namespace ropewalk {
namespace {

constexpr const char* format_name = "ropewalk-sweep-1";
constexpr std::size_t most_points = 100000;
constexpr double relax_ps = 40;            // a guess: dynamics over this time cost as much as a relaxation
constexpr std::size_t longest_name = 230;  // name of a point, bytes; file systems take 255, with "start-" and ".txt"
constexpr std::size_t longest_value = 24;  // in the name of a point; a longer one is named by its number

// --- Reading [vary] ---

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

std::string as_toml(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& value) {
    using Node = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Node, toml::table>) {
      std::string inside;
      for (const auto& [key, v] : value)
        inside +=
            fmt::format("{}{} = {}", inside.empty() ? "" : ", ", toml_key(std::string(key.str())), as_toml(v));
      out << "{ " << inside << " }";
    } else if constexpr (std::is_same_v<Node, toml::array>) {
      std::string inside;
      for (const toml::node& v : value) inside += (inside.empty() ? "" : ", ") + as_toml(v);
      out << "[" << inside << "]";
    } else if constexpr (std::is_same_v<Node, toml::value<double>>) {
      out << fmt::format("{}", value.get());  // the shortest that reads back to the same bits
    } else {
      out << toml::toml_formatter(value);
    }
  });
  return out.str();
}

bool is_range(const toml::table& table) { return table.contains("from") && table.contains("to"); }

// { from, to, points } or { from, to, step }, evenly or, with log = true, in even ratios.
std::vector<std::string> values_of_range(const toml::table& table, const std::string& key,
                                         const std::string& file) {
  const InputError::Place at{file, line_of(table), key};
  const auto number = [&](const char* name) {
    const auto value = table[name].value<double>();
    if (!value || !std::isfinite(*value))
      throw InputError(at, fmt::format("\"{}\" is not a number", name), "write { from = 1, to = 9, points = 5 }");
    return *value;
  };
  for (const auto& [name, value] : table)
    if (name != "from" && name != "to" && name != "points" && name != "step" && name != "log")
      throw InputError(at, fmt::format("unknown key \"{}\"", std::string(name.str())),
                       "a range has from, to, points or step, and log");
  const double from = number("from"), to = number("to");
  const bool log = table["log"].value_or(false);
  if (table.contains("points") == table.contains("step"))
    throw InputError(at, "needs either points or step", "write { from = 1, to = 9, points = 5 }");
  if (log && (!(from > 0) || !(to > 0) || table.contains("step")))
    throw InputError(at, "log = true needs positive ends and points",
                     "write { from = 1, to = 8, points = 4, log = true }");
  std::size_t count = 0;
  if (table.contains("points")) {
    const double points = number("points");
    if (points < 1 || points > most_points || points != std::floor(points))
      throw InputError(at, "points must be a whole number from 1", "write { from = 1, to = 9, points = 5 }");
    count = static_cast<std::size_t>(points);
  } else {
    const double steps = (to - from) / number("step");
    if (!(steps >= 0) || steps > most_points)
      throw InputError(at, "step does not lead from one end to the other", "give it the sign of to - from");
    count = static_cast<std::size_t>(std::floor(steps + 1e-9)) + 1;
  }
  std::vector<std::string> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.0;
    double value = log ? from * std::pow(to / from, part) : from + (to - from) * part;
    if (table.contains("step")) value = from + static_cast<double>(k) * number("step");
    value = std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);  // 0.3, not 0.30000000000000004
    values.push_back(fmt::format("{}", value));
  }
  return values;
}

// Leaves of the table: lists and ranges.
void collect_axes(const toml::table& table, const std::string& above, const std::string& file,
                  std::vector<SweepAxis>& axes) {
  for (const auto& [name, node] : table) {
    const std::string key = above + std::string(name.str());
    SweepAxis axis{key, {}, static_cast<int>(name.source().begin.line)};
    const InputError::Place at{file, axis.line, printable(key)};
    // Names of points, which are names of directories, are made of it.
    if (toml_key(std::string(name.str())) != name.str())
      throw InputError(at, "is no key of a scene", "write it as it stands in the scene, without quotes");
    if (const toml::array* list = node.as_array()) {
      if (list->empty()) throw InputError(at, "is an empty list", "write the values that it takes: [1, 2, 3]");
      for (const toml::node& value : *list) axis.values.push_back(as_toml(value));
    } else if (const toml::table* inner = node.as_table()) {
      if (!is_range(*inner)) {
        collect_axes(*inner, key + ".", file, axes);
        continue;
      }
      axis.values = values_of_range(*inner, key, file);
    } else {
      throw InputError(at, "is one value", "write a list, [1, 2, 3], or { from = 1, to = 9, points = 5 }");
    }
    axes.push_back(std::move(axis));
  }
}

std::vector<SweepAxis> axes_in(const toml::table* table, const std::string& file) {
  std::vector<SweepAxis> axes;
  if (table) collect_axes(*table, "", file, axes);
  std::stable_sort(axes.begin(), axes.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
  return axes;
}

void check_zip(const Sweep& s) {
  for (const auto* axes : {&s.axes, &s.branch_axes})
    for (const SweepAxis& axis : *axes) {
      const std::set<std::string> different(axis.values.begin(), axis.values.end());
      if ((!s.zip || axes == &s.branch_axes) && different.size() < axis.values.size())
        throw InputError({s.path, axis.line, printable(axis.key)}, "has a value twice",
                         "take one of the two away, or write combine = \"zip\" if points are lists of values");
    }
  for (const SweepAxis& axis : s.axes)
    if (s.zip && axis.values.size() != s.axes.front().values.size())
      throw InputError({s.path, axis.line, axis.key},
                       fmt::format("has {} values, and {} has {}", axis.values.size(), s.axes.front().key,
                                   s.axes.front().values.size()),
                       "combine = \"zip\" needs as many of each; or take combine = \"grid\"");
}

// --- Points ---

// Each way to take one value of every axis; the last axis varies fastest.
std::vector<std::vector<std::size_t>> combinations(const std::vector<SweepAxis>& axes, bool zip) {
  std::vector<std::vector<std::size_t>> all = {{}};
  if (zip && !axes.empty()) {
    all.clear();
    for (std::size_t k = 0; k < axes.front().values.size(); ++k) all.emplace_back(axes.size(), k);
    return all;
  }
  for (const SweepAxis& axis : axes) {
    std::vector<std::vector<std::size_t>> more;
    for (const auto& begun : all)
      for (std::size_t k = 0; k < axis.values.size(); ++k) {
        more.push_back(begun);
        more.back().push_back(k);
      }
    all = std::move(more);
  }
  return all;
}

std::string in_a_name(const std::string& value, std::size_t number) {
  std::string text = value;
  if (text.size() > 1 && text.front() == text.back() && (text.front() == '"' || text.front() == '\''))
    text = text.substr(1, text.size() - 2);
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '+' || c == '-';
  });
  return plain && !text.empty() && text.size() <= longest_value ? text : fmt::format("no{}", number);
}

// The last part of the key, or all of it where another axis ends alike.
std::string short_name(const std::string& key, const std::vector<std::string>& keys) {
  const auto same =
      std::count_if(keys.begin(), keys.end(), [&](const auto& k) { return leaf_of(k) == leaf_of(key); });
  return same > 1 ? key : leaf_of(key);
}

// The seed is varied last, once all else is set.
std::vector<std::vector<std::size_t>> combinations_of(const Sweep& s) {
  std::vector<SweepAxis> axes = s.axes;
  std::vector<SweepAxis> seed;
  if (s.replicates > 0) {
    seed = {axes.back()};
    axes.pop_back();
  }
  std::vector<std::vector<std::size_t>> all;
  for (const auto& first : combinations(axes, s.zip))
    for (const auto& last : combinations(seed, false)) {
      all.push_back(first);
      all.back().insert(all.back().end(), last.begin(), last.end());
    }
  return all;
}

struct Setting {
  const SweepAxis* axis;
  std::size_t number;
};

constexpr const char *length_key = "element_length_nm", *seed_key = "start.seed";

bool has_random_drive(const Scene& scene) {
  return std::any_of(scene.drives.begin(), scene.drives.end(), [](const auto& d) { return d->is_random(); });
}

// Resizes the tubes of a point for another element length, so that their free length stays as near as whole
// elements go. `before`: the scene with its old element length. The text stays as it is for a wrong scene, which
// the check of the point refuses, and for a sweep that gives a size of the tubes with each element length.
void keep_free_length(const Sweep& s, const std::string& before, double length, std::string& text) {
  try {
    const Scene scene = scene_of_text(before, s.scene_path);
    const SceneKey size = tube_size_key(scene);
    const std::string key = size.table + "." + size.key;
    const auto same = [&](const SweepAxis& axis) { return axis.key == key; };
    if (size.tube_size == SceneKey::TubeSize::no || scene.has_ends(Drive::Ends::endless) ||
        !(length > 1e-3 * scene.element_length) || (s.zip && std::any_of(s.axes.begin(), s.axes.end(), same)))
      return;
    const int held = elements_held(scene, 0), free = scene.source->sizes(scene.element_length).elements - held;
    const std::int64_t elements =
        std::max<std::int64_t>(1, std::llround(free * scene.element_length / length)) + held;
    text = with_value(text, key,
                      size.tube_size == SceneKey::TubeSize::elements
                          ? std::to_string(elements)
                          : fmt::format("{:.10g}", static_cast<double>(elements) * length),
                      s.scene_path);
  } catch (const InputError&) {
  }
}

SweepPoint named_point(const std::vector<std::string>& keys, const std::vector<Setting>& settings) {
  SweepPoint p;
  for (const Setting& setting : settings) {
    const std::string& value = setting.axis->values[setting.number];
    p.values.push_back(value);
    if (setting.axis->values.size() == 1) continue;  // the same for all
    p.name += (p.name.empty() ? "" : "_") + short_name(setting.axis->key, keys) + "-" +
              in_a_name(value, setting.number + 1);
  }
  if (p.name.empty()) p.name = "all";
  if (p.name.size() > longest_name) {
    const std::string hash = "-" + hash_hex(p.name);
    p.name = p.name.substr(0, longest_name - hash.size()) + hash;
  }
  return p;
}

// Motion that is random is so by other numbers at other points. Those that leave a shared start, and a point with
// another seed, have the stream of the start and of the point.
void set_stream(const Sweep& s, const std::vector<const SweepAxis*>& axes, SweepPoint& p) {
  if (s.common_noise) return;
  std::string of;
  for (std::size_t k = 0; k < std::min(axes.size(), s.axes.size()); ++k)
    if (axes[k]->key != seed_key && axes[k]->values.size() > 1) of += axes[k]->key + " = " + p.values[k] + "\n";
  if (of.empty()) return;
  try {
    const Scene scene = scene_of_text(p.text, s.scene_path);
    if (scene.start.stream != 0 || !(scene.start.temperature > 0 || has_random_drive(scene))) return;
  } catch (const InputError&) {
    return;  // the check of the point refuses it
  }
  p.text = with_value(p.text, "start.stream", std::to_string(std::stoul(hash_hex(of).substr(0, 8), nullptr, 16)),
                      s.scene_path);
}

// The scene of a point, by its values. That of a start has those of the first axes alone.
void write_scene(const Sweep& s, SweepPoint& p) {
  std::vector<const SweepAxis*> axes;
  for (const auto* list : {&s.axes, &s.branch_axes})
    for (const SweepAxis& axis : *list)
      if (axes.size() < p.values.size()) axes.push_back(&axis);
  p.text = s.scene_text;
  const auto set = [&](std::size_t k) {
    try {
      p.text = with_value(p.text, axes[k]->key, p.values[k], s.scene_path);
    } catch (const TomlError& e) {
      throw InputError({s.path, axes[k]->line, axes[k]->key},
                       fmt::format("cannot be set in {}: {}", s.scene_path, e.description),
                       "write the key as it would stand in the scene");
    }
  };
  for (std::size_t k = 0; k < axes.size(); ++k)
    if (axes[k]->key != length_key) set(k);
  const std::string before = p.text;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    if (axes[k]->key != length_key) continue;
    set(k);
    keep_free_length(s, before, leading_number(p.values[k]).value_or(0), p.text);
  }
  set_stream(s, axes, p);
}

// A wrong scene: named by the point, since it is in no file yet.
void check_scene(const Sweep& s, SweepPoint& p, bool build) {
  try {
    Scene scene = scene_of(s, p);
    if (build) refuse_cooling(scene, prepare(scene));
    p.sets.clear();
    for (const ParameterSet& set : scene.sets) p.sets.push_back(set.path);
    p.files = scene.files_of_drives();
    p.state = scene.source->file();
    const bool relaxes = scene.run.mode == RunOptions::Mode::relax;
    const double duration = scene.run.duration > 0 ? scene.run.duration : protocol_time(scene);
    const Source::Sizes sizes = scene.source->sizes(scene.element_length);
    p.work = std::max(1.0, static_cast<double>(sizes.tubes) * sizes.elements) * (relaxes ? relax_ps : duration);
  } catch (const InputError& e) {
    throw InputError({s.path, 0, ""}, fmt::format("point {}: {}", p.name, e.what()), "");
  }
}

std::vector<Setting> settings_of(const std::vector<SweepAxis>& axes, const std::vector<std::size_t>& numbers) {
  std::vector<Setting> out;
  for (std::size_t k = 0; k < axes.size(); ++k) out.push_back({&axes[k], numbers[k]});
  return out;
}

ThresholdQuestion read_threshold(const TomlTable& t) {
  ThresholdQuestion q;
  q.key = t.string("key");
  q.from = t.number("from", Bounds::any());
  q.to = t.number("to", Bounds::any());
  if (!(q.to > q.from)) throw t.error("to", "is not above from", "give the range in which the value lies");
  if (t.has("shape")) {
    for (const char* other : {"column", "above"})
      if (t.has(other))
        throw t.error(other, "stands beside shape, and both are the question", "take one of them away");
    Words<RopeShape> words;
    for (const RopeShape shape : rope_shapes) words.emplace_back(name_of(shape), shape);
    q.shape = t.word("shape", words);
  } else {
    q.column = t.string_or("column", q.column);
    q.above = t.number("above", Bounds::any());
  }
  q.accuracy = t.number_or("accuracy", q.accuracy, Bounds::range(1e-4, 0.5));
  return q;
}

}  // namespace

std::vector<std::string> Sweep::keys() const {
  std::vector<std::string> all;
  for (const SweepAxis& axis : axes) all.push_back(axis.key);
  for (const SweepAxis& axis : branch_axes) all.push_back(axis.key);
  return all;
}

bool Sweep::varies(const std::string& key) const {
  for (const auto* list : {&axes, &branch_axes})
    for (const SweepAxis& axis : *list)
      if (axis.key == key && axis.values.size() > 1) return true;
  return false;
}

Sweep sweep_of_text(const std::string& text, const std::string& path, const std::string& other_scene) {
  const TomlTable top = TomlTable::parse(text, path);
  if (!top.has("format")) throw top.error("format", "is missing", fmt::format("add format = \"{}\"", format_name));
  if (top.string("format") != format_name)
    throw top.error("format", "is not that of a sweep", fmt::format("this program reads \"{}\"", format_name));
  Sweep s;
  s.path = path;
  s.text = text;
  const std::filesystem::path scene = top.string("scene");
  s.scene_path = other_scene.empty() ? (std::filesystem::path(path).parent_path() / scene).string() : other_scene;
  if (!std::filesystem::exists(s.scene_path))
    throw top.error("scene", fmt::format("\"{}\" does not exist", s.scene_path),
                    "it is looked for beside the sweep");
  s.scene_text = read_file(s.scene_path);
  s.zip = top.word_or<bool>("combine", false, {{"grid", false}, {"zip", true}});
  s.replicates = static_cast<int>(top.integer_or("replicates", 0, 1, 100000));
  s.common_noise = top.boolean_or("common_noise", false);
  top.has("vary");  // read below: its keys are those of a scene
  const TomlTable branch = top.table("branch");
  if (top.has("branch")) s.branch_at = branch.number("at_ps", Bounds::positive());
  branch.has("vary");
  if (top.has("threshold")) {
    const TomlTable threshold = top.table("threshold");
    s.threshold = read_threshold(threshold);
    column_of_log(s.threshold->column, {s.path, threshold.line("column"), "threshold.column"});
  }
  top.finish();
  const toml::table file = parsed_toml(text, path);
  s.axes = axes_in(file["vary"].as_table(), path);
  s.branch_axes = axes_in(file["branch"]["vary"].as_table(), path);
  if (top.has("branch") && s.branch_axes.empty())
    throw top.error("branch", "varies nothing", "add [branch.vary] with the keys that change at at_ps");
  check_zip(s);
  if (s.replicates > 0) {
    SweepAxis seed{seed_key, {}, top.line("replicates")};
    for (int k = 1; k <= s.replicates; ++k) seed.values.push_back(fmt::format("{}", k));
    s.axes.push_back(seed);
  }
  const std::vector<std::string> keys = s.keys();
  if (keys.empty() && !s.threshold)
    throw top.error("vary", "is missing or empty", "add [vary] with keys of the scene: rope.tubes = [7, 19]");
  for (const std::string& key : keys)
    if (std::count(keys.begin(), keys.end(), key) > 1)
      throw top.error("vary", fmt::format("\"{}\" is varied twice", key), "take one of the two away");
  double points = 1;
  for (const SweepAxis& axis : s.axes) points *= s.zip ? 1 : static_cast<double>(axis.values.size());
  for (const SweepAxis& axis : s.branch_axes) points *= static_cast<double>(axis.values.size());
  if (points > most_points)
    throw top.error("vary", fmt::format("makes {:.0f} points", points), fmt::format("at most {} go", most_points));
  return s;
}

Sweep read_sweep(const std::string& path) { return sweep_of_text(read_file(path), path); }

void complete(const Sweep& s, SweepPoint& p, PointsAs as) {
  if (as == PointsAs::names) return;
  write_scene(s, p);
  if (as != PointsAs::scenes) check_scene(s, p, as == PointsAs::built);
}

std::vector<SweepPoint> points_of(const Sweep& s, PointsAs as) {
  std::vector<SweepPoint> points;
  std::set<std::string> names;
  const std::vector<std::string> keys = s.keys();
  const auto later = combinations(s.branch_axes, false);
  for (const auto& numbers : combinations_of(s)) {
    const std::vector<Setting> shared = settings_of(s.axes, numbers);
    for (const auto& branch : later) {
      std::vector<Setting> all = shared;
      for (const Setting& setting : settings_of(s.branch_axes, branch)) all.push_back(setting);
      SweepPoint& p = points.emplace_back(named_point(keys, all));
      if (!s.branch_axes.empty()) p.start = named_point(keys, shared).name;
      if (!names.insert(p.name).second)
        throw InputError({s.path, 0, "vary"}, fmt::format("two points would be named {}", p.name),
                         s.zip ? "each point must differ from the others in a value"
                               : "write values that differ in more than their signs");
      complete(s, p, as);
    }
  }
  return points;
}

std::vector<SweepPoint> starts_of(const Sweep& s, const std::vector<SweepPoint>& points) {
  std::vector<SweepPoint> starts;
  std::set<std::string> names;
  for (const SweepPoint& p : points) {
    if (p.start.empty() || !names.insert(p.start).second) continue;
    SweepPoint& start = starts.emplace_back();
    start.name = p.start;
    start.values = p.values;
    start.values.resize(s.axes.size());
    complete(s, start);
  }
  return starts;
}

bool seeds_differ(Scene& one, Scene& other) {
  const bool bath = one.bath() && one.bath()->temperature.largest() > 0;
  if (bath && (one.bath()->seed != other.bath()->seed || one.start.stream != other.start.stream)) return true;
  // The strengths of tubes scatter by the seed of the scene, and so do the places of links.
  const toml::table top = parsed_toml(one.text, one.path);
  if (const toml::array* links = top["links"].as_array())
    for (const toml::node& node : *links)
      if (const toml::table& t = *node.as_table();
          !t.contains("seed") && (t.contains("per_nm") || t.contains("forming_per_nm_ps")))
        return true;
  if (top["failure"]["strain_deviation"].value_or(0.0) > 0 && !top["failure"]["seed"]) return true;
  const State a = prepare(one).state, b = prepare(other).state;
  for (const auto of : {&State::position, &State::velocity})
    if ((a.*of).x != (b.*of).x || (a.*of).y != (b.*of).y || (a.*of).z != (b.*of).z) return true;
  return false;
}

std::string why_replicates_are_equal(const Sweep& sweep, const std::vector<SweepPoint>& points) {
  if (sweep.replicates < 2) return "";
  for (const Replicates& r : replicates_of(sweep, points)) {
    if (r.points.size() < 2) continue;
    Scene one = scene_of(sweep, r.points[0]), other = scene_of(sweep, r.points[1]);
    if (seeds_differ(one, other)) return "";
    const bool bath = one.bath() && one.bath()->temperature.largest() > 0;
    return bath ? "replicates vary start.seed, and all have the noise of the thermostat.seed that is typed: take "
                  "that key away"
                : "replicates are one and the same run, since nothing in the scene is random: add "
                  "rope.perturbation_nm "
                  "or a temperature, or take replicates away";
  }
  return "";
}

std::vector<Replicates> replicates_of(const Sweep& sweep, const std::vector<SweepPoint>& points) {
  std::vector<Replicates> out;
  std::map<std::vector<std::string>, std::size_t> at;
  const std::vector<std::string> keys = sweep.keys();
  for (const SweepPoint& p : points) {
    Replicates r;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      if (keys[k] == "start.seed") continue;
      r.values.push_back(p.values[k]);
      if (sweep.varies(keys[k]))
        r.name += fmt::format("{}{} = {}", r.name.empty() ? "" : ", ", leaf_of(keys[k]), p.values[k]);
    }
    const auto [entry, added] = at.emplace(r.values, out.size());
    if (added) out.push_back(std::move(r));
    out[entry->second].points.push_back(p);
  }
  // If only the seed varies, the single group is named by its number of seeds.
  for (Replicates& r : out)
    if (r.name.empty())
      r.name = r.points.size() == 1 ? r.points.front().name : fmt::format("{} seeds", r.points.size());
  return out;
}

std::string leaf_of(const std::string& key) { return key.substr(key.rfind('.') + 1); }

Scene scene_of(const Sweep& sweep, const SweepPoint& point) {
  Scene scene = scene_of_text(point.text, sweep.scene_path);
  scene.name += ", " + point.name;
  return scene;
}

}  // namespace ropewalk
