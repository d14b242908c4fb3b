// [rope] hexagonally packed parallel tubes along z, centred on the origin.
#pragma once

#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class RopeSource : public Source {
 public:
  int tubes = 91;           // a hexagonal number 1, 7, 19, 37, 61, 91, 127, 169, 217, ...
  double length = 0;        // nm, rounded to whole elements
  double spacing = 0;       // nm; 0: that at which two tubes bind best
  double perturbation = 0;  // nm: amplitude of a random lateral displacement of every element

  Sizes sizes(double element_length) const override;
  void place(const Scene&, double spacing_of_tubes, Random&, Topology&, State&) const override;
  double typed_spacing() const override { return spacing; }
  bool is_parallel() const override { return true; }
  std::string description(const Topology&, const State&, double spacing_of_tubes) const override;
};

}  // namespace ropewalk
