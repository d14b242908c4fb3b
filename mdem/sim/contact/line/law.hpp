// The line law (model/contact/line.hpp) as a contact law between any tube types.
#pragma once

#include <vector>

#include "model/contact/line.hpp"
#include "sim/contact/contact_law.hpp"

namespace ropewalk {

class LineLaw : public ContactLaw {
 public:
  const std::vector<LineContact> pairs;  // pair of tube types i, j at i * types + j

  // `wells`: of parallel tubes, pair by pair, where they are known; empty: they are searched for. Throws
  // std::invalid_argument where the pairs are not those of a whole number of types.
  explicit LineLaw(std::vector<LineContact> all, std::vector<LineWell> wells = {});
  const LineContact& of(TypePair p) const { return pairs[static_cast<std::size_t>(p.i * types_ + p.j)]; }
  int types() const { return types_; }

  std::string name() const override { return "line"; }
  double cutoff() const override;
  double lever() const override;
  // Its spans skip what is out of reach, so that a wide margin costs little.
  double default_skin() const override { return 0.25; }
  bool whole_ranges() const override { return false; }
  int nodes() const override { return pairs.front().nodes_i; }
  PairForce force(TypePair types, const Vector3& separation, const Vector3& n_i,
                  const Vector3& n_j) const override {
    return of(types).energy_and_gradient(separation, n_i, n_j);
  }
  bool reaches(TypePair types, const Vector3& separation, const Vector3& n_i, const Vector3& n_j) const override;
  double parallel_distance(TypePair types, double) const override { return well(types).distance; }
  double crossed_distance(TypePair types, double) const override;
  double binding(TypePair types, double) const override { return -well(types).energy; }
  double range(TypePair types) const override { return of(types).density.cutoff(); }
  double core_distance(TypePair types) const override {
    return of(types).density.contact + of(types).density.core_gap;
  }

 private:
  const LineWell& well(TypePair p) const { return wells_[static_cast<std::size_t>(p.i * types_ + p.j)]; }

  int types_ = 0;
  std::vector<LineWell> wells_;  // wells of parallel tubes, indexed as `pairs`
};

inline std::shared_ptr<const LineLaw> line_law(std::vector<LineContact> pairs) {
  return std::make_shared<const LineLaw>(std::move(pairs));
}

}  // namespace ropewalk
