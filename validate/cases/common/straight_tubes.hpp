// Straight parallel tubes, the start of most cases: those of straight-tubes/scene.toml with another set, places and
// length. This is the only place where cases get elements from, apart from scenes of their own and laid films.
#pragma once

#include <utility>
#include <vector>

#include "model/parameters.hpp"
#include "scene/build.hpp"

namespace ropewalk::validate {

using Places = std::vector<std::pair<double, double>>;  // places of the tubes across their axis, nm

// One tube at each place, along z about z = 0, of so many elements as long as the set's; one element will do. Bonds
// are Hooke's.
BuiltScene straight_tubes(const ParameterSet& set, int elements, const Places& places = {{0, 0}});

}  // namespace ropewalk::validate
