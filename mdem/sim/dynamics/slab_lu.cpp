#include "sim/dynamics/slab_lu.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/contract.hpp"

namespace ropewalk {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Runs Eigen on one thread: its products round differently on another number of threads.
struct OneThread {
  OneThread() { Eigen::setNbThreads(1); }
  ~OneThread() { Eigen::setNbThreads(0); }
};

std::vector<Index> farthest_of(const SlabLu::Matrix& a) {
  std::vector<Index> out(static_cast<std::size_t>(a.rows()));
  for (Index i = 0; i < a.rows(); ++i) out[static_cast<std::size_t>(i)] = i;
  for (Index column = 0; column < a.outerSize(); ++column)
    for (SlabLu::Matrix::InnerIterator entry(a, column); entry; ++entry) {
      const auto low = static_cast<std::size_t>(std::min<Index>(entry.row(), column));
      out[low] = std::max<Index>(out[low], std::max<Index>(entry.row(), column));
    }
  return out;
}

}  // namespace

std::vector<Index> slab_ends(const std::vector<Index>& farthest) {
  const auto all = static_cast<Index>(farthest.size());
  std::vector<Index> ends;
  Index begin = 0, end = 0, reach = 0;
  while (end < all) {
    // A slab ends as far as the slab before it reaches. It has at least one unknown, with all that this one reaches.
    const Index next = std::max(reach, farthest[static_cast<std::size_t>(end)]) + 1;
    begin = end;
    end = std::min(next, all);
    for (Index i = begin; i < end; ++i) reach = std::max(reach, farthest[static_cast<std::size_t>(i)]);
    ends.push_back(end);
  }
  return ends;
}

SlabCost slab_cost(const std::vector<Index>& ends) {
  SlabCost out;
  double before = 0, begin = 0;
  for (const Index end : ends) {
    const double n = static_cast<double>(end) - begin;
    out.numbers += n * n + before * n;
    out.operations += 2.0 / 3 * n * n * n + 2 * before * n * (before + n);
    before = n;
    begin = static_cast<double>(end);
  }
  return out;
}

SlabLu::SlabLu(const Matrix& a) {
  ROPEWALK_EXPECTS(a.rows() == a.cols());
  const OneThread one;
  Index begin = 0;
  for (const Index end : slab_ends(farthest_of(a))) {
    Slab slab;
    slab.begin = begin;
    slab.size = end - begin;
    MatrixXd diagonal = a.block(begin, begin, slab.size, slab.size);
    if (!slabs_.empty()) {
      Slab& last = slabs_.back();
      slab.before = a.block(begin, last.begin, slab.size, last.size);
      last.above = last.diagonal.solve(MatrixXd(a.block(last.begin, begin, last.size, slab.size)));
      diagonal.noalias() -= MatrixXd(slab.before) * last.above;
    }
    slab.diagonal.compute(diagonal);
    slabs_.push_back(std::move(slab));
    begin = end;
  }
  constexpr double digits = 1e-6;
  const VectorXd expected = VectorXd::Ones(a.rows()), b = a * expected, left = b - a * solve(b);
  if (!(left.norm() <= digits * b.norm() + 1e-300))
    throw std::runtime_error("the matrix cannot be decomposed: it is singular, or far from positive");
}

VectorXd SlabLu::solve(const VectorXd& b) const {
  VectorXd x = b;
  for (std::size_t k = 0; k < slabs_.size(); ++k) {
    const Slab& s = slabs_[k];
    auto own = x.segment(s.begin, s.size);
    if (k > 0) own -= s.before * x.segment(slabs_[k - 1].begin, slabs_[k - 1].size);
    own = s.diagonal.solve(own).eval();
  }
  for (std::size_t k = slabs_.size(); k-- > 1;) {
    const Slab &s = slabs_[k], &last = slabs_[k - 1];
    x.segment(last.begin, last.size).noalias() -= last.above * x.segment(s.begin, s.size);
  }
  return x;
}

std::size_t SlabLu::numbers() const {
  std::size_t out = 0;
  for (const Slab& s : slabs_)
    out += static_cast<std::size_t>(s.size * s.size + s.above.size() + s.before.nonZeros());
  return out;
}

}  // namespace ropewalk
