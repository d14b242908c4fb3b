// [rope] parallel tubes along z, on a hexagonal lattice or not, centred on the origin. Each place of the
// cross-section has one tube as long as the rope, or a strand: tubes of given lengths in line, with their ends
// inside.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "scene/kinds/scene_kind.hpp"

namespace ropewalk {

class RopeSource : public Source {
 public:
  // Places: full shells of a lattice, those nearest to its axis whatever their number, or none of a lattice.
  enum class Packing { hexagonal, round, random };
  // Where tubes of neighbouring strands end: at one height, shifted by a third of a tube, anywhere.
  enum class Stagger { none, brick, random };

  static constexpr int least_elements = 3;  // fewest elements of a tube

  int tubes = 91;  // number of tubes in a cross-section; full shells have 1, 7, 19, 37, 61, 91, 127, 169, 217, ...
  Packing packing = Packing::hexagonal;
  std::vector<std::pair<double, double>> typed_places = {};  // places of the tubes in place of a packing, nm
  double length = 0;                                         // nm, rounded to whole elements
  double spacing = 0;                                        // nm; 0: that at which two tubes bind best
  double perturbation = 0;  // nm: amplitude of a random lateral displacement of every element
  double tube_length = 0;   // nm, the mean; 0: as long as the rope
  double deviation = 0;     // nm, standard deviation of the lengths
  double gap = 0;           // nm, between the walls of tubes in line; 0: where their ends rest
  Stagger stagger = Stagger::random;

  Sizes sizes(double element_length) const override;
  void place(const Scene&, double spacing_of_tubes, Random&, Topology&, State&) const override;
  double typed_spacing() const override { return spacing; }
  // Parts of tubes slide as a whole; and helices are longer than the axis, so that long tubes shrink along it.
  double slides() const override { return tube_length > 0 ? 5 + 0.1 * tube_length : 0; }
  bool is_parallel() const override { return true; }
  bool draws_together(bool unlike) const override {
    return typed_places.empty() && (unlike || packing == Packing::random);
  }
  std::string description(const Topology&, const State&, double spacing_of_tubes) const override;

  // Places of the strands in a cross-section (nm), about its middle. `seed`: for random ones.
  std::vector<std::pair<double, double>> places(double spacing_of_tubes, std::uint64_t seed = 1) const;

 private:
  void place_strands(const Scene& scene, double spacing_of_tubes, Random& random, Topology&, State&) const;
  // Numbers of elements from the lower end of a strand at which one tube ends and the next begins.
  std::vector<int> cuts(int strand_shift, double element_length, double gap_here, Random& random) const;
  double drawn_length(double element_length, Random& random) const;  // length of a tube, nm
  // The gap of a scene: the typed one, or where ends rest. Refuses one into which ends would be driven.
  double least_gap(const Scene& scene) const;
  // A slice of an endless rope (TubeGroups::images): tubes end at the same elements in each period.
  void place_slice(const Scene& scene, double spacing_of_tubes, Random& random, Topology&, State&) const;
  std::vector<int> cuts_of_period(int strand_shift, int own, int tubes_in_line, int images, double element_length,
                                  Random& random) const;
};

// Refuses a packing without a place for each tube, tubes of fewer than three elements, and more elements than fit.
void check_rope_size(const TomlTable& t, const Scene& scene, const RopeSource& rope, int ropes);

}  // namespace ropewalk
