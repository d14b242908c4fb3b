// [[load]] kind = "rotate": the elements turn as one body about a line along z through `centre`,
//
//   angle(t) = rate t, up to `angle`.
#pragma once

#include <cmath>

#include "sim/dynamics/loads.hpp"

namespace ropewalk {

class PrescribedRotation : public Load {
 public:
  double rate = 0;   // rad/ps
  double angle = 0;  // rad, where it stops; of the sign of the rate
  Vector3 centre = Vector3::Zero();
  bool axial_free = true;
  bool spin_free = false;  // the spin about the tube's own axis is left free

  PrescribedRotation() = default;
  PrescribedRotation(std::vector<int> on, double turn_rate, double last_angle, bool free_axial = true,
                     bool free_spin = false)
      : Load(std::move(on)), rate(turn_rate), angle(last_angle), axial_free(free_axial), spin_free(free_spin) {}

  double speed(double time) const { return time >= 0 && std::fabs(rate * time) < std::fabs(angle) ? rate : 0.0; }

  std::shared_ptr<Load> copy() const override { return std::make_shared<PrescribedRotation>(*this); }
  Order order() const override { return Order::prescribed_motion; }
  void constrain(const Topology&, double time, double ahead, State&) const override;
  std::string needs_time() const override { return "a rotation needs time"; }
  std::optional<LoadEffect> effect() const override;

 private:
  void set_velocities(double time, std::size_t i, State& state) const;
};

}  // namespace ropewalk
