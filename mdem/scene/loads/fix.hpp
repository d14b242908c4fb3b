// [[load]] kind = "fix": elements keep their place, their orientation, or both.
#pragma once

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

class FixLoad : public Load {
 public:
  bool x = true, y = true, z = true, rotation = true;  // what is held

  FixLoad() = default;
  explicit FixLoad(std::vector<int> on, bool hold_x = true, bool hold_y = true, bool hold_z = true,
                   bool hold_rotation = true)
      : Load(std::move(on)), x(hold_x), y(hold_y), z(hold_z), rotation(hold_rotation) {}

  std::shared_ptr<Load> copy() const override { return std::make_shared<FixLoad>(*this); }
  Order order() const override { return Order::fix; }
  void constrain(const Topology&, double time, double ahead, State&) const override;
  std::optional<LoadEffect> effect() const override;
};

}  // namespace ropewalk
