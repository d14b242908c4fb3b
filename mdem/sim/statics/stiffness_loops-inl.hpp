// Compiled for each vector unit, see sim/threads/vector_unit.hpp.
namespace ropewalk {
namespace ROPEWALK_UNIT {
namespace {

void add_block_product(int rows, const int* begin, const int* column, const double* block, const double* diagonal,
                       const double* x, double* y) {
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    const double *d = diagonal + 36 * i, *xi = x + 6 * i;
    double sum[6] = {};
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r) sum[r] += d[6 * c + r] * xi[c];
    for (std::ptrdiff_t k = begin[i]; k < begin[i + 1]; ++k) {
      const double *b = block + 36 * k, *xj = x + 6 * static_cast<std::ptrdiff_t>(column[k]);
      double* yj = y + 6 * static_cast<std::ptrdiff_t>(column[k]);
      for (int c = 0; c < 6; ++c) {
        double back = 0;
        for (int r = 0; r < 6; ++r) {
          sum[r] += b[6 * c + r] * xj[c];
          back += b[6 * c + r] * xi[r];
        }
        yj[c] += back;
      }
    }
    for (int r = 0; r < 6; ++r) y[6 * i + r] += sum[r];
  }
}

void solve_chain(int from, int to, const double* lower, const double* inverse, double* z) {
  for (std::ptrdiff_t i = from + 1; i < to; ++i) {
    const double* l = lower + 36 * i;
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r) z[6 * i + r] -= l[6 * c + r] * z[6 * (i - 1) + c];
  }
  for (std::ptrdiff_t i = to - 1; i >= from; --i) {
    double v[6] = {};
    for (int c = 0; c < 6; ++c)
      for (int r = 0; r < 6; ++r) v[r] += inverse[36 * i + 6 * c + r] * z[6 * i + c];
    if (i + 1 < to) {
      const double *l = lower + 36 * (i + 1), *next = z + 6 * (i + 1);
      for (int c = 0; c < 6; ++c) {
        double sum = 0;
        for (int r = 0; r < 6; ++r) sum += l[6 * c + r] * next[r];
        v[c] -= sum;
      }
    }
    for (int r = 0; r < 6; ++r) z[6 * i + r] = v[r];
  }
}

// g = u'/rho and h = (dg/drho)/rho of all pairs of nodes, times their weights: with the polynomial P(y) = du/dy of
// the table, g = 2 P/delta and h = 4 P'/delta^2.
void node_stiffness(const LineNodePairs& p, LineScratch& scratch) {
  constexpr int left = FullTable::mantissa_left;
  const double scale = p.table.scale, shift = p.table.shift, cutoff2 = p.cutoff2, core2 = p.core2;
  const double *r2 = scratch.r2.data(), *weight = p.weight.data();
  double *g = scratch.g.data(), *h = scratch.h.data();
  const auto& d = p.table.d;
#pragma omp simd
  for (int m = 0; m < p.lanes; ++m) {
    const double in = r2[m] < cutoff2 ? weight[m] : 0;
    double at = r2[m] < cutoff2 ? r2[m] : core2;
    at = at > core2 ? at : core2;
    const double y = scale * at + shift;
    const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, y);
    const double start = __builtin_bit_cast(double, static_cast<std::uint64_t>(bits >> left << left));
    const auto k = (bits >> left) % FullTable::segments;
    const double t = y - start;
    double value = d[FullTable::degree - 1][k], slope = 0;
    for (int n = FullTable::degree - 2; n >= 0; --n) {
      slope = slope * t + value;
      value = value * t + d[n][k];
    }
    g[m] = in * 2 * scale * value;
    h[m] = in * 4 * scale * scale * slope;
  }
}

// Nearer than the core, by the parabola of the law.
void core_stiffness(const LineNodePairs& p, LineScratch& scratch) {
  for (int m = 0; m < p.lanes; ++m) {
    const auto lane = static_cast<std::size_t>(m);
    const double r2 = scratch.r2[lane];
    if (!(r2 < p.core2)) continue;
    const double rho = std::sqrt(std::max(r2, 1e-12)), e = rho - p.table.contact - p.table.core;
    const double first = p.table.v1 + e * p.table.v2, g = first / rho;
    scratch.g[lane] = p.weight[lane] * g;
    scratch.h[lane] = p.weight[lane] * (p.table.v2 - g) / (rho * rho);
  }
}

struct Matrix33 {
  double v[3][3] = {};
};
__attribute__((always_inline)) inline Matrix33 cross_matrix(const double* n) {
  return {{{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}}};
}
__attribute__((always_inline)) inline Matrix33 product(const Matrix33& a, const Matrix33& b) {
  Matrix33 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out.v[r][c] = a.v[r][0] * b.v[0][c] + a.v[r][1] * b.v[1][c] + a.v[r][2] * b.v[2][c];
  return out;
}
__attribute__((always_inline)) inline Matrix33 transposed(const Matrix33& a) {
  Matrix33 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out.v[r][c] = a.v[c][r];
  return out;
}
// half (a n' + n a') - (a.n) 1: the second-order part of turns n in the force a.
__attribute__((always_inline)) inline Matrix33 by_turns(const double* a, const double* n) {
  const double dot = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
  Matrix33 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out.v[r][c] = 0.5 * (a[r] * n[c] + n[r] * a[c]) - (r == c ? dot : 0);
  return out;
}
__attribute__((always_inline)) inline void add_part(const Matrix33& a, double sign, int row, int column,
                                                    double* block) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) block[6 * (column + c) + row + r] += sign * a.v[r][c];
}

