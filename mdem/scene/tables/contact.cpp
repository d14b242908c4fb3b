// [contact] which law acts between tubes, and how it is summed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/bounds.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/tables/tables.hpp"

namespace ropewalk {
namespace {

constexpr long max_nodes = 64;

// "a" (first choice), "b" or "none".
std::string law_names() {
  std::string text;
  for (const ContactLawKind& kind : contact_law_kinds())
    text += text.empty() ? fmt::format("\"{}\" (first choice)", kind.name) : fmt::format(", \"{}\"", kind.name);
  return text + " or \"none\"";
}

void read_contact_law(const TomlTable& t, const Scene& scene, ContactOptions& c) {
  Words<std::string> laws;
  for (const ContactLawKind& kind : contact_law_kinds()) laws.emplace_back(kind.name.c_str(), kind.name);
  laws.emplace_back("none", "none");
  c.law = t.word_or("law", default_contact_law(scene.sets), laws);
  const ContactLawKind* kind = contact_law_kind(c.law);
  if (!kind) return;
  for (const ParameterSet& set : scene.sets)
    if (kind->in_set && !kind->in_set(set))
      throw t.error("law", fmt::format("is \"{0}\", and the set {1} has no [contact.{0}]", c.law, set.name),
                    "take another set, or law = \"none\"");
  if (!kind->mixes_types && scene.sets.size() > 1)
    throw t.error("law", fmt::format("is \"{}\", which holds between tubes of one kind alone", c.law),
                  "take law = \"line\"");
}

// Refuses a cutoff whose taper leaves less than half of the binding of two parallel tubes, which would be another
// law, and one beyond the cutoff of the fit.
void read_cutoff(const TomlTable& t, const Scene& scene, ContactOptions& contact) {
  if (!t.has("cutoff_nm")) return;
  if (contact.law == "none") throw t.error("cutoff_nm", "is of no use without contact", "take it away");
  Scene changed = scene;
  changed.contact = contact;
  const std::vector<ContactRange> own = contact_ranges(changed, contact_law(changed).get());
  changed.contact.cutoff = contact.cutoff = t.number("cutoff_nm", Bounds::positive(1e3));
  for (const ContactRange& range : own)  // first: what a law with a far cutoff binds takes long to find
    if (contact.cutoff > range.cutoff + 1e-9)
      throw t.error("cutoff_nm", fmt::format("is {} nm", contact.cutoff),
                    fmt::format("the law ends at {:.4g} nm; leave the key out", range.cutoff));
  const std::vector<ContactRange> now = contact_ranges(changed, contact_law(changed).get());
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double left = now[k].binding / own[k].binding;
    if (!(left >= 0.5))
      throw t.error("cutoff_nm",
                    fmt::format("is {} nm, which leaves {:.0f} % of the binding energy of two parallel tubes",
                                contact.cutoff, 100 * std::max(0.0, left)),
                    fmt::format("take a longer one; the law's own is {:.4g} nm", own[k].cutoff));
  }
}

constexpr const char* exclusion_key = "exclude_along_tube_nm";

// Shorter, and a straight tube would attract itself, which its bonds already contain.
void read_exclusion(const TomlTable& t, const Scene& scene, ContactOptions& contact) {
  if (t.has("exclude_along_tube_elements"))
    throw t.error("exclude_along_tube_elements", "is a length now, so that it does not change with the elements",
                  fmt::format("write {} = {:.4g}, or leave it out", exclusion_key,
                              scene.element_length *
                                  static_cast<double>(t.integer("exclude_along_tube_elements", 1, max_elements))));
  if (!t.has(exclusion_key)) return;
  if (contact.law == "none") throw t.error(exclusion_key, "is of no use without contact", "take it away");
  Scene changed = scene;
  changed.contact = contact;
  const double least = least_exclusion(changed, contact_law(changed).get());
  contact.exclude_along_tube = t.number(exclusion_key, Bounds::positive(1e7));
  if (contact.exclude_along_tube < least - 1e-9)
    throw t.error(
        exclusion_key,
        fmt::format("is {} nm, and a straight tube would attract itself", contact.exclude_along_tube),
        fmt::format("take at least {:.4g}, the reach of the contact along a bent tube, or leave the key out",
                    std::ceil(1e3 * least) / 1e3));
}

// A key that would be without effect is refused, since it was meant to have one.
void check_contact(const TomlTable& t, const Scene&, ContactOptions& c) {
  if (c.nodes > 0 && c.law != "line")
    throw t.error("nodes_per_element", "belongs to law = \"line\"", "take it away");
}

}  // namespace

const KeyTable<ContactOptions>& contact_table() {
  using Key = KeyOf<ContactOptions>;
  using C = ContactOptions;
  using Precision = Interaction::Precision;
  static const KeyTable<C> table = {
      "contact",
      "van der Waals contact between elements",
      {Key::custom("law", "", otherwise("\"paper\"", "what the set has"), law_names(), read_contact_law),
       Key::integer("nodes_per_element", 1, max_nodes, &C::nodes, otherwise("5", "for a corrugation below 2.5e-4"),
                    "line: nodes along an element")
           .goes_as_length(1),
       Key::word("precision", Words<Precision>{{"mixed", Precision::mixed}, {"double", Precision::full}},
                 &C::precision, otherwise("\"mixed\"", "mixed; double for mode = \"relax\""),
                 "\"mixed\" (pairs in single precision) or \"double\""),
       Key::boolean("legacy_torque", &C::legacy_torque, standard(),
                    "leave out the torque that the published code leaves out; gains energy, for comparison only"),
       Key::custom("cutoff_nm", "nm", otherwise("2.5", "the set's"),
                   "cutoff distance, of tube axes (line) or of element centres (paper); a shorter one is faster "
                   "and binds less",
                   read_cutoff),
       Key::custom(exclusion_key, "nm", otherwise("6", "the reach of the contact along a bent tube"),
                   "two parts of one tube attract each other only if they are farther apart along it than this",
                   read_exclusion),
       Key::number("skin_nm", unit::nm, Bounds::positive(5), &C::skin, otherwise("0.15", "chosen by the program"),
                   "margin of the neighbour list; speed only")},
      check_contact};
  return table;
}

}  // namespace ropewalk
