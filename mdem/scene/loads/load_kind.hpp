// [[load]] and the register of its kinds. A kind is one file: its class (sim/dynamics/loads.hpp), its keys and its
// entry here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/drive.hpp"
#include "scene/key_table.hpp"

namespace ropewalk {

struct LoadKind {
  std::string name;                                                                 // kind = "name"
  std::vector<SceneKey> keys;                                                       // keys of this kind alone
  std::function<std::shared_ptr<const Load>(const TomlTable&, const Scene&)> read;  // acting on no element yet
};

// The table's name is that of the kind.
template <class L>
LoadKind load_kind(const KeyTable<L>& table) {
  return {table.name, table.doc().keys, [table](const TomlTable& t, const Scene& scene) {
            return std::make_shared<const L>(table.read(t, scene));
          }};
}

// A required vector that is not zero. A load on all elements divides among them: an element of half the length
// takes half.
template <class L>
KeyOf<L> vector_key(const std::string& key, Unit u, Vector3 L::*member, const std::string& example,
                    const std::string& meaning) {
  constexpr double largest = 1e4;
  return KeyOf<L>::custom(key, u.name, required(example), meaning,
                          [=](const TomlTable& t, const Scene&, L& out) {
                            const std::vector<double> v = t.numbers(key, Bounds::range(-largest, largest), 3);
                            out.*member = Vector3(v[0], v[1], v[2]);
                            if (out.*member == Vector3::Zero()) throw t.error(key, "is zero", "take the load away");
                            out.*member *= u.size;
                          })
      .goes_as_length(1);
}

// The shipped kinds, and those that were added.
const std::vector<LoadKind>& load_kinds();
// For kinds from elsewhere; returns true, so that a static variable can do it. The name must be new.
bool add_load_kind(LoadKind kind);

// Elements that a load acts on: every combination of a tube and an element index; negative indices count
// from the end of the tube.
struct Selection {
  bool has_tube(int tube) const;

  bool all_tubes = true;
  std::vector<int> tubes;
  bool all_elements = false;
  bool opposite_ends = false;  // the first element of a tube has the opposite of the load of the last one
  std::vector<int> elements;
};

// One [[load]] of a scene, and what it acts on.
class LoadDrive : public Drive {
 public:
  Selection on;
  LoadKind kind;
  std::shared_ptr<const Load> load;

  SceneTable table() const override;  // with the keys of this kind alone
  std::string words() const override;
  std::string needs_time() const override { return load->needs_time(); }
  void add_loads(const Scene&, const Topology&, const Interaction&, LoadsAndConstraints&) const override;
  void refuse_start(const Scene&, const Topology&, const State&, const LoadsAndConstraints&) const override;
  std::string why_not_lengthened() const override;
  bool holds_elements() const override { return !on.all_elements; }
  int held(End end, int tube) const override;
};

// The key `tubes`.
void read_tube_selection(const TomlTable& t, const Scene& scene, Selection& on);

// Both throw InputError for what does not exist.
std::vector<int> selected_tubes(const Scene& scene, const Selection& on, const Topology& topology);
std::vector<int> selected_elements(const Scene& scene, const Selection& on, const Topology& topology);

}  // namespace ropewalk
