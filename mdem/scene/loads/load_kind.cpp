#include "scene/loads/load_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/end_moment.hpp"
#include "scene/own_parts.hpp"
#include "scene/scene.hpp"
#include "scene/scene_place.hpp"

namespace ropewalk {

// One line for each shipped kind, and one below.
LoadKind fix_kind();
LoadKind force_kind();
LoadKind torque_kind();
LoadKind rotate_kind();

namespace {

std::vector<LoadKind>& kinds_of_loads() {
  static std::vector<LoadKind> kinds = {
      fix_kind(),
      force_kind(),
      torque_kind(),
      rotate_kind(),
  };
  return kinds;
}

// "a", "b" or "c".
std::string kind_names() {
  std::string text;
  const std::size_t kinds = load_kinds().size();
  for (std::size_t k = 0; k < kinds; ++k)
    text += fmt::format("{}\"{}\"", k == 0 ? "" : k + 1 == kinds ? " or " : ", ", load_kinds()[k].name);
  return text;
}

const LoadKind& read_kind(const TomlTable& t) {
  Words<const LoadKind*> words;
  for (const LoadKind& k : load_kinds()) words.emplace_back(k.name.c_str(), &k);
  const LoadKind& kind = *t.word("kind", words);
  const auto has = [](const LoadKind& k, const std::string& key) {
    return std::any_of(k.keys.begin(), k.keys.end(), [&](const SceneKey& own) { return own.key == key; });
  };
  for (const std::string& key : t.keys())
    for (const LoadKind& other : load_kinds())
      if (has(other, key) && !has(kind, key))
        throw t.error(key, fmt::format("belongs to kind = \"{}\", and this load is \"{}\"", other.name, kind.name),
                      "take the key away, or write a [[load]] of its own");
  return kind;
}

void check_index(const TomlTable& t, const char* key, const char* what, long index, int count) {
  if (count == 0 || (index < count && index >= -count)) return;
  const std::string from_end =
      std::string(key) == "elements" ? fmt::format(", or -1 to -{} from the end", count) : "";
  throw t.error(key, fmt::format("there is no {} {}", what, index),
                fmt::format("they are 0 to {}{}", count - 1, from_end));
}

// Twice the same one would be loaded twice.
void check_unique(const TomlTable& t, const char* key, std::vector<long> indices, int count) {
  for (long& i : indices)
    if (i < 0 && count > 0) i += count;
  std::sort(indices.begin(), indices.end());
  const auto twice = std::adjacent_find(indices.begin(), indices.end());
  if (twice != indices.end()) throw t.error(key, fmt::format("names {} twice", *twice), "name each once");
}

// `count`: how many there are; 0: not known.
std::vector<int> read_indices(const TomlTable& t, const char* key, const char* what, long least, int count) {
  const std::vector<long> indices = t.integers(key, least, max_elements);
  for (const long i : indices) check_index(t, key, what, i, count);
  check_unique(t, key, indices, count);
  return {indices.begin(), indices.end()};
}

void read_elements(const TomlTable& t, const Scene& scene, Selection& on) {
  const Source::Sizes sizes = scene.source->sizes(scene.element_length);
  if (!t.is_string("elements")) {
    on.elements = read_indices(t, "elements", "element", -long{max_elements}, sizes.elements);
    return;
  }
  enum class Which { all, ends, opposite_ends };
  const Which which =
      t.word("elements",
             Words<Which>{{"all", Which::all}, {"ends", Which::ends}, {"opposite-ends", Which::opposite_ends}});
  on.all_elements = which == Which::all;
  on.opposite_ends = which == Which::opposite_ends;
  if (!on.all_elements) on.elements = {0, -1};
}

// The keys of all loads.
KeyTable<Selection> selection_table() {
  using Key = KeyOf<Selection>;
  return {
      "load",
      "any number of these: what else acts on elements",
      {Key::custom("kind", "", required("\"fix\""), kind_names(),
                   [](const TomlTable& t, const Scene&, Selection&) { read_kind(t); }),
       Key::custom("tubes", "", standard("\"all\""), "\"all\" or numbers from 0: [0, 3]", read_tube_selection),
       Key::custom(
           "elements", "", required("\"ends\""),
           "\"all\", \"ends\", \"opposite-ends\" (the first element has the opposite of the last one's load) or "
           "numbers from 0, negative from the end",
           read_elements)
           .that_numbers_elements()},
      {},
      Selection(),
      true};
}

}  // namespace

void read_tube_selection(const TomlTable& t, const Scene& scene, Selection& on) {
  on.all_tubes = !t.has("tubes") || (t.is_string("tubes") && t.word("tubes", Words<bool>{{"all", true}}));
  const Source::Sizes sizes = scene.source->sizes(scene.element_length);
  if (!on.all_tubes) on.tubes = read_indices(t, "tubes", "tube", 0, sizes.tubes);
}

bool Selection::has_tube(int tube) const {
  return all_tubes || std::find(tubes.begin(), tubes.end(), tube) != tubes.end();
}

namespace {

InputError::Place place_of(const Scene& scene, const Selection& on, const char* key) {
  int k = 0;
  for (const LoadDrive* load : scene.drives_of<LoadDrive>()) {
    if (&load->on == &on) return place_in(scene, std::string("load.") + key, k);
    ++k;
  }
  return place_in(scene, std::string("grip.") + key);
}

}  // namespace

std::vector<int> selected_tubes(const Scene& scene, const Selection& on, const Topology& topology) {
  std::vector<int> tubes;
  if (on.all_tubes) {
    for (int t = 0; t < topology.tubes(); ++t) tubes.push_back(t);
    return tubes;
  }
  for (int t : on.tubes) {
    if (t < 0 || t >= topology.tubes())
      throw InputError(place_of(scene, on, "tubes"), fmt::format("there is no tube {}", t),
                       fmt::format("tubes are numbered from 0 to {}", topology.tubes() - 1));
    tubes.push_back(t);
  }
  return tubes;
}

const std::vector<LoadKind>& load_kinds() { return kinds_of_loads(); }

bool add_load_kind(LoadKind kind) {
  return add_own_part(kinds_of_loads(), std::move(kind), "load", [](const LoadKind& k) { return k.name; });
}

namespace {

// The keys of all loads, then those of each kind.
SceneTable load_table() {
  SceneTable table = selection_table().doc();
  for (const LoadKind& kind : load_kinds())
    for (SceneKey key : kind.keys) {
      if (key.required()) key.standard = "required by " + kind.name;
      key.meaning = kind.name + ": " + key.meaning;
      key.table = table.name;
      table.keys.push_back(std::move(key));
    }
  return table;
}

}  // namespace

DriveKind load_drive() {
  return {load_table, [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            auto drive = std::make_shared<LoadDrive>();
            drive->on = selection_table().read(t, scene);
            drive->kind = read_kind(t);
            drive->load = drive->kind.read(t, scene);
            if (drive->on.opposite_ends && !drive->load->opposite())
              throw t.error("elements",
                            fmt::format("is \"opposite-ends\", and \"{}\" has no opposite", drive->kind.name),
                            "take \"ends\"");
            return drive;
          }};
}

SceneTable LoadDrive::table() const {
  SceneTable table = selection_table().doc();
  table.keys.insert(table.keys.end(), kind.keys.begin(), kind.keys.end());
  return table;
}

std::string LoadDrive::words() const {
  return fmt::format("load: {} on {} of {}", kind.name,
                     on.all_elements    ? "all elements"
                     : on.opposite_ends ? "opposite ends"
                                        : fmt::format("{} elements", on.elements.size()),
                     on.all_tubes ? "every tube" : fmt::format("each of {} tubes", on.tubes.size()));
}

void LoadDrive::add_loads(const Scene& scene, const Topology& topology, const Interaction&,
                          LoadsAndConstraints& loads) const {
  const auto add = [&](const std::shared_ptr<Load>& acting, const Selection& on_these) {
    acting->elements = selected_elements(scene, on_these, topology);
    loads.add(std::shared_ptr<const Load>(acting));
  };
  if (!on.opposite_ends) {
    add(load->copy(), on);
    return;
  }
  Selection one_end = on;
  one_end.elements = {-1};
  add(load->copy(), one_end);
  one_end.elements = {0};
  add(load->opposite(), one_end);
}

void LoadDrive::refuse_start(const Scene& scene, const Topology& topology, const State&,
                             const LoadsAndConstraints& loads) const {
  const auto effect = load->effect();
  if (effect && effect->axes[LoadEffect::about_z].is == LoadComponent::Is::loaded)
    refuse_end_moment(scene, topology, loads, "load.torque_nN_nm");
}

// A load that prescribes motion holds elements: the function counts the consecutive ones from this end of the tube
// on.
int LoadDrive::held(End end, int tube) const {
  if (on.all_elements || !on.has_tube(tube) || load->order() == Load::Order::force) return 0;
  const auto has = [&](int e) { return std::find(on.elements.begin(), on.elements.end(), e) != on.elements.end(); };
  int count = 0;
  while (has(end == lower_end ? count : -1 - count)) ++count;
  return count;
}

std::string LoadDrive::why_not_lengthened() const {
  const bool ends = std::all_of(on.elements.begin(), on.elements.end(), [](int e) { return e == 0 || e == -1; });
  return on.all_elements || ends ? "" : "a load names elements by number";
}

std::vector<int> selected_elements(const Scene& scene, const Selection& on, const Topology& topology) {
  std::vector<int> elements;
  for (int t : selected_tubes(scene, on, topology)) {
    const int length = topology.length_of(t);
    if (on.all_elements) {
      for (int e = 0; e < length; ++e) elements.push_back(topology.tube_begin[t] + e);
      continue;
    }
    for (int e : on.elements) {
      const int at = e < 0 ? length + e : e;
      if (at < 0 || at >= length)
        throw InputError(place_of(scene, on, "elements"), fmt::format("tube {} has no element {}", t, e),
                         fmt::format("its elements are 0 to {}, or -1 to -{} from the end", length - 1, length));
      elements.push_back(topology.tube_begin[t] + at);
    }
  }
  return elements;
}

}  // namespace ropewalk
