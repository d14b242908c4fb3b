// How much rope there is: what stress, specific stress, energies per mass and pressures refer to.
#pragma once

#include <string>
#include <vector>

#include "sim/contact/contact_law.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// The size of a rope without load, along its tubes. Strain and twist change none of it, and holes between tubes in
// line are no part of it. A slice counts as one period.
struct RopeSize {
  double mass = 0;             // eV ps^2/nm^2
  double mass_per_length = 0;  // mass per length of all strands, where tubes are, eV ps^2/nm^3; NaN without tubes
  double area = 0;             // area of the cross-section, the cells of its strands, nm^2; NaN without a spacing
};

// nm^2, by the type of a tube: its cell in a hexagonal packing of tubes like it. `spacing` (nm) is that of tubes of
// one type. `law`: null without contact.
std::vector<double> packing_cells(const Topology& topology, double spacing, const ContactLaw* law);

// `cells`: packing_cells(). `mass_scale`: times which the masses of the topology are those of the tubes.
RopeSize rope_size(const Topology& topology, const std::vector<double>& cells, double mass_scale);

// Linear density, area and density, and what a stress in GPa is in N/tex. Empty: they are not known.
std::string size_words(const RopeSize& size);

}  // namespace ropewalk
