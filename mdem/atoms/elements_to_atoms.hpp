// The way from elements to atoms.
//
// Element e of a tube (length a at rest) owns the sites of the lattice with e a <= s < (e + 1) a, where s is the
// height of a site on the tube at rest. A site (s, phi) goes to
//
//   x = r(s) + R(s) rho (cos phi, sin phi, 0),   rho = r_0 (1 - nu strain), and half of the lift of its sublattice
//
// Between the centres of two elements r is the cubic Hermite curve with the axes as tangents, scaled by the chord,
// and R turns at an even rate from one orientation to the next. Beyond the outermost centres r is straight and R
// does not turn. nu is Poisson's ratio of the set, and the strain is that of the chord. Exact for uniform stretch
// and twist; of a bend of curvature k, r is off an arc by less than k^3 a^4/384. Turn and shift of the lattice are
// those of the body frames: site (0,0) has phi = 0 where the first element begins. Where a bond has broken, both
// pieces end there as tubes do: half an element beyond their last centre, straight. Units nm, rad.
#pragma once

#include <functional>
#include <vector>

#include "atoms/tube_reference.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct TubeSection {
  Vector3 centre;         // nm
  Eigen::Matrix3d frame;  // columns: the body's x and y, and the axis
  double radius = 0;      // nm
};

// The centre line of a tube and its cross-sections.
class TubeCurve {
 public:
  // Elements first .. first + elements - 1 of a state. `broken`: of each element of the state, whether the bond behind
  // it has broken; empty: none has.
  TubeCurve(const State& state, std::size_t first, int elements, double element_length,
            const TubeReference& reference, const std::vector<char>& broken = {});

  // At the height s (nm) of the tube at rest.
  TubeSection at(double s) const;

 private:
  struct Bond {
    Vector3 from, to, tangent_from, tangent_to;  // nm; tangents scaled by the chord
    Eigen::Quaterniond start, end;
    Vector3 turn_axis;  // axis in the body's frame
    double turn = 0;    // rad
    double radius = 0;  // nm
    bool broken = false;
  };
  // The straight end of a piece at the broken bond k, `u` of an element behind the centre before it.
  TubeSection at_break(std::size_t k, double u) const;

  double length_;
  double radius_;  // at rest, nm
  std::vector<Bond> bonds_;
};

// The first height (in thirds of a hexagon) of element e, and of the one behind it.
long first_height(const TubeReference& reference, double element_length, int element);

// Elements begin .. end - 1 of a tube, counted in the tube.
struct TubePart {
  int tube = 0, begin = 0, end = 0;
  int elements() const { return end - begin; }
};

struct PlacedAtom {
  int part = 0, tube = 0, element = 0;  // element: counted in the tube
  bool second = false;                  // whether the atom is of the second sublattice
  Vector3 position;                     // nm
};

// The atoms of parts of the tubes of a state. Nothing is stored for an atom.
class AtomsOfElements {
 public:
  // `references`: of each tube type. `broken`: of each element, whether the bond behind it has broken; empty: none
  // has.
  AtomsOfElements(const Topology& topology, const State& state, std::vector<TubeReference> references,
                  std::vector<TubePart> parts, std::vector<char> broken = {});

  const std::vector<TubePart>& parts() const { return parts_; }
  long count() const;
  long count(const TubePart& part) const;
  const Honeycomb& honeycomb_of(const TubePart& part) const { return reference_of_tube(part.tube).honeycomb; }
  // Part by part and element by element.
  void for_each(const std::function<void(const PlacedAtom&)>& visit) const;
  // A box that holds all of them.
  void bounds(Vector3& low, Vector3& high) const;

 private:
  const TubeReference& reference_of_tube(int tube) const;

  const Topology& topology_;
  const State& state_;
  std::vector<TubeReference> references_;
  std::vector<TubePart> parts_;
  std::vector<char> broken_;
};

}  // namespace ropewalk
