// [thermostat] a bath that keeps the temperature.
#pragma once

#include "scene/drive.hpp"

namespace ropewalk {

class ThermostatDrive : public Drive {
 public:
  ThermostatOptions options;

  SceneTable table() const override;
  std::string words() const override;
  void refuse(const TomlTable& top, const Scene&) const override;
  double lasts() const override { return options.temperature.ends(); }
  bool is_random() const override { return options.temperature.largest() > 0; }
  void set_stepping(std::uint64_t lineage, Stepping& stepping) const override;
  const ThermostatOptions* thermostat() const override { return &options; }
  NotForLammps not_for_lammps() const override {
    if (make_thermostat(options)->acts_by_element()) return {};
    return {"thermostat.method", "this one needs the motion of all elements at once, and ranks have a part of them"};
  }
};

}  // namespace ropewalk
