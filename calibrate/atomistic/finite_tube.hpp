// A finite tube between two bands of fixed atoms: the specimen of bending and of the envelope runs.
#pragma once

#include <string>
#include <vector>

#include "atoms/lattice.hpp"
#include "atoms/potential.hpp"

namespace ropewalk::calibrate {

// Width of a band (nm) at which no free atom interacts with the bare end: forces of bond-order potentials reach
// over two cutoffs.
double held_band(const Potential& potential);

// The number of hexagons, a multiple of gcd(n,m), that is nearest to a length.
long hexagons_in(Chirality c, const TubeShape& shape, double length);

// Additional hexagons, of about `length`, of the longer one of two bent tubes. The energy of an end depends on its
// azimuth phi to the bending plane: as k^2 cos 2 phi for a tube without a threefold or higher axis, and as k cos
// phi if the end is cut along one spiral step. For such tubes the ends of both must have the same azimuth;
// otherwise the difference of the energies contains the ends (1 % of EI for (8,2)).
long extra_hexagons(Chirality c, const TubeShape& shape, double length);

class FiniteTube {
 public:
  // Tubes of one shape and band have equal ends up to a rotation about the axis where their free hexagons differ by
  // a multiple of gcd(n,m), so that their energies can be differenced.
  FiniteTube(Chirality c, const TubeShape& shape, long free_hexagons, double band);

  const std::vector<Vector3>& atoms() const { return atoms_; }  // nm, centred at the origin, axis z
  double free_length() const { return free_length_; }
  std::string data(const Honeycomb& honeycomb = {}) const;

  // Reads the data; group `held` is the two bands `below` and `above`, and fix `ref` keeps the straight positions.
  // `turn` (rad): the tube is turned by it about its axis first.
  std::string commands(const Potential& potential, const std::string& data, double turn = 0) const;

 private:
  std::vector<Vector3> atoms_;
  std::vector<char> second_;          // whether each is of the second sublattice
  std::size_t below_ = 0, free_ = 0;  // the atoms are sorted: lower band, free part, upper band
  double free_length_ = 0;
  double total_length_ = 0;
};

// LAMMPS variables: bent_x, bent_z are the straight positions bent to curvature k (equal-style, per Angstrom);
// next_x, next_y, next_z are the same with the displacements from the bend k0, scaled by k/k0.
std::string affine_bend_variables();

}  // namespace ropewalk::calibrate
