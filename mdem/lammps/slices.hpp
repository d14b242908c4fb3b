// Slices of a scene: each rank has as many elements with consecutive numbers. Whoever looks for the owner of an
// element asks the rank of its slice, so that no rank knows all owners.
#pragma once

#include <functional>
#include <vector>

#include "lammps/shared.hpp"

namespace ropewalk::lammps {

class Slices {
 public:
  Slices(LMP::LAMMPS* lmp, LMP::bigint elements) : lmp_(lmp), elements_(elements) {}

  LMP::bigint begin(int rank) const { return elements_ * rank / lmp_->comm->nprocs; }
  int of(LMP::bigint element) const {
    return static_cast<int>(((element + 1) * lmp_->comm->nprocs - 1) / elements_);
  }
  // Each rank gets its list. Lists arrive behind one another in the order of the ranks that sent them. All ranks.
  std::vector<double> exchange(const std::vector<std::vector<double>>& to) const;
  // Records of elements (sim/forces/force_terms.hpp), each to the rank that `rank_of` names; -1: to none. All
  // ranks.
  std::vector<double> bring(const std::vector<double>& records, const std::function<int(int)>& rank_of) const;
  // Records of elements, each to the rank that has the element now, which lists its own elements. All ranks.
  std::vector<double> bring_to_owners(const std::vector<double>& records, const std::vector<int>& own) const;

 private:
  LMP::LAMMPS* lmp_;
  LMP::bigint elements_;
};

}  // namespace ropewalk::lammps
