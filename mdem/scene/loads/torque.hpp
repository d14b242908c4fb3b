// [[load]] kind = "torque": the same constant couple on every element.
#pragma once

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

class TorqueLoad : public Load {
 public:
  Vector3 torque = Vector3::Zero();  // eV on each element

  TorqueLoad() = default;
  TorqueLoad(std::vector<int> on, const Vector3& each) : Load(std::move(on)), torque(each) {}

  std::shared_ptr<Load> copy() const override { return std::make_shared<TorqueLoad>(*this); }
  void add_forces(const State&, double time, std::vector<PointLoad>& out) const override;
  std::shared_ptr<Load> opposite() const override { return std::make_shared<TorqueLoad>(elements, -torque); }
  std::optional<LoadEffect> effect() const override { return constant_effect(Vector3::Zero(), torque); }
};

}  // namespace ropewalk
