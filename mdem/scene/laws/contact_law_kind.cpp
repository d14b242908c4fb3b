#include "scene/laws/contact_law_kind.hpp"

#include <algorithm>
#include <utility>

#include "scene/own_parts.hpp"

namespace ropewalk {

// One line for each shipped law, and one below.
ContactLawKind line_kind();
ContactLawKind paper_kind();

namespace {

std::vector<ContactLawKind>& laws_of_contact() {
  static std::vector<ContactLawKind> kinds = {
      line_kind(),
      paper_kind(),
  };
  return kinds;
}

}  // namespace

const std::vector<ContactLawKind>& contact_law_kinds() { return laws_of_contact(); }

bool add_contact_law(ContactLawKind kind) {
  refuse_taken_name(kind.name == "none", "contact law", kind.name);
  return add_own_part(laws_of_contact(), std::move(kind), "contact law",
                      [](const ContactLawKind& k) { return k.name; });
}

const ContactLawKind* contact_law_kind(const std::string& name) {
  for (const ContactLawKind& kind : laws_of_contact())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::string default_contact_law(const std::vector<ParameterSet>& sets) {
  std::string last;
  for (const ContactLawKind& kind : laws_of_contact()) {
    if (!kind.in_set) continue;
    if (std::all_of(sets.begin(), sets.end(), kind.in_set)) return kind.name;
    last = kind.name;
  }
  return last;
}

}  // namespace ropewalk
