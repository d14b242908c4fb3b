// [film] straight tubes at random in a box, laid one upon another, none closer to another than a spacing.
#pragma once

#include <array>
#include <vector>

#include "scene/film_tube.hpp"
#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class FilmSource : public Source {
 public:
  enum class Laid { level, resting };

  int tubes = 0;
  double length = 0;   // nm, rounded to whole elements
  double width = 0;    // side of the box in x, nm
  double depth = 0;    // side in y, nm
  double spacing = 0;  // nm: no two axes are closer; 0: where two crossed tubes bind best
  Laid laid = Laid::level;

  Sizes sizes(double element_length) const override;
  // Tubes with near numbers are near each other.
  void place(const Scene&, double spacing_of_rope, Random&, Topology&, State&) const override;
  std::array<double, 2> box() const override { return {width, depth}; }
  std::string description(const Topology&, const State&, double spacing_of_rope) const override;
};

// Lays down the tubes of `film` one after another, `elements` of `element_length` each. The box is centred on the
// origin in x and y, and the lowest tubes lie at z = 0. The tubes come in the order of laying.
std::vector<FilmTube> lay_film(const FilmSource& film, int elements, double element_length, double spacing,
                               Random& random);

// Makes elements of laid tubes, in their order.
void put_tubes(const std::vector<FilmTube>& tubes, int elements, double element_length, Topology& topology,
               State& state);

}  // namespace ropewalk
