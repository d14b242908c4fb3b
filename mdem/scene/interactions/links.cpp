// [[links]] elastic links between the walls of tubes that touch, which form and break; their law:
// sim/forces/terms/links.hpp.
#include "sim/forces/terms/links.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "model/error.hpp"
#include "model/segments.hpp"
#include "model/units.hpp"
#include "scene/bounds.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/scene.hpp"

namespace ropewalk {
namespace {

class LinksDrive : public Drive {
 public:
  LinkLaw law;
  std::vector<int> between;  // tube, element, to tube, to element, ...
  InputError::Place place;
  int between_line = 0;

  SceneTable table() const override;
  std::string words() const override;
  void refuse(const TomlTable& top, const Scene& scene) const override {
    if (scene.has_ends(Ends::endless) && !between.empty())
      throw top.error("links", "names elements in between, and those of a [periodic] slice have images",
                      "place the links with per_nm or at_ends");
    if (scene.contact.law == "none")
      throw top.error("links", "join tubes in contact, and contact.law is \"none\"", "take one of the two away");
  }
  void add_terms(const Scene& scene, const Topology& topology, const State& state,
                 Interaction& interaction) const override {
    LinkLaw of_scene = law;
    of_scene.lineage = scene.lineage;
    const bool remembered = scene.memory.has("links");
    add_term(link_term(of_scene, remembered ? std::vector<LinkPlace>() : at_start(topology, state), topology),
             interaction);
  }
  void refuse_start(const Scene& scene, const Topology& topology, const State& state,
                    const LoadsAndConstraints&) const override {
    if (scene.memory.has("links") || law.forming > 0 || law.placed_at > 0 ||
        !(law.density > 0 || law.at_ends > 0 || !between.empty()))
      return;
    if (!at_start(topology, state).empty()) return;
    throw InputError(
        place,
        fmt::format(
            "none is placed: no two tubes that they join face each other within {:.3g} nm between their walls, or "
            "the number per length is so small that chance gave none",
            law.reach),
        "raise reach_nm or per_nm, or bring the tubes nearer");
  }
  bool is_random() const override { return law.forming > 0; }
  // A table with nothing but `between` acts on the elements that it names.
  const std::vector<int>* types() const override {
    const bool by_types = law.density > 0 || law.at_ends > 0 || law.forming > 0 || between.empty();
    return by_types ? &law.types.named : nullptr;
  }
  std::shared_ptr<const Drive> without(const std::vector<std::pair<int, int>>& pairs) const override {
    auto narrowed = std::make_shared<LinksDrive>(*this);
    narrowed->law.types.without = pairs;
    return narrowed;
  }
  std::string why_not_split() const override { return between.empty() ? "" : "links name elements by number"; }

