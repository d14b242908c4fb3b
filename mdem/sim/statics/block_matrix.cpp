#include "sim/statics/block_matrix.hpp"

#include <algorithm>

#include "model/contract.hpp"
#include "sim/statics/stiffness_loops.hpp"

namespace ropewalk {

Block& BlockMatrix::at(int row, int other) {
  ROPEWALK_EXPECTS(row >= 0 && row < other && other < rows());
  const auto from = column.begin() + begin[static_cast<std::size_t>(row)],
             to = column.begin() + begin[static_cast<std::size_t>(row) + 1];
  const auto found = std::find(from, to, other);
  ROPEWALK_EXPECTS(found != to);
  return block[static_cast<std::size_t>(found - column.begin())];
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  ROPEWALK_EXPECTS(x.size() == 6 * rows());
  y.setZero(x.size());
  if (rows() == 0) return;
  add_block_product(rows(), begin.data(), column.data(), block.empty() ? nullptr : block[0].data(),
                    diagonal[0].data(), x.data(), y.data());
  for (const Single& s : single) y.segment<6>(6 * s.row).noalias() += s.block * x.segment<6>(6 * s.column);
}

bool BlockMatrix::symmetric() const {
  constexpr double rounding = 1e-9;
  double largest = 0, odd = 0;
  for (const Block& d : diagonal) {
    largest = std::max(largest, d.cwiseAbs().maxCoeff());
    odd = std::max(odd, (d - d.transpose()).cwiseAbs().maxCoeff());
  }
  for (const Single& s : single) {
    Block back = Block::Zero();
    for (const Single& t : single)
      if (t.row == s.column && t.column == s.row) back += t.block.transpose();
    odd = std::max(odd, (s.block - back).cwiseAbs().maxCoeff());
  }
  return odd <= rounding * largest;
}

Eigen::SparseMatrix<double> BlockMatrix::sparse() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * (diagonal.size() + 2 * block.size() + single.size()));
  const auto add = [&](int row, int other, const auto& b) {
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r)
        if (b(r, c) != 0) entries.emplace_back(6 * row + r, 6 * other + c, b(r, c));
  };
  for (int i = 0; i < rows(); ++i) {
    add(i, i, diagonal[static_cast<std::size_t>(i)]);
    for (int k = begin[static_cast<std::size_t>(i)]; k < begin[static_cast<std::size_t>(i) + 1]; ++k) {
      const Block& b = block[static_cast<std::size_t>(k)];
      add(i, column[static_cast<std::size_t>(k)], b);
      add(column[static_cast<std::size_t>(k)], i, b.transpose());
    }
  }
  for (const Single& s : single) add(s.row, s.column, s.block);
  Eigen::SparseMatrix<double> out(6 * rows(), 6 * rows());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

std::size_t BlockMatrix::bytes() const {
  return (block.capacity() + diagonal.capacity()) * sizeof(Block) + single.capacity() * sizeof(Single) +
         (column.capacity() + begin.capacity()) * sizeof(int);
}

}  // namespace ropewalk
