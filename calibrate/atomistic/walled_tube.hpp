// A finite tube of several walls between two bands of held atoms, and the pair potential of such atoms in LAMMPS.
#pragma once

#include <string>
#include <vector>

#include "atoms/lattice.hpp"
#include "atoms/potential.hpp"
#include "model/contact/tube_ends.hpp"

namespace ropewalk::calibrate {

// One wall of a tube, as it stands alone or beside its neighbours.
struct WallShape {
  Chirality c;
  TubeShape shape;
};

// The walls that the grips at both ends hold.
enum class Holding { all, outer };

// The potential within each of `walls` atom types, and Lennard-Jones (no cutoff: 4 sigma; shifted to 0 at the
// cutoff) between unlike types.
// Throws InputError for a potential that is not one pair_style and one pair_coeff line.
std::string walled_pair_commands(const Potential& potential, const LennardJones& law, std::size_t walls);

class WalledTube {
 public:
  // `free_hexagons` of each wall, inside first, between bands of the length `band` (nm). The walls are centred on
  // one another.
  WalledTube(const std::vector<WallShape>& walls, const std::vector<long>& free_hexagons, double band);

  std::size_t atoms() const { return atoms_; }
  double free_length() const { return parts_.back().free_length; }  // outer wall, nm
  double free_length(std::size_t wall) const { return parts_[wall].free_length; }
  const std::vector<Site>& sites(std::size_t wall) const { return parts_[wall].sites; }
  std::string data() const;

  // Reads the data. Type k is wall k. Group `held` has the bands of all walls or of the outer one, `free` the rest,
  // `wall1`, `wall2`, ... the walls; fix `ref` keeps the straight positions. Atom-style variables: `half`, half of
  // the free length of an atom's wall; `led`, 1 for atoms of walls that are held. `turn`: rad, about the axis,
  // first.
  std::string commands(const Potential& potential, const LennardJones& law, const std::string& data,
                       Holding holding, double turn = 0) const;
  // The energies of all walls (eV), the norm of the forces (eV/Angstrom) and the mean radius of the outer wall in
  // the middle (Angstrom), as one line of results.
  std::string report(const std::string& name) const;

 private:
  struct Part {
    std::vector<Site> sites;     // sorted: lower band, free part, upper band
    std::vector<Vector3> atoms;  // nm
    std::size_t below = 0, free = 0;
    double free_length = 0;
  };
  std::vector<Part> parts_;
  std::size_t atoms_ = 0;
  double total_length_ = 0;
};

}  // namespace ropewalk::calibrate
