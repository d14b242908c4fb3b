// Nanotubes in a heap of atoms, from their places alone: no order, number, name or type of an atom is used
// but that of its species.
//
// Atoms closer than 1.27 bond lengths, 0.18 nm for carbon, are bonded. An atom is regular where it has three
// neighbours and each pair of them closes a ring of six. From one regular atom on, the vectors of the lattice
// (lattice.hpp) are carried along the bonds: the three neighbours of an atom follow one another in the same sense
// around its normal everywhere on a wall. Walks that go around the tube come back with another vector: the
// difference is its (n,m), and the outside of the wall says whether it is that or the mirror image (m,n). Walks
// that end at the same atom in another image of a periodic box tell the period of an endless tube, which is cut
// where its box is.
//
// Of two species the first is on the first sublattice. This decides to which end the heights of a tube rise, which
// of one species is chosen alike for all tubes.
//
// Atoms beside defects take their sites from regular neighbours and hand none on. Atoms whose site another one has
// too, and those that no regular neighbour reaches, have none: they are counted.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atoms/atom_box.hpp"
#include "atoms/atoms_to_elements.hpp"

namespace ropewalk {

struct FoundTube {
  Chirality chirality;
  std::vector<LabelledAtom> atoms;  // site (0,0) is the first of the tube, and heights rise along it
  long top = 0;                     // height (in thirds of a hexagon) behind the last row
  bool endless = false;             // through a periodic box
  long without_site = 0;            // carbon atoms of this wall
  // Defects of this wall: rings that are not of six atoms, atoms with two neighbours in it, and with four or more.
  long pentagons = 0, heptagons = 0, open_atoms = 0, crowded = 0;
  bool cap_below = false, cap_above = false;
  Vector3 centre = Vector3::Zero();  // mean of its atoms, nm
};

// Cuts a tube to whole rows at both ends, moves its first site to where it then begins, and counts again what has
// no site. At first after it is found; again where atoms were taken out of it.
void trim(FoundTube& tube);
// Sites turned about the axis by so many of the gcd(n,m) equal parts of a turn: the same tube.
void turn_sites(FoundTube& tube, int parts);

struct FoundTubes {
  std::vector<FoundTube> tubes;    // ordered from the middle of all of them outwards
  std::vector<Vector3> positions;  // positions of all atoms, nm: those of a tube are the images that hang together
  long loose = 0;                  // carbon atoms in no tube
  long sheets = 0;                 // connected parts of them that are larger than 100 atoms, and no tubes
};

// `species`: of each atom, as AtomFrame has them. Throws InputError at `file` where there is no tube, atoms
// overlap, a box is too short for its bonds, or a tube closes on itself to a ring.
FoundTubes find_tubes(const std::vector<Vector3>& positions, const std::vector<char>& species, const AtomBox& box,
                      const std::string& file, const Honeycomb& honeycomb = {});

}  // namespace ropewalk
