// Linear systems (K + s M) x = b of ropes: conjugate gradients where K is symmetric, GMRES where it is not, with
// each tube's chain of bonds solved exactly and, in a rope, motions of its sections for what reaches far.
//
// M. R. Hestenes, E. Stiefel, J. Res. Natl. Bur. Stand. 49, 409 (1952), DOI 10.6028/jres.049.044; Y. Saad,
// M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986), DOI 10.1137/0907058.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sim/state/state.hpp"
#include "sim/statics/block_matrix.hpp"

namespace ropewalk {

// y = A x
using Operator = std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& y)>;

// The elements of a rope by sections across it: as many along each strand. None: the elements lie in no sections,
// as in a film. The sections of a thick rope are cut into parts of few neighbouring strands each.
struct Sections {
  std::vector<int> of;  // section of each element
  int count = 0;
  std::vector<int> part;  // part of each element, counted along the rope
  int parts_of_each = 1;

  int parts() const { return count * parts_of_each; }
};
Sections sections_of(const Topology& topology, const State& state);

// An approximate inverse, symmetric and positive.
class Preconditioner {
 public:
  // A preconditioner of K + shift M, with the identity in the rows of held unknowns. A chain of which many motions
  // fall is taken with a larger shift, and the sections likewise.
  Preconditioner(const Topology& topology, const State& state, const Sections& sections, const BlockMatrix& k,
                 const Eigen::VectorXd& mass, double shift, const std::vector<char>& held);
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

 private:
  // How many pivots were not positive.
  int decompose_chain(int tube, const BlockMatrix& k, const Eigen::VectorXd& mass, double shift,
                      const std::vector<char>& held);
  void find_section_motions(const State& state, const std::vector<char>& held);
  int decompose_sections(const BlockMatrix& k, const Eigen::VectorXd& mass, double shift);
  void add_sections(const Eigen::VectorXd& r, Eigen::VectorXd& z) const;

  using Blocks = std::vector<Block, Eigen::aligned_allocator<Block>>;
  const Topology& topology_;
  const Sections& sections_;
  Blocks inverse_, lower_;  // inverse pivots of each chain; L_i,i-1
  static constexpr int motions = 7;  // their number for each section
  using Motions = Eigen::Matrix<double, 6, motions>;
  std::vector<Motions, Eigen::aligned_allocator<Motions>> motion_;  // how each element moves in them
  Eigen::MatrixXd band_;    // Cholesky factor, row k of column j: (j + k, j)
};

struct Solution {
  int iterations = 0;
  double residual = 0;     // relative residual in the norm of the approximate inverse
  bool falls = false;      // a motion of negative curvature was met, or the solution points against b
  Eigen::VectorXd motion;  // that one, of conjugate gradients
};
using Precondition = std::function<void(const Eigen::VectorXd& r, Eigen::VectorXd& z)>;
Solution conjugate_gradients(const Operator& a, const Precondition& m, const Eigen::VectorXd& b, double tolerance,
                             int most, Eigen::VectorXd& x);
Solution gmres(const Operator& a, const Precondition& m, const Eigen::VectorXd& b, double tolerance, int most,
               Eigen::VectorXd& x);

}  // namespace ropewalk
