#include "scene/packing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace ropewalk {
namespace {

constexpr double most_overlap = 1e-3;  // nm
constexpr double skin = 0.3;           // relative to the largest distance: margin of the list of pairs

class Drawing {
 public:
  Drawing(std::vector<Disc>& discs, const std::vector<std::vector<double>>& apart)
      : discs_(discs), apart_(apart), velocity_(discs.size()), force_(discs.size()) {
    for (const auto& row : apart)
      for (const double d : row) largest_ = std::max(largest_, d);
    for (const Disc& d : discs) radius_ = std::max(radius_, std::hypot(d.x, d.y));
    radius_ = std::max(radius_, largest_);
  }

  // `press`: the overlap that the pull makes in the middle, about, over the largest distance; 0: until none is
  // left.
  void rest(double press) {
    const double pull = press * largest_ * largest_ / radius_;  // at the rim
    constexpr int most_steps = 3000, settled = 5;
    constexpr double first_step = 0.1, longest_step = 0.5, first_mix = 0.1;
    std::fill(velocity_.begin(), velocity_.end(), Vector{});
    double step = first_step, mix = first_mix;
    int downhill = 0;
    for (int k = 0; k < most_steps; ++k) {
      const double largest = forces(pull);
      if (pull > 0 ? largest < 0.05 * pull : overlap_ < 0.5 * most_overlap) return;
      double power = 0, speed2 = 0, force2 = 0;
      for (std::size_t i = 0; i < discs_.size(); ++i) {
        power += dot(force_[i], velocity_[i]);
        speed2 += dot(velocity_[i], velocity_[i]);
        force2 += dot(force_[i], force_[i]);
      }
      if (power < 0) {
        std::fill(velocity_.begin(), velocity_.end(), Vector{});
        step *= 0.5;
        mix = first_mix;
        downhill = 0;
      } else {
        const double along = force2 > 0 ? mix * std::sqrt(speed2 / force2) : 0;
        for (std::size_t i = 0; i < discs_.size(); ++i)
          velocity_[i] = {(1 - mix) * velocity_[i].x + along * force_[i].x,
                          (1 - mix) * velocity_[i].y + along * force_[i].y};
        if (++downhill > settled) step = std::min(1.1 * step, longest_step), mix *= 0.99;
      }
      double fastest2 = 0;
      for (std::size_t i = 0; i < discs_.size(); ++i) {
        velocity_[i].x += step * force_[i].x;
        velocity_[i].y += step * force_[i].y;
        fastest2 = std::max(fastest2, dot(velocity_[i], velocity_[i]));
      }
      const double furthest = step * std::sqrt(fastest2);
      // No disc jumps over another.
      const double part = std::min(1.0, 0.1 * largest_ / std::max(furthest, 1e-300));
      for (std::size_t i = 0; i < discs_.size(); ++i) {
        discs_[i].x += part * step * velocity_[i].x;
        discs_[i].y += part * step * velocity_[i].y;
      }
      moved_ += part * furthest;
    }
  }

 private:
  struct Vector {
    double x = 0, y = 0;
  };
  static double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y; }

  void list_pairs() {
    pairs_.clear();
    moved_ = 0;
    const double width = (1 + skin) * largest_;
    const auto cell = [&](double at) { return static_cast<std::int64_t>(std::floor(at / width)); };
    const auto key = [](std::int64_t column, std::int64_t row) { return column * 4294967296 + row; };
    std::unordered_map<std::int64_t, std::vector<int>> cells;
    for (std::size_t i = 0; i < discs_.size(); ++i) {
      const std::int64_t column = cell(discs_[i].x), row = cell(discs_[i].y);
      for (std::int64_t c = column - 1; c <= column + 1; ++c)
        for (std::int64_t r = row - 1; r <= row + 1; ++r) {
          const auto there = cells.find(key(c, r));
          if (there == cells.end()) continue;
          for (const int j : there->second) {
            const Disc& other = discs_[static_cast<std::size_t>(j)];
            const double dx = discs_[i].x - other.x, dy = discs_[i].y - other.y;
            if (dx * dx + dy * dy < width * width) pairs_.emplace_back(static_cast<int>(i), j);
          }
        }
      cells[key(column, row)].push_back(static_cast<int>(i));
    }
  }

  // The largest force; the push of an overlap is as large as it, in nm.
  double forces(double pull) {
    if (pairs_.empty() || 2 * moved_ > skin * largest_) list_pairs();
    for (std::size_t i = 0; i < discs_.size(); ++i)
      force_[i] = {-pull * discs_[i].x / radius_, -pull * discs_[i].y / radius_};
    overlap_ = 0;
    for (const auto& [i, j] : pairs_) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const double dx = discs_[a].x - discs_[b].x, dy = discs_[a].y - discs_[b].y;
      const double rest =
          apart_[static_cast<std::size_t>(discs_[a].type)][static_cast<std::size_t>(discs_[b].type)];
      const double d2 = dx * dx + dy * dy;
      if (d2 >= rest * rest) continue;
      const double d = std::sqrt(d2), push = rest - d;
      overlap_ = std::max(overlap_, push);
      const double x = d > 0 ? push * dx / d : push, y = d > 0 ? push * dy / d : 0;
      force_[a].x += x, force_[a].y += y;
      force_[b].x -= x, force_[b].y -= y;
    }
    double largest = 0;
    for (const Vector& f : force_) largest = std::max(largest, dot(f, f));
    return std::sqrt(largest);
  }

  std::vector<Disc>& discs_;
  const std::vector<std::vector<double>>& apart_;
  std::vector<Vector> velocity_, force_;
  std::vector<std::pair<int, int>> pairs_;
  double largest_ = 0, radius_ = 0, moved_ = 0, overlap_ = 0;
};

}  // namespace

void draw_together(std::vector<Disc>& discs, const std::vector<std::vector<double>>& apart) {
  Drawing drawing(discs, apart);
  for (const double pull : {0.1, 0.01}) drawing.rest(pull);
  drawing.rest(0);
  double x = 0, y = 0;
  for (const Disc& d : discs) x += d.x, y += d.y;
  for (Disc& d : discs) {
    d.x -= x / static_cast<double>(discs.size());
    d.y -= y / static_cast<double>(discs.size());
  }
}

}  // namespace ropewalk
