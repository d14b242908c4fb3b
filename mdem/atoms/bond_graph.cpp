#include "atoms/bond_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "model/error.hpp"

namespace ropewalk {
namespace {

// Cells of at least the cutoff, of the box or of the box around all atoms.
class Cells {
 public:
  Cells(const std::vector<Vector3>& positions, const std::vector<char>& wanted, const AtomBox& box, double bond) {
    Vector3 low = Vector3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    inverse_ = box.inverse();
    origin_ = box.origin;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!wanted[i]) continue;
      const Vector3 part = inverse_ * (positions[i] - origin_);
      low = low.cwiseMin(part);
      high = high.cwiseMax(part);
    }
    long room = static_cast<long>(positions.size()) + 1;
    for (int k = 0; k < 3; ++k) {
      periodic_[k] = box.periodic[static_cast<std::size_t>(k)];
      low_[k] = periodic_[k] ? 0 : low[k];
      span_[k] = periodic_[k] ? 1 : std::max(high[k] - low[k], 1e-9);
      const double width = box.width(k) * span_[k];
      number_[k] = static_cast<long>(std::clamp(std::floor(width / bond), 1.0, 4096.0));
    }
    // No more cells than a few for each atom.
    while (number_[0] * number_[1] * number_[2] > 4 * room) {
      const auto most = std::max_element(number_, number_ + 3);
      *most = (*most + 1) / 2;
    }
    const auto cells = static_cast<std::size_t>(number_[0] * number_[1] * number_[2]);
    begin_.assign(cells + 1, 0);
    std::vector<std::uint32_t> cell(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!wanted[i]) continue;
      long at[3];
      place(positions[i], at);
      cell[i] = static_cast<std::uint32_t>(index(at));
      ++begin_[cell[i] + 1];
    }
    for (std::size_t c = 1; c <= cells; ++c) begin_[c] += begin_[c - 1];
    atoms_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (wanted[i]) atoms_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
  }

  template <class Visit>
  void around(const Vector3& x, const Visit& visit) const {
    long at[3], from[3], count[3];
    place(x, at);
    for (int k = 0; k < 3; ++k) {
      const bool all = number_[k] < 3;
      from[k] = all ? 0 : at[k] - 1;
      count[k] = all ? number_[k] : 3;
    }
    long c[3];
    for (long a = 0; a < count[0]; ++a)
      for (long b = 0; b < count[1]; ++b)
        for (long d = 0; d < count[2]; ++d) {
          const long offset[3] = {a, b, d};
          bool there = true;
          for (int k = 0; k < 3; ++k) {
            c[k] = from[k] + offset[k];
            if (periodic_[k]) c[k] = (c[k] + number_[k]) % number_[k];
            there = there && c[k] >= 0 && c[k] < number_[k];
          }
          if (!there) continue;
          const auto cell = static_cast<std::size_t>(index(c));
          for (std::uint32_t n = begin_[cell]; n < begin_[cell + 1]; ++n) visit(atoms_[n]);
        }
  }

 private:
  void place(const Vector3& x, long* at) const {
    const Vector3 part = inverse_ * (x - origin_);
    for (int k = 0; k < 3; ++k) {
      double inside = (part[k] - low_[k]) / span_[k];
      if (periodic_[k]) inside -= std::floor(inside);
      at[k] = std::clamp(static_cast<long>(inside * static_cast<double>(number_[k])), 0L, number_[k] - 1);
    }
  }
  long index(const long* at) const { return (at[0] * number_[1] + at[1]) * number_[2] + at[2]; }

  Eigen::Matrix3d inverse_;
  Vector3 origin_;
  double low_[3], span_[3];
  long number_[3];
  bool periodic_[3];
  std::vector<std::uint32_t> begin_, atoms_;
};

}  // namespace

BondGraph::BondGraph(const std::vector<Vector3>& positions, const std::vector<char>& wanted, const AtomBox& box,
                     const std::string& file, double bond)
    : neighbour_(positions.size()), count_(positions.size(), 0) {
  for (int k = 0; k < 3; ++k)
    if (box.periodic[static_cast<std::size_t>(k)] && box.width(k) < 2 * bond)
      throw InputError({file, 0, ""},
                       fmt::format("its periodic box is {:.3g} nm wide, less than two bonds", box.width(k)),
                       "repeat it: replicate of LAMMPS, or repeat() of ASE");
  const Cells cells(positions, wanted, box, bond);
  const NearestImage nearest(box);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!wanted[i]) continue;
    cells.around(positions[i], [&](std::uint32_t j) {
      if (j == i) return;
      const double d = nearest(positions[j] - positions[i]).squaredNorm();
      if (d > bond * bond) return;
      if (d < atoms_overlap * atoms_overlap)
        throw InputError(
            {file, 0, ""},
            fmt::format("atoms {} and {} of the file overlap: they are {:.3g} nm apart",
                        std::min<std::size_t>(i, j) + 1, std::max<std::size_t>(i, j) + 1, std::sqrt(d)),
            "are lengths in Angstrom, and is the box that of these atoms?");
      if (count_[i] < most) neighbour_[i][count_[i]] = j;
      if (count_[i] < 255) ++count_[i];
    });
  }
}

}  // namespace ropewalk
