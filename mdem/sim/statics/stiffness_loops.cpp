#include "sim/statics/stiffness_loops.hpp"

#include <cmath>
#include <cstdint>

#include "sim/threads/vector_unit.hpp"

#define ROPEWALK_LOOPS "sim/statics/stiffness_loops-inl.hpp"
#include "sim/threads/for_each_vector_unit-inl.hpp"

namespace ropewalk {

void add_block_product(int rows, const int* begin, const int* column, const double* block, const double* diagonal,
                       const double* x, double* y) {
  ROPEWALK_IN_USE(add_block_product)(rows, begin, column, block, diagonal, x, y);
}

void solve_chain(int from, int to, const double* lower, const double* inverse, double* z) {
  ROPEWALK_IN_USE(solve_chain)(from, to, lower, inverse, z);
}

LineNodePairs::LineNodePairs(const LineContact& c)
    : table(c.density, 1), cutoff2(table.cutoff2), core2(table.core2) {
  constexpr int vector = 8;
  const int pairs = c.nodes_i * c.nodes_j;
  lanes = (pairs + vector - 1) / vector * vector;
  for (int m = 0; m < lanes; ++m) {
    const int of = m < pairs ? m : 0;
    k.push_back(line_node(of / c.nodes_j, c.nodes_i, c.length_i));
    l.push_back(line_node(of % c.nodes_j, c.nodes_j, c.length_j));
    weight.push_back(m < pairs ? c.length_i / c.nodes_i * c.length_j / c.nodes_j : 0);
    std::size_t at = 0;
    for (int sum = 0; sum <= degree; ++sum)
      for (int b = 0; b <= sum; ++b) power[at++].push_back(std::pow(k.back(), sum - b) * std::pow(l.back(), b));
  }
}

bool add_line_stiffness(const LineNodePairs& pairs, const double* separation, const double* n_i, const double* n_j,
                        LineScratch& scratch, double* k_ii, double* k_jj, double* k_ij) {
  return ROPEWALK_IN_USE(add_line_stiffness)(pairs, separation, n_i, n_j, scratch, k_ii, k_jj, k_ij);
}

}  // namespace ropewalk
