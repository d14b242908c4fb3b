// Long straight rows of elements in contact, for the cases of the van der Waals law.
#pragma once

#include "cases/common/chain.hpp"
#include "contact/integral.hpp"

namespace ropewalk {

// The line law of a set between elements of its own length.
LineContact line_contact_of(const ParameterSet& set);

// The surface integral that the set's line law stands for: atoms, radius and density of the set.
PairIntegral surface_integral(const ParameterSet& set);

// A bundle of hexagonally packed straight tubes with the line law; see scene/build.hpp.
struct Bundle {
  Topology topology;
  Interaction interaction;
  State state;
  double spacing = 0;
  double time_step = 0;
};
Bundle line_bundle(const ParameterSet& set, int tubes, int elements);

}  // namespace ropewalk
