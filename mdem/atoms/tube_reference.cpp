#include "atoms/tube_reference.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/parameters_toml.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {

double number_of(const ParameterSet& set, const char* key) {
  const Quantity* q = find_quantity(set, key);
  return q ? q->value : 0;
}

}  // namespace

TubeReference reference_of(const ParameterSet& set) {
  refuse_filament(set, "its elements do not become atoms, nor atoms its elements", "take a set of a tube");
  refuse_several_walls(set, "its elements do not become atoms, nor atoms its elements", "take a set of one wall");
  constexpr double slack = 0.1;
  const auto off = [](double value, double of_sheet) { return std::fabs(value / of_sheet - 1) > slack; };
  const double a = set.honeycomb.lattice_constant;
  if (!set.chirality.valid() || off(set.radius, tube_radius(set.chirality, a)) ||
      off(set.atoms_per_length, atoms_per_length(set.chirality, a)))
    throw InputError(
        {set.path, 0, "meta.chirality"},
        fmt::format("is ({},{}), and radius and atoms per length are not those of such a tube", set.chirality.n,
                    set.chirality.m),
        "take a set that ropewalk calibrate made of a nanotube: elements of other things have no atoms here");
  TubeReference out;
  out.honeycomb = set.honeycomb;
  out.chirality = set.chirality;
  out.shape.radius = set.radius;
  out.shape.length_per_hexagon = 2 / set.atoms_per_length;
  out.shape.twist = number_of(set, "atomistic.natural_twist");
  out.shape.arc_shift = number_of(set, "atomistic.sublattice_turn");
  out.shape.height_shift = number_of(set, "atomistic.sublattice_rise");
  out.shape.lift = number_of(set, "atomistic.sublattice_lift");
  out.poisson = number_of(set, "atomistic.poisson");
  return out;
}

}  // namespace ropewalk