 private:
  std::vector<LinkPlace> at_start(const Topology& topology, const State& state) const {
    if (law.placed_at > 0) return {};
    for (const auto& [a, b] : pairs(topology)) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      const TubeType &of_a = topology.type_of_element(a), &of_b = topology.type_of_element(b);
      const double apart =
          std::sqrt(squared_segment_distance(state.position[j] - state.position[i], axis_of(state.orientation[i]),
                                             axis_of(state.orientation[j]), 0.5 * of_a.element_length,
                                             0.5 * of_b.element_length)) -
          of_a.radius - of_b.radius;
      if (apart > law.reach)
        throw InputError(between_place(),
                         fmt::format("links elements {} and {} whose walls are {:.3g} nm apart", a, b, apart),
                         fmt::format("name elements that touch, or raise reach_nm above {:.3g}", law.reach));
    }
    return placed_links(law, topology, state, pairs(topology));
  }
  InputError::Place between_place() const { return {place.file, between_line, "links.between"}; }
  std::vector<std::pair<int, int>> pairs(const Topology& topology) const {
    std::vector<std::pair<int, int>> all;
    for (std::size_t k = 0; k + 3 < between.size(); k += 4) {
      const InputError::Place place = between_place();
      const int a = element_of_tube(topology, between[k], between[k + 1], place),
                b = element_of_tube(topology, between[k + 2], between[k + 3], place);
      if (between[k] == between[k + 2])
        throw InputError(place, fmt::format("links tube {} with itself", between[k]), "name elements of two tubes");
      all.emplace_back(a, b);
    }
    return all;
  }
};

std::string LinksDrive::words() const {
  std::vector<std::string> where;
  if (law.density > 0)
    where.push_back(fmt::format("{:.4g} per nm of contact at {}", law.density,
                                law.placed_at > 0 ? fmt::format("{:.4g} ps", law.placed_at) : "the start"));
  if (law.at_ends > 0) where.push_back(fmt::format("{} at each end of a tube", law.at_ends));
  if (!between.empty()) where.push_back(fmt::format("{} between named elements", between.size() / 4));
  if (law.forming > 0)
    where.push_back(
        fmt::format("{:.4g} form per nm of contact and ps, up to {:.4g} per nm of a tube", law.forming, law.most));
  std::vector<std::string> ends;
  if (law.strength > 0) ends.push_back(fmt::format("at {:.4g} nN", law.strength / units::nN_nm));
  if (law.toughness > 0) ends.push_back(fmt::format("at {:.4g} eV", law.toughness));
  return fmt::format("links{}: {}; {:.4g} nN/nm in stretch, {:.4g} nN/nm in shear, at rest {}; {}",
                     words_of(law.types), fmt::join(where, ", "), law.stretch / units::nN_nm,
                     law.shear / units::nN_nm,
                     law.rest < 0 ? "as they form" : fmt::format("with {:.4g} nm between the walls", law.rest),
                     ends.empty() ? "they do not break" : fmt::format("they break {}", fmt::join(ends, " or ")));
}

void read_links_between(const TomlTable& t, const Scene&, LinksDrive& links) {
  if (!t.has("between")) return;
  for (const long number : t.integers("between", -long{max_elements}, max_elements))
    links.between.push_back(static_cast<int>(number));
  if (links.between.empty() || links.between.size() % 4 != 0)
    throw t.error("between", fmt::format("has {} numbers, and a link takes four", links.between.size()),
                  "write [tube, element, other tube, its element], and so on");
}

void read_linked_types(const TomlTable& t, const Scene& scene, LinksDrive& links) {
  links.law.types.named = pair_of_types(t, scene);
}

void check_links(const TomlTable& t, const Scene& scene, LinksDrive& links) {
  LinkLaw& law = links.law;
  links.place = {scene.path, t.line(), "links"};
  links.between_line = t.line("between");
  // Each table has places of its own.
  const auto before = static_cast<std::uint64_t>(scene.drives_of<LinksDrive>().size());
  if (!t.has("seed")) law.seed = scene.start.seed + (before << 32);
  if (!t.has("shear_stiffness_nN_per_nm")) law.shear = law.stretch;
  // A typed 0 is the control of a sweep.
  if (!t.has("per_nm") && !(law.at_ends > 0 || law.forming > 0 || !links.between.empty()))
    throw t.error("per_nm", "is missing, and so is everything else that places links",
                  "give per_nm, at_ends, between or forming_per_nm_ps");
  if (law.rest > law.reach && t.has("rest_nm"))
    throw t.error("rest_nm", fmt::format("is {:.4g} nm, and links form within {:.4g} nm", law.rest, law.reach),
                  "take at most reach_nm: longer links would push the tubes apart");
  if (law.placed_at > 0 && !(law.density > 0 || law.at_ends > 0))
    throw t.error("placed_at_ps", "is for links that per_nm or at_ends place",
                  "give one of them, or take this away");
  if (law.placed_at > 0 && !links.between.empty())
    throw t.error("placed_at_ps", "stands beside between, whose links are there from the start",
                  "write two [[links]]");
  if (law.forming > 0 && !(law.most > 0))
    throw t.error("most_per_nm", "is missing beside forming_per_nm_ps",
                  "say how many links a tube can have per nm: the time step must bear them");
  if (law.most > 0 && law.forming == 0)
    throw t.error("most_per_nm", "belongs to forming_per_nm_ps", "give that too, or take this away");
}

const KeyTable<LinksDrive>& links_table() {
  using Key = KeyOf<LinksDrive>;
  const Unit spring{"nN/nm", units::nN_nm}, per_nm{"1/nm", 1};
  static const KeyTable<LinksDrive> table = {
      "links",
      "any number of these: elastic links between the walls of tubes that touch; they may form and break",
      {Key::number(
           "per_nm", per_nm, Bounds::non_negative(100), [](auto& d) -> auto& { return d.law.density; },
           otherwise("0.1", "0"), "links per length of contact of two tubes at the start, at random places"),
       Key::integer(
           "at_ends", 0, 100, [](auto& d) -> auto& { return d.law.at_ends; }, standard(),
           "number of links from each end of a tube to the tubes beside it"),
       Key::number(
           "placed_at_ps", unit::ps, Bounds::non_negative(longest_time),
           [](auto& d) -> auto& { return d.law.placed_at; }, standard(),
           "time at which the links of per_nm and at_ends are placed, as a rope is cured once it is spun")
           .of_pace(SceneKey::Pace::time),
       Key::custom("between", "", otherwise("[0, 5, 1, 5]", "none"),
                   "links that are there from the start, four numbers for each: tube, element, other tube, its "
                   "element; from 0, negative elements from the end",
                   read_links_between),
       Key::number(
           "stiffness_nN_per_nm", spring, Bounds::positive(1e5), [](auto& d) -> auto& { return d.law.stretch; },
           required("100"), "force per stretch of a link"),
       Key::number(
           "shear_stiffness_nN_per_nm", spring, Bounds::non_negative(1e5),
           [](auto& d) -> auto& { return d.law.shear; }, otherwise("100", "stiffness_nN_per_nm"),
           "force per shear of a link"),
       Key::number(
           "rest_nm", unit::nm, Bounds::non_negative(10), [](auto& d) -> auto& { return d.law.rest; },
           otherwise("0.34", "as they form"), "distance of the walls at which a link does not pull"),
       Key::number(
           "breaks_at_nN", unit::nN, Bounds::positive(1e6), [](auto& d) -> auto& { return d.law.strength; },
           otherwise("5", "never"), "force at which a link breaks for good"),
       Key::number(
           "breaks_at_eV", {"eV", 1}, Bounds::positive(1e6), [](auto& d) -> auto& { return d.law.toughness; },
           otherwise("3", "never"), "energy at which a link breaks for good"),
       Key::number(
           "reach_nm", unit::nm, Bounds::range(0.01, 5), [](auto& d) -> auto& { return d.law.reach; }, standard(),
           "distance of the walls within which links form"),
       Key::number(
           "forming_per_nm_ps", {"1/(nm ps)", 1}, Bounds::non_negative(100),
           [](auto& d) -> auto& { return d.law.forming; }, standard(),
           "links that form while the scene moves, per length of contact and time"),
       Key::number(
           "most_per_nm", per_nm, Bounds::positive(100), [](auto& d) -> auto& { return d.law.most; },
           otherwise("1", "required by forming_per_nm_ps"),
           "largest number of links of this table per length of tube; beyond it no more form"),
       Key::custom("types", "", otherwise("[0, 1]", "all tubes"),
                   "the two tube types that they join, from 0; no other table then acts between these two",
                   read_linked_types),
       Key::integer(
           "seed", 0, 1000000000, [](auto& d) -> auto& { return d.law.seed; }, otherwise("1", "start.seed"),
           "seed of the random places")},
      check_links};
  return table;
}

SceneTable links_keys() {
  SceneTable table = links_table().doc();
  table.listed = true;
  return table;
}

SceneTable LinksDrive::table() const { return links_keys(); }

}  // namespace

DriveKind links_drive() {
  return {links_keys,
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            return std::make_shared<const LinksDrive>(links_table().read(t, scene));
          },
          "energy of the links",
          {{"links_lost_eV", "eV",
            "energy lost by links that broke since the start, minus the energy that links had when they formed",
            &TermAccount::lost},
           {"links_formed", "", "links at the start, and those that have formed since", &TermAccount::begun},
           {"links_broken", "", "links that have broken since the start", &TermAccount::events}}};
}

}  // namespace ropewalk