// With d = s + l n_j - k n_i and the moments H(a,b) = sum k^a l^b h, G(a,b) likewise, each sum of k^a l^b (h d d' +
// g) is one of outer products of s, n_i and n_j.
bool add_line_stiffness(const LineNodePairs& p, const double* s, const double* n_i, const double* n_j,
                        LineScratch& scratch, double* k_ii, double* k_jj, double* k_ij) {
  const double *k = p.k.data(), *l = p.l.data();
  double* r2 = scratch.r2.data();
  double nearest = 1e30;
  // |s + l n_j - k n_i|^2
  const double ss = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
  const double sj = 2 * (s[0] * n_j[0] + s[1] * n_j[1] + s[2] * n_j[2]);
  const double si = -2 * (s[0] * n_i[0] + s[1] * n_i[1] + s[2] * n_i[2]);
  const double ij = -2 * (n_i[0] * n_j[0] + n_i[1] * n_j[1] + n_i[2] * n_j[2]);
#pragma omp simd reduction(min : nearest)
  for (int m = 0; m < p.lanes; ++m) {
    r2[m] = ss + l[m] * (l[m] + sj + k[m] * ij) + k[m] * (k[m] + si);
    nearest = r2[m] < nearest ? r2[m] : nearest;
  }
  if (!(nearest < p.cutoff2)) return false;
  node_stiffness(p, scratch);
  if (nearest < p.core2) core_stiffness(p, scratch);
  const double *g = scratch.g.data(), *h = scratch.h.data();
  double H[LineNodePairs::powers], G[6];
  for (int q = 0; q < LineNodePairs::powers; ++q) {
    const double* power = p.power[static_cast<std::size_t>(q)].data();
    double sum = 0;
    for (int m = 0; m < p.lanes; ++m) sum += power[m] * h[m];
    H[q] = sum;
  }
  for (int q = 0; q < 6; ++q) {
    const double* power = p.power[static_cast<std::size_t>(q)].data();
    double sum = 0;
    for (int m = 0; m < p.lanes; ++m) sum += power[m] * g[m];
    G[q] = sum;
  }
  // Index of k^a l^b.
  const auto at = [](int a, int b) { return (a + b) * (a + b + 1) / 2 + b; };
  const double w[3] = {-n_i[0], -n_i[1], -n_i[2]};
  const auto sum_of = [&](int a, int b) {
    const double h00 = H[at(a, b)], h01 = H[at(a, b + 1)], h10 = H[at(a + 1, b)], h02 = H[at(a, b + 2)],
                 h11 = H[at(a + 1, b + 1)], h20 = H[at(a + 2, b)];
    Matrix33 out;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        out.v[r][c] = h00 * s[r] * s[c] + h01 * (s[r] * n_j[c] + n_j[r] * s[c]) +
                      h10 * (s[r] * w[c] + w[r] * s[c]) + h02 * n_j[r] * n_j[c] +
                      h11 * (n_j[r] * w[c] + w[r] * n_j[c]) + h20 * w[r] * w[c] + (r == c ? G[at(a, b)] : 0);
    return out;
  };
  const Matrix33 A = sum_of(0, 0), A_k = sum_of(1, 0), A_l = sum_of(0, 1), A_kk = sum_of(2, 0), A_kl = sum_of(1, 1),
                 A_ll = sum_of(0, 2);
  double G_k[3], G_l[3];
  for (int r = 0; r < 3; ++r) {
    G_k[r] = G[at(1, 0)] * s[r] + G[at(1, 1)] * n_j[r] + G[at(2, 0)] * w[r];
    G_l[r] = G[at(0, 1)] * s[r] + G[at(0, 2)] * n_j[r] + G[at(1, 1)] * w[r];
  }
  // d = s + k N_i phi_i - l N_j phi_j to first order, N v = n x v.
  const Matrix33 N_i = cross_matrix(n_i), N_j = cross_matrix(n_j), T_i = transposed(N_i), T_j = transposed(N_j);
  const Matrix33 ik = product(A_k, N_i), jl = product(A_l, N_j), ki = product(T_i, A_k);
  add_part(A, 1, 0, 0, k_ii);
  add_part(ik, -1, 0, 3, k_ii);
  add_part(transposed(ik), -1, 3, 0, k_ii);
  add_part(product(product(T_i, A_kk), N_i), 1, 3, 3, k_ii);
  add_part(by_turns(G_k, n_i), -1, 3, 3, k_ii);
  add_part(A, 1, 0, 0, k_jj);
  add_part(jl, -1, 0, 3, k_jj);
  add_part(transposed(jl), -1, 3, 0, k_jj);
  add_part(product(product(T_j, A_ll), N_j), 1, 3, 3, k_jj);
  add_part(by_turns(G_l, n_j), 1, 3, 3, k_jj);
  for (int q = 0; q < 36; ++q) k_ij[q] = 0;
  add_part(A, -1, 0, 0, k_ij);
  add_part(jl, 1, 0, 3, k_ij);
  add_part(ki, 1, 3, 0, k_ij);
  add_part(product(product(T_i, A_kl), N_j), -1, 3, 3, k_ij);
  return true;
}

}  // namespace
}  // namespace ROPEWALK_UNIT
}  // namespace ropewalk
