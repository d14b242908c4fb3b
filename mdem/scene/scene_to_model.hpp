// The forces of a scene, resolved to elements: all that another engine needs besides the state.
#pragma once

#include "scene/scene.hpp"
#include "sim/contact/contact_law.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/state/interaction.hpp"

namespace ropewalk {

// Whether drives hold single elements. The centres of these then stay where they are in a scene with elements of another
// length, and a tube has no free length beyond the centres of its first and last elements.
bool holds_elements(const Scene& scene);
// Elements of a tube less those that make its free length.
int elements_held(const Scene& scene, int tube);
// nm, of a tube: what can stretch, bend and twist between its ends. Where drives hold single elements, it is the distance
// at the start from the centre of the innermost element that is held at the lower end to that at the upper end; the first
// and the last element count as held. Else it is the length of the tube.
double free_length(const Scene& scene, const Topology& topology, int tube);

// The validity of each tube type, for its longest tube.
std::vector<Validity> validities(const Scene& scene, const Topology& topology);

// The scene's tube types, and no tubes yet.
Topology empty_topology(const Scene& scene);
// The bonds of tubes with the free lengths of those that the topology holds: long ones collapse earlier, and those of a
// slice without ends as endless ones.
void set_collapse(const Scene& scene, Topology& topology);

// The contact law of the scene; null: none. It takes searches for its wells: make it once and hand it on.
std::shared_ptr<const ContactLaw> contact_law(const Scene& scene);

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

// Adds the force terms of the drives. Throws InputError for elements that do not exist.
void add_terms(const Scene& scene, const Topology& topology, Interaction& interaction);

// ps, from when on no drive changes anything.
double protocol_time(const Scene& scene);

// Throws InputError for loads on elements that do not exist.
LoadsAndConstraints loads_of(const Scene& scene, const Topology& topology, const Interaction& interaction);

}  // namespace ropewalk
