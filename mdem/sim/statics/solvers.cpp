#include "sim/statics/solvers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>

#include "model/contract.hpp"
#include "sim/statics/stiffness_loops.hpp"

namespace ropewalk {
namespace {

using Eigen::VectorXd;

Block symmetric_part(const Block& b) { return 0.5 * (b + b.transpose()); }

// Some motions fall. Where pivots after them turn as well, the inverse grows without bound along the chain.
constexpr int most_turned = 4;

// The first shift, from `shift` on, with which decompose(shift) turns few pivots.
template <class Decompose>
void with_few_turned(double shift, const Decompose& decompose) {
  constexpr double least = 1e-4, most = 1e8;  // 1/ps^2; no motion is as fast as the last one
  while (decompose(shift) > most_turned && shift < most) shift = std::max(4 * shift, least);
}

// The inverse of a pivot. One that is not positive is taken with the signs of its negative eigenvalues turned.
Block inverse_of(const Block& d, int& turned) {
  constexpr double least = 1e-3;
  const Eigen::LLT<Block> factor(d);
  if (factor.info() == Eigen::Success && factor.matrixL().toDenseMatrix().diagonal().minCoeff() > 1e-9)
    return factor.solve(Block::Identity());
  const Eigen::SelfAdjointEigenSolver<Block> e(d);
  ++turned;
  const Eigen::Matrix<double, 6, 1> values = e.eigenvalues().cwiseAbs().cwiseMax(least);
  return e.eigenvectors() * values.cwiseInverse().asDiagonal() * e.eigenvectors().transpose();
}

// Halves a set of strands across their larger extent until few are left in each part.
void halve(const std::vector<Vector3>& place, std::vector<int>::iterator begin, std::vector<int>::iterator end,
           int& parts, std::vector<int>& part) {
  constexpr std::ptrdiff_t few = 8;
  if (end - begin <= few) {
    for (auto s = begin; s != end; ++s) part[static_cast<std::size_t>(*s)] = parts;
    ++parts;
    return;
  }
  Vector3 low = place[static_cast<std::size_t>(*begin)], high = low;
  for (auto s = begin; s != end; ++s) {
    low = low.cwiseMin(place[static_cast<std::size_t>(*s)]);
    high = high.cwiseMax(place[static_cast<std::size_t>(*s)]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](int a, int b) {
    const double x = place[static_cast<std::size_t>(a)][axis], y = place[static_cast<std::size_t>(b)][axis];
    return x != y ? x < y : a < b;
  });
  halve(place, begin, middle, parts, part);
  halve(place, middle, end, parts, part);
}

// Cuts the rope by the places of its strands in the middle section. A thin rope stays whole.
void cut_into_parts(const Topology& topology, const State& state, Sections& sections) {
  constexpr std::size_t thin = 19;
  std::vector<int> strand_of(state.size());
  std::vector<Vector3> place;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (topology.begins_strand(t))
      place.push_back(state.position[static_cast<std::size_t>(topology.tube_begin[t])]);
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      strand_of[i] = static_cast<int>(place.size()) - 1;
      if (sections.of[i] == sections.count / 2) place.back() = state.position[i];
    }
  }
  std::vector<int> strands(place.size()), part(place.size());
  for (std::size_t s = 0; s < strands.size(); ++s) strands[s] = static_cast<int>(s);
  if (place.size() > thin) {
    sections.parts_of_each = 0;
    halve(place, strands.begin(), strands.end(), sections.parts_of_each, part);
  }
  sections.part.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i)
    sections.part[i] = sections.of[i] * sections.parts_of_each + part[static_cast<std::size_t>(strand_of[i])];
}

}  // namespace

