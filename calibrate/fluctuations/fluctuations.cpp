#include "fluctuations/fluctuations.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ropewalk::calibrate {
namespace {

constexpr int windows_tried[] = {1, 2, 4, 8};
constexpr long fewest_blocks = 16;

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

Row mean_of(const std::vector<Row>& rows, std::size_t from, std::size_t to) {
  Row out(rows.front().size(), Moments{});
  for (std::size_t f = from; f < to; ++f)
    for (std::size_t w = 0; w < out.size(); ++w)
      for (std::size_t k = 0; k < moments; ++k) out[w][k] += rows[f][w][k] / static_cast<double>(to - from);
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
  if (frames_ < fewest_blocks) throw std::invalid_argument("fewer than 16 frames");
  if (longest < 2) throw std::invalid_argument("no chain has two bonds");
  const auto per_frame = static_cast<std::size_t>(out.bonds);
  const double kT = units::boltzmann * temperature;

  BondMotion mean{};
  for (const BondMotion& m : motions_)
    for (std::size_t k = 0; k < 6; ++k) mean[k] += m[k] / static_cast<double>(motions_.size());
  // Windows that fit at least twice into the longest chain.
  std::vector<int> windows;
  for (const int w : windows_tried)
    if (w == 1 || 2 * w <= longest) windows.push_back(w);

  std::vector<Row> rows;
  for (long f = 0; f < frames_; ++f) {
    Row row(windows.size(), Moments{});
    for (std::size_t n = 0; n < windows.size(); ++n) {
      const int w = windows[n];
      double count = 0;
      std::size_t begin = static_cast<std::size_t>(f) * per_frame;
      for (const int bonds : bonds_) {
        for (int b = 0; b + w <= bonds; ++b, ++count) {
          double s = -w * mean[2], x = -w * mean[3], y = -w * mean[4], t = -w * mean[5];
          for (int k = 0; k < w; ++k) {
            const BondMotion& m = motions_[begin + static_cast<std::size_t>(b + k)];
            s += m[2];
            x += m[3];
            y += m[4];
            t += m[5];
          }
          row[n][ss] += s * s;
          row[n][tt] += t * t;
          row[n][st] += s * t;
          row[n][xx] += x * x;
          row[n][yy] += y * y;
        }
        begin += static_cast<std::size_t>(bonds);
      }
      for (double& moment : row[n]) moment /= count;
    }
    rows.push_back(row);
  }

  const Row all = mean_of(rows, 0, rows.size());
  const std::vector<Numbers> found = all_of(all, windows, element_length_, kT);
  std::vector<Numbers> error(found.size(), Numbers{});
  for (long size = 1; frames_ / size >= fewest_blocks; size *= 2) {
    const long blocks = frames_ / size;
    std::vector<Numbers> sum(found.size(), Numbers{}), square = sum;
    const Row kept = mean_of(rows, 0, static_cast<std::size_t>(blocks * size));
    for (long b = 0; b < blocks; ++b) {
      const Row block = mean_of(rows, static_cast<std::size_t>(b * size), static_cast<std::size_t>((b + 1) * size));
      Row without = kept;
      for (std::size_t w = 0; w < without.size(); ++w)
        for (std::size_t k = 0; k < moments; ++k)
          without[w][k] += (kept[w][k] - block[w][k]) / static_cast<double>(blocks - 1);
      const std::vector<Numbers> left = all_of(without, windows, element_length_, kT);
      for (std::size_t n = 0; n < left.size(); ++n) {
        const auto add = [&](double Numbers::*which) {
          sum[n].*which += left[n].*which;
          square[n].*which += left[n].*which * left[n].*which;
        };
        for (double Numbers::*which :
             {&Numbers::EA, &Numbers::EI_x, &Numbers::EI_y, &Numbers::GJ, &Numbers::coupling})
          add(which);
      }
    }
    const auto n_blocks = static_cast<double>(blocks);
    for (std::size_t n = 0; n < error.size(); ++n)
      for (double Numbers::*which :
           {&Numbers::EA, &Numbers::EI_x, &Numbers::EI_y, &Numbers::GJ, &Numbers::coupling}) {
        const double spread = square[n].*which / n_blocks - std::pow(sum[n].*which / n_blocks, 2);
        error[n].*which = std::max(error[n].*which, std::sqrt(std::max(0.0, (n_blocks - 1) * spread)));
      }
  }
  for (std::size_t n = 0; n < found.size(); ++n) {
    RodStiffness k;
    k.window = n < windows.size() ? windows[n] : 0;
    k.EA = {found[n].EA, error[n].EA};
    k.EI_x = {found[n].EI_x, error[n].EI_x};
    k.EI_y = {found[n].EI_y, error[n].EI_y};
    k.GJ = {found[n].GJ, error[n].GJ};
    k.coupling = {found[n].coupling, error[n].coupling};
    if (n < windows.size())
      out.windows.push_back(k);
    else
      out.rod = k;
  }
  out.local = true;
  for (const RodStiffness& k : out.windows) {
    const auto agree = [](const Measured& x, const Measured& y) {
      return std::fabs(x.value - y.value) < 3 * std::hypot(x.standard_error, y.standard_error);
    };
    out.local = out.local && agree(k.EA, out.rod.EA) && agree(k.EI_x, out.rod.EI_x) &&
                agree(k.EI_y, out.rod.EI_y) && agree(k.GJ, out.rod.GJ);
  }
  // The covariance of the means of both halves of the time is free of noise, which they do not share.
  const auto half = static_cast<std::size_t>(frames_ / 2);
  for (std::size_t k = 3; k < 6; ++k) {
    double kept = 0, whole = 0;
    for (std::size_t b = 0; b < per_frame; ++b) {
      double one = 0, two = 0;
      for (std::size_t f = 0; f < 2 * half; ++f) {
        const double x = motions_[f * per_frame + b][k] - mean[k];
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
