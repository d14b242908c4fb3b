// LU decomposition of a sparse matrix whose unknowns reach only near ones in their order, as those of a rope along
// it. Slabs of unknowns reach only the slabs next to them:
//
//   D_k <- D_k - L_k D_{k-1}^-1 U_{k-1},     D_k dense, rows exchanged within a slab alone
//
// Nearly all of its time goes into products of dense matrices. It is made for matrices whose symmetric part is
// positive or nearly so: a decomposition that has lost its digits is refused.
#pragma once

#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <vector>

namespace ropewalk {

// Ends of the slabs, each one past its last unknown, from the farthest unknown that each unknown reaches.
std::vector<Eigen::Index> slab_ends(const std::vector<Eigen::Index>& farthest);

// Cost of a decomposition with these slabs: numbers that are kept, and operations.
struct SlabCost {
  double numbers = 0, operations = 0;
};
SlabCost slab_cost(const std::vector<Eigen::Index>& ends);

class SlabLu {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  // Throws std::runtime_error for a matrix that is singular, or too far from positive.
  explicit SlabLu(const Matrix& matrix);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  std::size_t numbers() const;

 private:
  struct Slab {
    Eigen::Index begin = 0, size = 0;
    Eigen::PartialPivLU<Eigen::MatrixXd> diagonal;
    Eigen::MatrixXd above;                                 // D^-1 U, to the next slab
    Eigen::SparseMatrix<double, Eigen::RowMajor> before;  // L, to the slab before
  };
  std::vector<Slab> slabs_;
};

}  // namespace ropewalk
