// Elastic constants of a tube of several walls, which are built, relaxed and strained together.
//
// Walls have periods of their own, which have no common multiple in general: no periodic cell holds them. So finite
// specimens of two lengths are strained, with bands of atoms held at both ends, and the difference of their
// energies is taken, which leaves the ends out. Each wall k has whole hexagons, so that the lengths of its two
// specimens differ by its own d_k, and the energy per length is the sum over the walls,
//
//   E/L = sum_k (E_k long - E_k short)/d_k,
//
// where E_k is the energy of the atoms of wall k, with half of the van der Waals energy to the other walls.
// States of strain e, twist t and curvature k are relaxed in turn; E/L is fitted as in stiffness.hpp.
// Two ways of holding: the bands of all walls are moved, or those of the outer wall alone, so that the walls inside
// are free to slide.
#pragma once

#include <utility>
#include <vector>

#include "atomistic/stiffness.hpp"
#include "atomistic/walled_tube.hpp"

namespace ropewalk::calibrate {

struct WallStiffness {
  WallShape rest;             // relaxed within its tube, with its own natural twist
  Measured radius;            // nm
  Measured atoms_per_length;  // 1/nm
  Measured EA, EI, GJ;        // eV/nm, eV nm, eV nm; its part of the energy with all walls held
};

struct WalledStiffness {
  std::vector<WallStiffness> walls;  // inside first
  // Of the whole tube by each way of holding. `rows`: those of the way; `radius` is that of the outer wall,
  // `atoms_per_length` of all walls, twists count from the relaxed tube.
  Stiffness all, outer;
  std::vector<AtomisticRow> wall_rows;  // "wall-1-stretch-twist", ...
};

// Distances between walls at which they fit (nm), and the one of graphite.
inline constexpr double least_wall_spacing = 0.28, most_wall_spacing = 0.45, graphite_spacing = 0.34;

// Free lengths of the shorter and of the longer specimen (nm), where none are given: three and six outer diameters. Near
// its ends a free wall does not bend along, over a length that grows with its width. At most 6 and 12 nm, since wide tubes
// have many atoms.
std::pair<double, double> specimen_lengths(const std::vector<Chirality>& walls);

// Specimens of the lengths options.short_length and long_length (nm). `law`: between atoms of two walls. `carried`:
// the way of holding whose bond beyond Hooke's law is wanted.
WalledStiffness measure_walls(const std::vector<Chirality>& walls, const Potential& potential,
                              const LennardJones& law, Holding carried, const std::string& folder,
                              const StiffnessOptions& options);

}  // namespace ropewalk::calibrate