Sections sections_of(const Topology& topology, const State& state) {
  Sections out;
  out.of.resize(state.size());
  int strand_tube = 0;
  for (int t = 0; t < topology.tubes(); ++t) {
    if (topology.begins_strand(t)) strand_tube = t;
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const int section = e - topology.tube_begin[strand_tube];
      out.of[static_cast<std::size_t>(e)] = section;
      out.count = std::max(out.count, section + 1);
    }
  }
  // In a rope sections lie farther apart than they are wide.
  std::vector<Vector3> centre(static_cast<std::size_t>(out.count), Vector3::Zero());
  std::vector<double> count(centre.size(), 0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto s = static_cast<std::size_t>(out.of[i]);
    centre[s] += state.position[i];
    count[s] += 1;
  }
  for (std::size_t s = 0; s < centre.size(); ++s) centre[s] /= count[s];
  double width2 = 0, length = 0;
  for (std::size_t i = 0; i < state.size(); ++i)
    width2 += (state.position[i] - centre[static_cast<std::size_t>(out.of[i])]).squaredNorm();
  for (std::size_t s = 0; s + 1 < centre.size(); ++s) length += (centre[s + 1] - centre[s]).norm();
  if (out.count < 3 || std::sqrt(width2 / static_cast<double>(state.size())) > 0.3 * length) out.count = 0;
  if (out.count > 0) cut_into_parts(topology, state, out);
  return out;
}

Preconditioner::Preconditioner(const Topology& topology, const State& state, const Sections& sections,
                               const BlockMatrix& k, const VectorXd& mass, double shift,
                               const std::vector<char>& held)
    : topology_(topology), sections_(sections) {
  const auto n = static_cast<std::size_t>(k.rows());
  inverse_.resize(n);
  lower_.assign(n, Block::Zero());
  for (int t = 0; t < topology.tubes(); ++t)
    with_few_turned(shift, [&](double s) { return decompose_chain(t, k, mass, s, held); });
  if (sections_.count == 0) return;
  find_section_motions(state, held);
  with_few_turned(shift, [&](double s) { return decompose_sections(k, mass, s); });
}

int Preconditioner::decompose_chain(int tube, const BlockMatrix& k, const VectorXd& mass, double shift,
                                    const std::vector<char>& held) {
  int turned = 0;
  const auto is_held = [&](std::size_t i, int c) { return held[6 * i + static_cast<std::size_t>(c)] != 0; };
  for (int e = topology_.tube_begin[tube]; e < topology_.tube_begin[tube + 1]; ++e) {
    const auto i = static_cast<std::size_t>(e);
    Block d = symmetric_part(k.diagonal[i]);
    d.diagonal() += shift * mass.segment<6>(6 * static_cast<Eigen::Index>(e));
    for (int c = 0; c < 6; ++c)
      if (is_held(i, c)) {
        d.row(c).setZero();
        d.col(c).setZero();
        d(c, c) = 1;
      }
    if (e > topology_.tube_begin[tube]) {
      Block above = k.at(e - 1, e);
      for (int c = 0; c < 6; ++c) {
        if (is_held(i, c)) above.col(c).setZero();
        if (is_held(i - 1, c)) above.row(c).setZero();
      }
      lower_[i] = above.transpose() * inverse_[i - 1];
      d -= lower_[i] * above;
      d = symmetric_part(d);
    }
    inverse_[i] = inverse_of(d, turned);
  }
  return turned;
}

namespace {

std::vector<Vector3> centres_of(const State& state, const std::vector<int>& of, int count) {
  std::vector<Vector3> centre(static_cast<std::size_t>(count), Vector3::Zero());
  std::vector<double> elements(centre.size(), 0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto k = static_cast<std::size_t>(of[i]);
    centre[k] += state.position[i];
    elements[k] += 1;
  }
  for (std::size_t k = 0; k < centre.size(); ++k) centre[k] /= std::max(elements[k], 1.0);
  return centre;
}

}  // namespace

// Moves of each part along three axes, its turn about the rope's axis, tilts of its elements in place, and their
// tilts as helices whose pitch changes: tubes slide along one another, so that sections do not stay plane. Moves and
// turns of whole sections are sums of these. Without the last one a change of twist would shear the tubes, a
// thousand times stiffer than it bends them.
void Preconditioner::find_section_motions(const State& state, const std::vector<char>& held) {
  const auto count = static_cast<std::size_t>(sections_.count);
  const std::vector<Vector3> centre = centres_of(state, sections_.of, sections_.count),
                             middle = centres_of(state, sections_.part, sections_.parts());
  std::vector<Eigen::Matrix3d> frame(count);
  for (std::size_t s = 0; s < count; ++s) {
    const Vector3 along = (centre[std::min(s + 1, count - 1)] - centre[s > 0 ? s - 1 : 0]).normalized();
    const Vector3 across = along.unitOrthogonal();
    frame[s] << across, along.cross(across), along;
  }
  motion_.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Eigen::Matrix3d& f = frame[static_cast<std::size_t>(sections_.of[i])];
    const Vector3 arm = state.position[i] - middle[static_cast<std::size_t>(sections_.part[i])];
    Motions z = Motions::Zero();
    z.block<3, 3>(0, 0) = z.block<3, 3>(3, 3) = f;
    z.block<3, 1>(0, 5) = f.col(2).cross(arm);
    z.block<3, 1>(3, 6) = f.col(2).cross(z.block<3, 1>(0, 5));
    for (int c = 0; c < 6; ++c)
      if (held[6 * i + static_cast<std::size_t>(c)]) z.row(c).setZero();
    motion_[i] = z;
  }
}

