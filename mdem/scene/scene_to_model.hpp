// The forces of a scene, resolved to elements: all that another engine needs besides the state.
#pragma once

#include "model/contact/tube_ends.hpp"
#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

// Whether a drive holds single elements (Drive::holds_elements). A scene with elements of another length then keeps
// their centres, and the free length of a tube ends at the centres of its first and last elements.
bool holds_elements(const Scene& scene);
// The number of elements of a tube less its free length in elements.
int elements_held(const Scene& scene, int tube);
// The free length of a tube (nm): the length that can stretch, bend and twist between its ends. If drives hold
// single elements, it is the distance at the start between the centres of the innermost held elements at both ends;
// the first and the last element count as held. Else it is the length of the tube.
double free_length(const Scene& scene, const Topology& topology, int tube);

// The validity of each tube type, for its longest tube.
std::vector<Validity> validities(const Scene& scene, const Topology& topology);

// The scene's tube types, and no tubes yet.
Topology empty_topology(const Scene& scene);
// Sets the bonds of all tube types by the free lengths of the tubes: a longer tube collapses at a smaller twist.
// The tubes of a periodic slice count as endless.
void set_collapse(const Scene& scene, Topology& topology);

// The contact law of the scene; null: none. It takes searches for its wells: make it once and hand it on.
std::shared_ptr<const ContactLaw> contact_law(const Scene& scene);

// The contacts of the ends of two tubes in line (ContactLawKind::ends); none: the law is that of such ends too.
std::vector<EndContact> end_contacts(const Scene& scene);

// How far the scene's law reaches (nm), and what two parallel tubes bind with at most (eV/nm, positive); of each
// pair of tube types.
struct ContactRange {
  double cutoff = 0, binding = 0;
};
std::vector<ContactRange> contact_ranges(const Scene& scene, const ContactLaw* law);

// nm, along a tube: so far the contact reaches on one nearly straight piece of it (nearest_arc), at the kink
// curvature of the set; the largest of all tube types. 0 without contact.
double least_exclusion(const Scene& scene, const ContactLaw* law);

// The reach of the contact viscosity must be set (build() does so).
Interaction interaction_of(const Scene& scene, std::shared_ptr<const ContactLaw> law);
inline Interaction interaction_of(const Scene& scene) { return interaction_of(scene, contact_law(scene)); }

// TubeGroups::ends_meet, of tubes that have their strands.
bool ends_meet(const Scene& scene, const Topology& topology);
// Adds the contact of ends in line, where these meet (TubeGroups::ends_meet).
void add_end_contacts(const Scene& scene, const Topology& topology, Interaction& interaction);
// Adds the force terms of the drives, and the contact of ends in line. Throws InputError for elements that do not
// exist.
void add_terms(const Scene& scene, const Topology& topology, const State& start, Interaction& interaction);

// When the last drive ends to change anything, ps.
double protocol_time(const Scene& scene);

// Throws InputError for loads on elements that do not exist.
LoadsAndConstraints loads_of(const Scene& scene, const Topology& topology, const Interaction& interaction);

}  // namespace ropewalk
