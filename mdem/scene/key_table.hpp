// A table of a scene file: its keys with unit, default and meaning, and how each is read into a struct. Help,
// templates, reader and refinement all go by this one list.
//
//   struct Spring { double stiffness = 0; };
//   const KeyTable<Spring> table = {"spring", "a spring at the upper end",
//       {KeyOf<Spring>::number("stiffness_nN_per_nm", {"nN/nm", units::nN_nm}, Bounds::positive(1e4),
//                              &Spring::stiffness, required("0.1"), "pull per distance")}, {}};
//   const Spring spring = table.read(top.table("spring"), scene);
//
// Readers throw InputError with file, line and key.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/toml_table.hpp"
#include "model/units.hpp"
#include "scene/scene_key.hpp"

namespace ropewalk {

struct Scene;

struct Unit {
  const char* name;
  double size;  // size in internal units (nm, ps, eV, rad)
};

namespace unit {
inline constexpr Unit none{"", 1}, nm{"nm", 1}, ps{"ps", 1}, seconds{"s", 1}, kelvin{"K", 1};
inline constexpr Unit fs{"fs", units::fs}, degree{"deg", units::degree};
inline constexpr Unit nN{"nN", units::nN_nm}, nN_nm{"nN nm", units::nN_nm};
}  // namespace unit

// The value of a key that is missing.
struct Presence {
  std::string value;     // as TOML; empty: that of the struct
  std::string standard;  // default in words; empty: `value`
};
// An error. `example` is for the templates.
inline Presence required(std::string example) { return {std::move(example), "required"}; }
// The member stays as the struct has it, which `words` describe.
inline Presence otherwise(std::string example, std::string words) { return {std::move(example), std::move(words)}; }
// The value of the struct; `value` is to be given where no rule makes TOML of it.
inline Presence standard(std::string value = "") { return {std::move(value), ""}; }

std::string as_toml(double value);  // to six digits

template <class T>
struct KeyOf {
  using Read = std::function<void(const TomlTable&, const Scene&, T&)>;
  using BoundsInScene = std::function<Bounds(const Scene&)>;

  SceneKey doc;
  Read read;
  std::function<std::string(const T&)> show;  // the default as TOML

  // Members are pointers to them, or functions that take the struct and return a reference.
  template <class M>
  static KeyOf number(const std::string& key, Unit u, const Bounds& bounds, M member, const Presence& p,
                      const std::string& meaning) {
    KeyOf k = number(
        key, u, [bounds](const Scene&) { return bounds; }, member, p, meaning);
    k.doc.most = bounds.most;
    return k;
  }
  // The bounds may depend on what was read before.
  template <class M>
  static KeyOf number(const std::string& key, Unit u, BoundsInScene bounds, M member, const Presence& p,
                      const std::string& meaning) {
    KeyOf k = made(key, u.name, p, meaning);
    k.doc.number = true;
    k.read = [=, needed = k.doc.required()](const TomlTable& t, const Scene& scene, T& out) {
      if (needed || t.has(key)) std::invoke(member, out) = t.number(key, bounds(scene)) * u.size;
    };
    k.show = [=](const T& out) { return as_toml(std::invoke(member, out) / u.size); };
    return k;
  }
  template <class M>
  static KeyOf integer(const std::string& key, long least, long most, M member, const Presence& p,
                       const std::string& meaning) {
    KeyOf k = made(key, "", p, meaning);
    k.doc.whole = true;
    k.doc.most = static_cast<double>(most);
    k.read = [=, needed = k.doc.required()](const TomlTable& t, const Scene&, T& out) {
      using Integer = std::decay_t<decltype(std::invoke(member, out))>;
      if (needed || t.has(key)) std::invoke(member, out) = static_cast<Integer>(t.integer(key, least, most));
    };
    k.show = [=](const T& out) { return std::to_string(std::invoke(member, out)); };
    return k;
  }
  template <class M>
  static KeyOf boolean(const std::string& key, M member, const Presence& p, const std::string& meaning) {
    KeyOf k = made(key, "", p, meaning);
    k.read = [=, needed = k.doc.required()](const TomlTable& t, const Scene&, T& out) {
      if (needed || t.has(key)) std::invoke(member, out) = t.boolean(key);
    };
    k.show = [=](const T& out) { return std::invoke(member, out) ? "true" : "false"; };
    return k;
  }
  template <class E, class M>
  static KeyOf word(const std::string& key, const Words<E>& words, M member, const Presence& p,
                    const std::string& meaning) {
    KeyOf k = made(key, "", p, meaning);
    k.read = [=, needed = k.doc.required()](const TomlTable& t, const Scene&, T& out) {
      if (needed || t.has(key)) std::invoke(member, out) = t.word(key, words);
    };
    k.show = [=](const T& out) {
      for (const auto& w : words)
        if (std::invoke(member, out) == w.second) return "\"" + std::string(w.first) + "\"";
      return std::string();
    };
    return k;
  }
  // `read` must ask for the key in any case, so that it counts as known.
  static KeyOf custom(const std::string& key, const std::string& unit_name, const Presence& p,
                      const std::string& meaning, Read read) {
    KeyOf k = made(key, unit_name, p, meaning);
    k.read = std::move(read);
    return k;
  }

  // For scenes with elements of another length, see SceneKey.
  KeyOf goes_as_length(int power) && {
    doc.length_power = power;
    return std::move(*this);
  }
  KeyOf that_numbers_elements() && {
    doc.numbers_elements = true;
    return std::move(*this);
  }
  KeyOf that_counts_held() && {
    doc.counts_held = true;
    return std::move(*this);
  }
  KeyOf of_pace(SceneKey::Pace pace) && {
    doc.pace = pace;
    return std::move(*this);
  }
  KeyOf is_tube_size(SceneKey::TubeSize size) && {
    doc.tube_size = size;
    return std::move(*this);
  }

 private:
  static KeyOf made(const std::string& key, const std::string& unit_name, const Presence& p,
                    const std::string& meaning) {
    KeyOf k;
    k.doc.key = key;
    k.doc.unit = unit_name;
    k.doc.value = p.value;
    k.doc.standard = p.standard;
    k.doc.meaning = meaning;
    return k;
  }
};

template <class T>
struct KeyTable {
  std::string name;  // empty: the top of the file
  std::string meaning;
  std::vector<KeyOf<T>> keys;
  std::function<void(const TomlTable&, const Scene&, T&)> check;  // of what was read, as a whole; may complete it
  T defaults = T();
  bool listed = false;  // [[name]], any number of them

  // In the order of the keys. `scene` holds what was read before this table.
  T read(const TomlTable& t, const Scene& scene) const {
    T out = defaults;
    for (const KeyOf<T>& k : keys) k.read(t, scene, out);
    if (check) check(t, scene, out);
    return out;
  }
  SceneTable doc() const {
    SceneTable out{name, meaning, {}, listed};
    for (const KeyOf<T>& k : keys) {
      out.keys.push_back(k.doc);
      out.keys.back().table = name;
      if (k.doc.value.empty()) out.keys.back().value = k.show(defaults);
    }
    return out;
  }
};

}  // namespace ropewalk
