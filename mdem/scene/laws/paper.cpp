// law = "paper": the published law, from the set's [contact.paper].
#include "scene/laws/paper.hpp"

#include "model/contact/paper.hpp"
#include "scene/laws/contact_law_kind.hpp"
#include "scene/scene.hpp"
#include "sim/contact/paper/law.hpp"

namespace ropewalk {

PaperContact paper_contact(const Scene& scene) {
  PaperContact law = *scene.parameters().law<PaperContact>();
  return scene.contact.cutoff > 0 ? with_cutoff(law, scene.contact.cutoff) : law;
}

ContactLawKind paper_kind() {
  ContactLawKind kind;
  kind.name = "paper";
  kind.make = [](const Scene& scene) { return paper_law(paper_contact(scene), scene.contact.legacy_torque); };
  kind.in_set = [](const ParameterSet& set) { return set.law<PaperContact>() != nullptr; };
  kind.mixes_types = false;
  kind.any_element_length = false;  // its energy is that of a pair of elements, not of a length
  return kind;
}

}  // namespace ropewalk
