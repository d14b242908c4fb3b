// Where the elements of a scene come from.
#pragma once

#include <array>
#include <string>

#include "scene/state_memory.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

class Random;
struct Scene;

class Source {
 public:
  struct Sizes {
    int tubes = 0, elements = 0;  // elements of each tube
  };

  virtual ~Source() = default;
  // With elements of this length (nm). Zeros where only place() knows.
  virtual Sizes sizes(double /*element_length*/) const { return {}; }
  // Adds the tubes to `topology`, which has the scene's types, and puts their elements in place; whatever `state`
  // held is gone. `spacing` (nm) is that of neighbouring parallel tubes.
  virtual void place(const Scene& scene, double spacing, Random& random, Topology& topology,
                     State& state) const = 0;

  // The spacing of neighbouring parallel tubes, nm; 0: where two of them bind best.
  virtual double typed_spacing() const { return 0; }
  // How far strands may slide along one another in a slice (TubeGroups::images), nm.
  virtual double slides() const { return 0; }
  // The sides (nm) in x and y of a box centred on the origin, in which the tubes are laid at random; zeros: there
  // is none.
  virtual std::array<double, 2> box() const { return {0, 0}; }
  // Whether all tubes are straight and parallel to z.
  virtual bool is_parallel() const { return false; }
  // Whether tubes side by side are moved together, across the axis, until they touch. `unlike`: they are of several
  // types.
  virtual bool draws_together(bool /*unlike*/) const { return false; }
  // The file that the elements are read from; empty: no file.
  virtual std::string file() const { return ""; }
  // The internal state of force terms and the broken bonds that the file stores.
  virtual StateMemory memory() const { return {}; }
  // Describes the placed elements to the user.
  virtual std::string description(const Topology&, const State&, double /*spacing*/) const { return ""; }
};

}  // namespace ropewalk