int Preconditioner::decompose_sections(const BlockMatrix& k, const VectorXd& mass, double shift) {
  const auto section = [&](int e) { return sections_.part[static_cast<std::size_t>(e)]; };
  int reach = 0;
  for (int i = 0; i < k.rows(); ++i)
    for (int at = k.begin[static_cast<std::size_t>(i)]; at < k.begin[static_cast<std::size_t>(i) + 1]; ++at)
      reach = std::max(reach, std::abs(section(i) - section(k.column[static_cast<std::size_t>(at)])));
  constexpr int m = motions;
  using Small = Eigen::Matrix<double, m, m>;
  const int n = m * sections_.parts(), width = m * (reach + 1);
  band_ = Eigen::MatrixXd::Zero(width, n);
  const auto add = [&](int row_section, int column_section, const Small& b) {
    for (int c = 0; c < m; ++c)
      for (int r = 0; r < m; ++r)
        if (const int row = m * row_section + r, column = m * column_section + c; row >= column)
          band_(row - column, column) += b(r, c);
  };
  for (int i = 0; i < k.rows(); ++i) {
    const auto a = static_cast<std::size_t>(i);
    Block d = symmetric_part(k.diagonal[a]);
    d.diagonal() += shift * mass.segment<6>(6 * static_cast<Eigen::Index>(i));
    const Eigen::Matrix<double, m, 6> z = motion_[a].transpose();
    add(section(i), section(i), z * (d * motion_[a]));
    for (int at = k.begin[a]; at < k.begin[a + 1]; ++at) {
      const int j = k.column[static_cast<std::size_t>(at)];
      const Small b = z * (k.block[static_cast<std::size_t>(at)] * motion_[static_cast<std::size_t>(j)]);
      if (section(i) == section(j)) {
        add(section(i), section(i), b + b.transpose());
      } else if (section(i) > section(j)) {
        add(section(i), section(j), b);
      } else {
        add(section(j), section(i), b.transpose());
      }
    }
  }
  const double largest = band_.row(0).maxCoeff();
  int turned = 0;
  for (int j = 0; j < n; ++j) {
    double d = band_(0, j);
    if (d < -1e-12 * largest) ++turned;
    if (!(d > 1e-12 * largest)) d = std::max(std::fabs(d), 1e-6 * largest);
    const double root = std::sqrt(d);
    band_(0, j) = root;
    const int most = std::min(width - 1, n - 1 - j);
    for (int r = 1; r <= most; ++r) band_(r, j) /= root;
    for (int c = 1; c <= most; ++c)
      if (const double v = band_(c, j); v != 0)
        for (int r = c; r <= most; ++r) band_(r - c, j + c) -= band_(r, j) * v;
  }
  return turned;
}

void Preconditioner::add_sections(const VectorXd& r, VectorXd& z) const {
  const auto n = static_cast<int>(band_.cols()), width = static_cast<int>(band_.rows());
  VectorXd b = VectorXd::Zero(n);
  for (std::size_t i = 0; i < motion_.size(); ++i)
    b.segment<motions>(motions * sections_.part[i]).noalias() +=
        motion_[i].transpose() * r.segment<6>(6 * static_cast<Eigen::Index>(i));
  for (int j = 0; j < n; ++j) {
    b[j] /= band_(0, j);
    for (int q = 1; q <= std::min(width - 1, n - 1 - j); ++q) b[j + q] -= band_(q, j) * b[j];
  }
  for (int j = n - 1; j >= 0; --j) {
    double sum = b[j];
    for (int q = 1; q <= std::min(width - 1, n - 1 - j); ++q) sum -= band_(q, j) * b[j + q];
    b[j] = sum / band_(0, j);
  }
  for (std::size_t i = 0; i < motion_.size(); ++i)
    z.segment<6>(6 * static_cast<Eigen::Index>(i)).noalias() +=
        motion_[i] * b.segment<motions>(motions * sections_.part[i]);
}

