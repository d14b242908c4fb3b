// [[friction]] dry friction of tubes that lie side by side; its law: sim/forces/terms/dry_friction.hpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "io/friction_toml.hpp"
#include "io/parameters_toml.hpp"
#include "model/error.hpp"
#include "model/units.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"
#include "sim/forces/terms/dry_friction.hpp"

namespace ropewalk {
namespace {

constexpr double pN = 1e-3 * units::nN_nm;  // eV/nm; a force per length in pN/nm is as many eV/nm^2

// A law, and the atoms that it was measured from.
struct FrictionLaw {
  DryFriction law;
  std::string words, file;
};

class FrictionDrive : public Drive {
 public:
  DryFriction typed{0, 0, 0, 0.06, 0, false, {}};
  std::string from;                  // "atoms", or a shipped pair; empty: typed
  std::vector<FrictionLaw> laws;     // for each pair of types where they come from atoms
  std::vector<std::string> strange;  // files that were passed over

  SceneTable table() const override;
  std::string words() const override {
    std::string text;
    for (const FrictionLaw& f : laws)
      text += fmt::format(
          "{}friction{}, {}: {:.4g} pN/nm along the axis, {:.4g} pN/nm against spin, {:.4g} pN at each end, "
          "elastic "
          "up to {:.4g} nm, drag {:.4g} eV ps/nm^3{}",
          text.empty() ? "" : "\n", words_of(f.law.types), f.law.corrugated ? "a corrugation" : "dry",
          f.law.axial / pN, f.law.spin / pN, f.law.end / pN, f.law.elastic_slip, f.law.drag, f.words);
    return text;
  }
  const std::vector<int>* types() const override { return &typed.types.named; }
  std::shared_ptr<const Drive> without(const std::vector<std::pair<int, int>>& pairs) const override {
    auto narrowed = std::make_shared<FrictionDrive>(*this);
    narrowed->laws.clear();
    for (FrictionLaw f : laws) {
      const std::vector<int>& named = f.law.types.named;
      if (!named.empty() && std::count(pairs.begin(), pairs.end(), std::pair(named[0], named[1]))) continue;
      if (named.empty()) f.law.types.without = pairs;
      narrowed->laws.push_back(std::move(f));
    }
    return narrowed;
  }
  std::vector<std::string> files() const override {
    std::vector<std::string> all;
    for (const FrictionLaw& f : laws)
      if (!f.file.empty()) all.push_back(f.file);
    return all;
  }
  // The other sections say what these numbers follow from.
  bool depends_on(const std::string& key) const override { return key.rfind("friction.", 0) == 0; }
  void refuse(const TomlTable& top, const Scene& scene) const override {
    if (scene.contact.law == "none")
      throw top.error("friction", "acts between tubes in contact, and contact.law is \"none\"",
                      "take one of the two away");
  }
  void warn(const Scene&, const Topology&, const LoadsAndConstraints&,
            std::vector<std::string>& warnings) const override {
    for (const std::string& path : strange)
      warnings.push_back(
          fmt::format("{} has no line format = \"{}\" and was not read as friction of tubes. If it is meant to be, "
                      "restore that line; "
                      "else give it a name that does not begin with friction-.",
                      printable(path, 200), friction_format));
  }
  void add_terms(const Scene&, const Topology& topology, const State&, Interaction& interaction) const override {
    for (const FrictionLaw& f : laws) add_term(dry_friction_term(f.law, topology), interaction);
  }
};

void read_types(const TomlTable& t, const Scene& scene, FrictionDrive& friction) {
  friction.typed.types.named = pair_of_types(t, scene);
}

void read_from(const TomlTable& t, const Scene&, FrictionDrive& friction) {
  if (!t.has("from")) return;
  friction.from = t.string("from");
  for (const char* key : {"strength_pN_per_nm", "spin_strength_pN_per_nm", "end_strength_pN", "elastic_slip_nm",
                          "drag_eV_ps_per_nm3"})
    if (t.has(key)) throw t.error(key, "is typed where friction.from has it", "take one of the two away");
  // Relaxed atoms that are led past each other lose nothing.
  if (!t.has("slip")) friction.typed.corrugated = true;
}

FrictionLaw law_of(const PairFriction& f, const DryFriction& typed, std::vector<int> types,
                   const std::string& estimate) {
  return {{f.strength,
           f.spin_strength,
           f.end_strength,
           f.elastic_slip,
           f.drag,
           typed.corrugated,
           {std::move(types), {}}},
          fmt::format(", of atoms ({}, {}{})", f.name, grade_of(f).words(), estimate),
          f.path};
}

// Friction by the atoms of all pairs of tube types, or of the pair that is given.
std::vector<FrictionLaw> laws_of_atoms(const Scene& scene, const DryFriction& typed,
                                       const std::vector<std::string>& folders, const InputError::Place& place) {
  std::vector<FrictionLaw> laws;
  const auto n = static_cast<int>(scene.sets.size());
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      const std::vector<int>& types = typed.types.named;
      if (!types.empty() && (i != std::min(types[0], types[1]) || j != std::max(types[0], types[1]))) continue;
      const ParameterSet& of_a = scene.sets[static_cast<std::size_t>(i)];
      const ParameterSet& of_b = scene.sets[static_cast<std::size_t>(j)];
      for (const ParameterSet* set : {&of_a, &of_b}) {
        refuse_filament(*set, "no friction follows from it",
                        "give strength_pN_per_nm in [[friction]] in place of from");
        refuse_other_than_carbon(*set, "friction from atoms is that of carbon alone: give strength_pN_per_nm");
      }
      const Chirality a = of_a.chirality, b = of_b.chirality;
      const PairFriction f = friction_between(a, b, folders, place);
      const std::string estimate =
          f.is_of(a, b) ? ""
                        : fmt::format(", an estimate: ({},{}) beside ({},{}) was not measured", a.n, a.m, b.n, b.m);
      laws.push_back(law_of(f, typed, {i, j}, estimate));
    }
  return laws;
}

void check(const TomlTable& t, const Scene& scene, FrictionDrive& friction) {
  DryFriction& law = friction.typed;
  const InputError::Place place = {scene.path, t.line("from"), "friction.from"};
  // Beside the scene and beside its sets.
  std::vector<std::string> folders = {std::filesystem::path(scene.path).parent_path().string()};
  for (const ParameterSet& set : scene.sets)
    folders.push_back(std::filesystem::path(set.path).parent_path().string());
  if (friction.from == "atoms") {
    friction.strange = strange_friction_files(folders);
    friction.laws = laws_of_atoms(scene, law, folders, place);
  } else if (!friction.from.empty()) {
    friction.laws = {law_of(find_friction(friction.from, folders, place), law, law.types.named, "")};
  } else {
    if (!(law.axial > 0 || law.spin > 0 || law.end > 0 || law.drag > 0))
      throw t.error("strength_pN_per_nm", "and all other strengths are zero",
                    "give one of them, write from = \"atoms\", or take the table away");
    friction.laws = {{law, "", ""}};
  }
}

const KeyTable<FrictionDrive>& friction_table() {
  using Key = KeyOf<FrictionDrive>;

  const Unit per_length{"pN/nm", pN};
  static const KeyTable<FrictionDrive> table = {
      "friction",
      "any number of these: dry friction of tubes side by side; slips are elastic up to a strength, then tubes "
      "slide",
      {Key::custom("from", "", otherwise("\"atoms\"", "typed below"),
                   "where measured strengths come from: \"atoms\" for all pairs of tubes, or the name of a shipped "
                   "pair, or a file",
                   read_from),
       Key::number(
           "strength_pN_per_nm", per_length, Bounds::non_negative(1e5),
           [](auto& d) -> auto& { return d.typed.axial; }, standard(),
           "force per length of contact, along the tubes"),
       Key::number(
           "spin_strength_pN_per_nm", per_length, Bounds::non_negative(1e5),
           [](auto& d) -> auto& { return d.typed.spin; }, standard(),
           "force per length of contact on the surface of a tube that spins; times its radius: the torque per "
           "length"),
       Key::number(
           "end_strength_pN", {"pN", pN}, Bounds::non_negative(1e6), [](auto& d) -> auto& { return d.typed.end; },
           standard(), "force along the tubes, for each end of a tube that lies beside another tube"),
       Key::number(
           "elastic_slip_nm", unit::nm, Bounds::range(1e-3, 1),
           [](auto& d) -> auto& { return d.typed.elastic_slip; }, standard(),
           "slip at which the strength is reached"),
       Key::number(
           "drag_eV_ps_per_nm3", {"eV ps/nm^3", 1}, Bounds::non_negative(1e4),
           [](auto& d) -> auto& { return d.typed.drag; }, standard(),
           "force per length of contact and speed of sliding"),
       Key::word(
           "slip", Words<bool>{{"dry", false}, {"corrugation", true}},
           [](auto& d) -> auto& { return d.typed.corrugated; },
           otherwise("\"dry\"", "\"corrugation\" for strengths of atoms"),
           "\"dry\": beyond its strength a contact slides and loses the work; \"corrugation\": its force is "
           "periodic and loses nothing"),
       Key::custom("types", "", otherwise("[0, 1]", "all tubes"),
                   "the two tube types between which it acts, from 0; no other table then acts between these two",
                   read_types)},
      check};
  return table;
}

SceneTable friction_keys() {
  SceneTable table = friction_table().doc();
  table.listed = true;
  return table;
}

SceneTable FrictionDrive::table() const { return friction_keys(); }

}  // namespace

DriveKind friction_drive() {
  return {friction_keys,
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            return std::make_shared<const FrictionDrive>(friction_table().read(t, scene));
          },
          "elastic energy of friction",
          {{"friction_slip_eV", "eV", "energy lost to slip under the strength of friction since the start",
            &TermAccount::lost},
           {"friction_drag_eV", "eV", "energy lost to the drag of friction since the start", &TermAccount::drag},
           {"friction_slips", "", "slips since the start: contacts of two elements that began to slide",
            &TermAccount::events}}};
}

}  // namespace ropewalk
