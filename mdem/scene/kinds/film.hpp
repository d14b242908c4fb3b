// [film] straight tubes at random in a box, flat and one upon another, none closer to another than a spacing.
#pragma once

#include <vector>

#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class FilmSource : public Source {
 public:
  int tubes = 0;
  double length = 0;   // nm, rounded to whole elements
  double width = 0;    // nm, of the box in x
  double depth = 0;    // nm, in y
  double spacing = 0;  // nm: no two axes are closer; 0: where two crossed tubes bind best

  Sizes sizes(double element_length) const override;
  void place(const Scene&, double spacing_of_rope, Random&, Topology&, State&) const override;
  std::string description(const Topology&, const State&, double spacing_of_rope) const override;
};

// A straight tube parallel to the plane of the film.
struct FilmTube {
  double x = 0, y = 0, z = 0;  // nm, of its middle
  double angle = 0;            // rad, from the x axis
};

// The squared distance (nm^2) of two tubes of one length in projection on the plane of the film: 0 where they
// cross.
double projected_distance2(const FilmTube& a, const FilmTube& b, double length);

// Lays down the tubes of `film` one after another, `elements` of `element_length` each. The box is centred on the
// origin in x and y, and the lowest tubes lie at z = 0. Tubes with near numbers are near each other.
std::vector<FilmTube> lay_film(const FilmSource& film, int elements, double element_length, double spacing,
                               Random& random);

}  // namespace ropewalk
