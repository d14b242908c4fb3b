// Neighbours of atoms within a cutoff.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "atoms/atom_box.hpp"

namespace ropewalk {

inline constexpr double carbon_bond = 0.18;     // nm: carbon atoms nearer than this are bonded
inline constexpr double atoms_overlap = 0.072;  // nm: nearer than half a bond no two atoms come

// Up to four neighbours of each atom; more are counted.
class BondGraph {
 public:
  static constexpr int most = 4;

  // The graph of the atoms with a flag, of which those nearer than `bond` (nm) are bonded. Throws InputError at
  // `file` where two of them overlap or the box is too short.
  BondGraph(const std::vector<Vector3>& positions, const std::vector<char>& wanted, const AtomBox& box,
            const std::string& file, double bond = carbon_bond);

  std::size_t size() const { return count_.size(); }
  int count(std::size_t i) const { return count_[i]; }  // may be larger than `most`
  int kept(std::size_t i) const { return std::min<int>(count_[i], most); }
  std::uint32_t neighbour(std::size_t i, int k) const { return neighbour_[i][static_cast<std::size_t>(k)]; }
  bool bonded(std::size_t i, std::size_t j) const {
    for (int k = 0; k < kept(i); ++k)
      if (neighbour(i, k) == j) return true;
    return false;
  }

 private:
  std::vector<std::array<std::uint32_t, most>> neighbour_;
  std::vector<unsigned char> count_;
};

}  // namespace ropewalk
