// [[load]] kind = "force": the same constant force on every element.
#pragma once

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

class ForceLoad : public Load {
 public:
  Vector3 force = Vector3::Zero();  // eV/nm on each element

  ForceLoad() = default;
  ForceLoad(std::vector<int> on, const Vector3& each) : Load(std::move(on)), force(each) {}

  std::shared_ptr<Load> copy() const override { return std::make_shared<ForceLoad>(*this); }
  void add_forces(const State&, double time, std::vector<PointLoad>& out) const override;
  std::shared_ptr<Load> opposite() const override { return std::make_shared<ForceLoad>(elements, -force); }
  std::optional<LoadEffect> effect() const override { return constant_effect(force, Vector3::Zero()); }
};

}  // namespace ropewalk
