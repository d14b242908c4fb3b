// Discs in a plane that are drawn together until they touch: the cross-section of a rope that is no lattice.
#pragma once

#include <vector>

namespace ropewalk {

struct Disc {
  double x = 0, y = 0;  // nm
  int type = 0;
};

// A pull to the middle that grows weaker, against a push where two discs overlap, brought to rest by FIRE (E.
// Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006), DOI 10.1103/PhysRevLett.97.170201). At the end the discs are
// centred on the origin, none overlaps another by more than 1e-3 nm, and each has come as far in as its neighbours
// let it. `apart[i][j]`: nm, between the centres of discs of the types i and j that touch.
void draw_together(std::vector<Disc>& discs, const std::vector<std::vector<double>>& apart);

}  // namespace ropewalk
