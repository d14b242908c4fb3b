// The way from atoms to elements: the inverse of elements_to_atoms.hpp.
//
// Each element takes a least-squares fit of its atoms, whose sites (s, phi) are known,
//
//   x = c + d (s - s_e) + p cos phi + q sin phi
//
// c is the centre of its atoms, d the slope of their centre line, and the orthonormal pair nearest to (p, q) with
// its cross product is the orientation. So position and orientation come from all atoms. The means over an element
// differ from the values at its centre where bend and twist change along the tube: the elements that are returned
// are those whose own atoms have the same fit (fixed point iteration). What the elements lack is left over as a
// shape. Errors: a thermal displacement u of atoms moves centre and orientation of an element of N atoms by about
// u/sqrt(N) and u/(r sqrt(N/2)). Units nm, ps, rad.
#pragma once

#include <cstdint>
#include <vector>

#include "atoms/elements_to_atoms.hpp"

namespace ropewalk {

struct LabelledAtom {
  std::uint32_t atom = 0;  // its index in the arrays of a frame
  Site site;               // of the lattice; site (0,0) lies where element 0 begins
};

// Shape of the cross-section of an element, beyond what its element says.
struct SectionShape {
  double radius = 0;                // nm, mean
  double ovality = 0;               // nm, amplitude of the radius in 2 phi
  double shear_x = 0, shear_y = 0;  // angles of the centre line to the section's normal, in the body frame, rad
};

class ElementFit {
 public:
  // Atoms that lie in none of the elements are left out. Every element needs atoms on all sides: at least 8.
  ElementFit(const TubeReference& reference, double element_length, int elements,
             const std::vector<LabelledAtom>& atoms);

  int elements() const { return static_cast<int>(begin_.size()) - 1; }
  // The number of atoms of an element, over that of its sites.
  double filled(int element) const;

  // Fills elements first .. of `state` from the positions (nm) of a frame.
  void fit(const std::vector<Vector3>& positions, State& state, std::size_t first) const;
  // Also their velocities, from those of the atoms (nm/ps).
  void fit_velocities(const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities, State& state,
                      std::size_t first) const;
  std::vector<SectionShape> shapes(const std::vector<Vector3>& positions, const State& state,
                                   std::size_t first) const;
  // Distance (nm) of each atom from the place that the elements imply for it, in the order of atoms().
  std::vector<double> misfits(const std::vector<Vector3>& positions, const State& state, std::size_t first) const;
  const std::vector<LabelledAtom>& atoms() const { return atoms_; }

 private:
  struct Section {  // a fit
    Vector3 centre, slope;
    Eigen::Matrix3d frame;
    double radius = 0;
  };
  struct Place {
    double s = 0, cosine = 0, sine = 0;
  };
  template <class Position>
  std::vector<Section> sections(const Position& position) const;
  Vector3 placed(const TubeCurve& curve, std::size_t k) const;
  double centre_of(int element) const { return (element + 0.5) * element_length_; }

  TubeReference reference_;
  double element_length_;
  std::vector<LabelledAtom> atoms_;  // element by element
  std::vector<Place> places_;
  std::vector<std::size_t> begin_;        // first atom of each element, and their number
  std::vector<Eigen::Matrix4d> inverse_;  // inverse normal equations of each element
};

}  // namespace ropewalk
