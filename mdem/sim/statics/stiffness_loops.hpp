// The loops of a tangent that take nearly all of its time: products, sweeps along tubes, and the stiffness of two
// elements by the line law. Blocks are 36 numbers each, column by column.
#pragma once

#include <array>
#include <vector>

#include "sim/contact/line/radial_table.hpp"

namespace ropewalk {

// y += K x, see block_matrix.hpp.
void add_block_product(int rows, const int* begin, const int* column, const double* block, const double* diagonal,
                       const double* x, double* y);

// z = (L D L')^-1 z for the rows from .. to - 1 of one tube: `lower`: L_i,i-1; `inverse`: D_i^-1.
void solve_chain(int from, int to, const double* lower, const double* inverse, double* z);

// All pairs of nodes of two elements, and the tables of their force.
class LineNodePairs {
 public:
  explicit LineNodePairs(const LineContact& contact);

  static constexpr int degree = 4, powers = 15;  // k^a l^b with a + b up to the degree
  FullTable table;                               // table over squared distances in nm^2
  int lanes = 0;                                 // pairs of nodes, filled up to whole vectors
  double cutoff2 = 0, core2 = 0;                 // nm^2
  std::vector<double> k, l;                      // nm, places of the nodes on their elements
  std::vector<double> weight;                    // nm^2; zero for what fills up
  std::array<std::vector<double>, powers> power;
};
// Room for the lanes of one pair.
struct LineScratch {
  std::vector<double> g, h, r2;
  explicit LineScratch(int lanes = 0)
      : g(static_cast<std::size_t>(lanes)),
        h(static_cast<std::size_t>(lanes)),
        r2(static_cast<std::size_t>(lanes)) {}
};

// Second derivatives of the energy of two elements, by the polynomials that give the force: added to the diagonal
// blocks, and set between i and j. `separation`: x_j - x_i. False: no two nodes reach each other, and nothing is
// done.
bool add_line_stiffness(const LineNodePairs& pairs, const double* separation, const double* n_i, const double* n_j,
                        LineScratch& scratch, double* k_ii, double* k_jj, double* k_ij);

}  // namespace ropewalk