void Preconditioner::solve(const VectorXd& r, VectorXd& z) const {
  z = r;
  for (int t = 0; t < topology_.tubes(); ++t)
    solve_chain(topology_.tube_begin[t], topology_.tube_begin[t + 1], lower_[0].data(), inverse_[0].data(),
                z.data());
  if (sections_.count > 0) add_sections(r, z);
}

Solution conjugate_gradients(const Operator& a, const Precondition& m, const VectorXd& b, double tolerance,
                             int most, VectorXd& x) {
  Solution out;
  x = VectorXd::Zero(b.size());
  VectorXd r = b, z, p, q;
  m(r, z);
  p = z;
  double rz = r.dot(z);
  const double first = rz;
  if (!(first > 0)) return out;
  while (out.iterations < most) {
    a(p, q);
    ++out.iterations;
    const double curvature = p.dot(q);
    if (!(curvature > 0)) {
      out.falls = true;
      out.motion = p;
      return out;
    }
    const double by = rz / curvature;
    x += by * p;
    r -= by * q;
    m(r, z);
    const double next = r.dot(z);
    out.residual = std::sqrt(std::fabs(next / first));
    if (out.residual < tolerance) break;
    p = z + (next / rz) * p;
    rz = next;
  }
  return out;
}

// Arnoldi's vectors are orthonormal in the norm of the approximate inverse M, v_i' M v_j. What is left is then
// measured as conjugate gradients do, and not by the forces of the stiffest motions.
Solution gmres(const Operator& a, const Precondition& m, const VectorXd& b, double tolerance, int most, VectorXd& x) {
  constexpr int most_vectors = 80;  // after which it begins again
  Solution out;
  x = VectorXd::Zero(b.size());
  VectorXd r = b, z, w;
  m(r, z);
  const double norm = std::sqrt(r.dot(z));
  if (!(norm > 0)) return out;
  out.residual = 1;
  while (out.iterations < most && out.residual >= tolerance) {
    const double size = std::sqrt(std::fabs(r.dot(z)));
    std::vector<VectorXd> forces{r / size}, moves{z / size};
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most_vectors + 1, most_vectors);
    VectorXd left = VectorXd::Zero(most_vectors + 1);
    left[0] = size;
    std::vector<Eigen::JacobiRotation<double>> turns;
    int k = 0;
    for (bool done = false; !done && k < most_vectors && out.iterations < most; ++k) {
      a(moves.back(), w);
      ++out.iterations;
      for (int pass = 0; pass < 2; ++pass)
        for (int i = 0; i <= k; ++i) {
          const double part = moves[static_cast<std::size_t>(i)].dot(w);
          h(i, k) += part;
          w -= part * forces[static_cast<std::size_t>(i)];
        }
      m(w, z);
      const double next = std::sqrt(std::max(0.0, w.dot(z)));
      h(k + 1, k) = next;
      for (int i = 0; i < k; ++i)
        h.col(k).applyOnTheLeft(i, i + 1, turns[static_cast<std::size_t>(i)].adjoint());
      turns.emplace_back();
      turns.back().makeGivens(h(k, k), h(k + 1, k));
      h.col(k).applyOnTheLeft(k, k + 1, turns.back().adjoint());
      left.applyOnTheLeft(k, k + 1, turns.back().adjoint());
      out.residual = std::fabs(left[k + 1]) / norm;
      done = out.residual < tolerance || !(next > 0);
      if (done) continue;
      forces.push_back(w / next);
      moves.push_back(z / next);
    }
    const VectorXd parts = h.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(left.head(k));
    for (int i = 0; i < k; ++i) x += parts[i] * moves[static_cast<std::size_t>(i)];
    if (!std::isfinite(out.residual) || !x.allFinite()) break;
    a(x, w);
    r = b - w;
    m(r, z);
  }
  out.falls = !(b.dot(x) > 0);
  return out;
}

}  // namespace ropewalk
