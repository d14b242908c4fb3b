#include "fluctuations/fluctuations.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "observe/time_mean.hpp"

namespace ropewalk::calibrate {
namespace {

constexpr int windows_tried[] = {1, 2, 4, 8};
constexpr long blocks = 16;  // number of blocks from which the variance of a mean is taken

// Variances and the covariance of stretch and twist.
enum Moment { ss, tt, st, xx, yy, moments };
using Moments = std::array<double, moments>;
// The same over all windows, side by side.
using Row = std::vector<Moments>;

struct Numbers {
  double EA, EI_x, EI_y, GJ, coupling;
};

// The stiffnesses of a rod whose variances are these moments over a length (nm).
Numbers stiffness_of(const Moments& m, double length, double kT) {
  Eigen::Matrix2d c;
  c << m[ss], m[st], m[st], m[tt];
  const Eigen::Matrix2d k = kT * length * c.inverse();
  return {k(0, 0), kT * length / m[xx], kT * length / m[yy], k(1, 1), k(0, 1)};
}

// All stiffnesses of a row: those of each window, and last those from the difference of the outermost windows.
std::vector<Numbers> all_of(const Row& row, const std::vector<int>& windows, double a, double kT) {
  std::vector<Numbers> out;
  for (std::size_t w = 0; w < windows.size(); ++w) out.push_back(stiffness_of(row[w], windows[w] * a, kT));
  Moments grown = row.back();
  if (windows.size() > 1)
    for (int k = 0; k < moments; ++k)
      grown[static_cast<std::size_t>(k)] -= row.front()[static_cast<std::size_t>(k)];
  out.push_back(
      stiffness_of(grown, (windows.size() > 1 ? windows.back() - windows.front() : windows.back()) * a, kT));
  return out;
}

// Means over all windows of each length of the products of a window's stretch, bends and twist.
Row products(const std::vector<BondMotion>& moved, const std::vector<int>& bonds_of_chains,
             const std::vector<int>& windows) {
  Row row(windows.size(), Moments{});
  for (std::size_t n = 0; n < windows.size(); ++n) {
    const int w = windows[n];
    double count = 0;
    auto chain = moved.begin();
    for (const int bonds : bonds_of_chains) {
      for (int b = 0; b + w <= bonds; ++b, ++count) {
        double s = 0, x = 0, y = 0, t = 0;
        for (auto m = chain + b; m != chain + b + w; ++m) {
          s += (*m)[2];
          x += (*m)[3];
          y += (*m)[4];
          t += (*m)[5];
        }
        row[n][ss] += s * s;
        row[n][tt] += t * t;
        row[n][st] += s * t;
        row[n][xx] += x * x;
        row[n][yy] += y * y;
      }
      chain += bonds;
    }
    for (double& moment : row[n]) moment /= count;
  }
  return row;
}

Row mean_of(const std::vector<Row>& rows) {
  Row out(rows.front().size(), Moments{});
  for (const Row& row : rows)
    for (std::size_t w = 0; w < out.size(); ++w)
      for (std::size_t k = 0; k < moments; ++k) out[w][k] += row[w][k] / static_cast<double>(rows.size());
  return out;
}

}  // namespace

BondMotion bond_motion(const State& state, std::size_t i) {
  const Quaternion a = state.orientation[i];
  Quaternion by = a.conjugate() * state.orientation[i + 1];
  if (by.w() < 0) by.coeffs() = -by.coeffs();
  const Eigen::AngleAxisd turn(by);
  const Vector3 v = turn.angle() * turn.axis();
  const Quaternion middle = a * Quaternion(Eigen::AngleAxisd(0.5 * turn.angle(), turn.axis()));
  const Vector3 d = middle.conjugate() * Vector3(state.position[i + 1] - state.position[i]);
  return {d.x(), d.y(), d.z(), v.x(), v.y(), v.z()};
}

void FluctuationSums::add_chain(const State& state, std::size_t first, int elements) {
  if (frames_ == 0) bonds_.push_back(elements - 1);
  for (int b = 0; b + 1 < elements; ++b)
    motions_.push_back(bond_motion(state, first + static_cast<std::size_t>(b)));
}

Fluctuation FluctuationSums::evaluate(double temperature) const {
  Fluctuation out;
  out.frames = frames_;
  int longest = 0;
  for (const int bonds : bonds_) {
    longest = std::max(longest, bonds);
    out.bonds += bonds;
  }
  if (static_cast<double>(frames_) < least_independent) throw std::invalid_argument("fewer than 30 frames");
  if (longest < 2) throw std::invalid_argument("no chain has two bonds");
  const auto per_frame = static_cast<std::size_t>(out.bonds);
  const double kT = units::boltzmann * temperature;

  // A bond's own mean: bonds near free ends, and those of a tube that is bent at rest, are unlike others.
  std::vector<BondMotion> mean(per_frame, BondMotion{});
  for (std::size_t m = 0; m < motions_.size(); ++m)
    for (std::size_t k = 0; k < 6; ++k) mean[m % per_frame][k] += motions_[m][k] / static_cast<double>(frames_);
  // Windows that fit at least twice into the longest chain.
  std::vector<int> windows;
  for (const int w : windows_tried)
    if (w == 1 || 2 * w <= longest) windows.push_back(w);

  std::vector<Row> rows;
  std::vector<BondMotion> moved(per_frame);
  for (std::size_t f = 0; f < static_cast<std::size_t>(frames_); ++f) {
    for (std::size_t b = 0; b < per_frame; ++b)
      for (std::size_t k = 0; k < 6; ++k) moved[b][k] = motions_[f * per_frame + b][k] - mean[b][k];
    rows.push_back(products(moved, bonds_, windows));
  }
  // A mean over the time moves as well: what that takes off the variances, by the means of sixteenths of the time.
  Row of_means(windows.size(), Moments{});
  const auto block = static_cast<std::size_t>(frames_ / blocks);
  for (std::size_t f = 0; f < block * blocks; f += block) {
    for (std::size_t b = 0; b < per_frame; ++b)
      for (std::size_t k = 0; k < 6; ++k) {
        moved[b][k] = -mean[b][k];
        for (std::size_t g = f; g < f + block; ++g)
          moved[b][k] += motions_[g * per_frame + b][k] / static_cast<double>(block);
      }
    const Row of_block = products(moved, bonds_, windows);
    for (std::size_t w = 0; w < windows.size(); ++w)
      for (std::size_t k = 0; k < moments; ++k) of_means[w][k] += of_block[w][k] / blocks;
  }
  for (Row& row : rows)
    for (std::size_t w = 0; w < windows.size(); ++w)
      for (std::size_t k = 0; k < moments; ++k) row[w][k] += of_means[w][k] / (blocks - 1);

  const Row all = mean_of(rows);
  const std::vector<Numbers> found = all_of(all, windows, element_length_, kT);
  // Contribution of each frame to each number, found by leaving the frame out.
  std::vector<std::vector<Numbers>> without;
  const auto n = static_cast<double>(frames_);
  for (const Row& row : rows) {
    Row left = all;
    for (std::size_t w = 0; w < left.size(); ++w)
      for (std::size_t k = 0; k < moments; ++k) left[w][k] += (all[w][k] - row[w][k]) / (n - 1);
    without.push_back(all_of(left, windows, element_length_, kT));
  }
  std::vector<double> parts(rows.size());
  const auto measured = [&](std::size_t window, double Numbers::*which) {
    for (std::size_t f = 0; f < rows.size(); ++f)
      parts[f] = found[window].*which + (n - 1) * (found[window].*which - without[f][window].*which);
    const TimeMean mean = time_mean(parts);
    out.frames_needed = std::max(out.frames_needed, mean.rows_needed);
    return Measured{found[window].*which, mean.error};
  };
  for (std::size_t w = 0; w < found.size(); ++w) {
    const RodStiffness k{w < windows.size() ? windows[w] : 0, measured(w, &Numbers::EA),
                         measured(w, &Numbers::EI_x),         measured(w, &Numbers::EI_y),
                         measured(w, &Numbers::GJ),           measured(w, &Numbers::coupling)};
    if (w < windows.size())
      out.windows.push_back(k);
    else
      out.rod = k;
  }
  out.local = true;
  for (const RodStiffness& k : out.windows) {
    const auto agree = [](const Measured& x, const Measured& y) {
      return !(std::fabs(x.value - y.value) > 3 * std::hypot(x.standard_error, y.standard_error));
    };
    out.local = out.local && agree(k.EA, out.rod.EA) && agree(k.EI_x, out.rod.EI_x) &&
                agree(k.EI_y, out.rod.EI_y) && agree(k.GJ, out.rod.GJ);
  }
  // How far bonds lie apart at rest: the covariance of the means of both halves of the time is free of noise, which
  // they do not share.
  const auto half = static_cast<std::size_t>(frames_ / 2);
  for (std::size_t k = 3; k < 6; ++k) {
    double common = 0, kept = 0, whole = 0;
    for (const BondMotion& m : mean) common += m[k] / static_cast<double>(per_frame);
    for (std::size_t b = 0; b < per_frame; ++b) {
      double one = 0, two = 0;
      for (std::size_t f = 0; f < 2 * half; ++f) {
        const double x = motions_[f * per_frame + b][k] - common;
        (f < half ? one : two) += x / static_cast<double>(half);
        whole += x * x / static_cast<double>(2 * half);
      }
      kept += one * two;
    }
    if (whole > 0) out.static_part = std::max(out.static_part, kept / whole);
  }
  return out;
}

}  // namespace ropewalk::calibrate
