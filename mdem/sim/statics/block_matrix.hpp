// Square matrices of 6 x 6 blocks, one row and column for each element: displacement and turn.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

namespace ropewalk {

using Block = Eigen::Matrix<double, 6, 6>;

// The blocks above the diagonal stand for their transposes below it as well; diagonal blocks and single ones need
// not be symmetric.
struct BlockMatrix {
  struct Single {
    int row = 0, column = 0;
    Block block;
  };
  std::vector<int> begin{0};  // first block of each row, in `column`
  std::vector<int> column;    // above the diagonal
  std::vector<Block, Eigen::aligned_allocator<Block>> block, diagonal;
  std::vector<Single, Eigen::aligned_allocator<Single>> single;

  int rows() const { return static_cast<int>(begin.size()) - 1; }
  // The block above the diagonal at row < column, which must be there.
  Block& at(int row, int column);
  const Block& at(int row, int column) const { return const_cast<BlockMatrix*>(this)->at(row, column); }
  // y = K x
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  // Whether it differs from its transpose by more than rounding.
  bool symmetric() const;
  Eigen::SparseMatrix<double> sparse() const;
  std::size_t bytes() const;
};

}  // namespace ropewalk
