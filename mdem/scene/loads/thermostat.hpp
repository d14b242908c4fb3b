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
  void set_stepping(Stepping& stepping) const override { stepping.thermostat = make_thermostat(options); }
  const ThermostatOptions* thermostat() const override { return &options; }
  std::string not_for_lammps() const override { return "thermostat"; }
  std::optional<std::vector<std::pair<std::string, double>>> hastened(double) const override {
    return std::vector<std::pair<std::string, double>>();
  }
};

}  // namespace ropewalk
