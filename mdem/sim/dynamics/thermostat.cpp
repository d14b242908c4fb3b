#include "sim/dynamics/thermostat.hpp"

#include <algorithm>

#include "sim/dynamics/langevin.hpp"

namespace ropewalk {

const std::vector<ThermostatKind>& thermostat_kinds() {
  static const std::vector<ThermostatKind> kinds = {
      {"langevin", [](const ThermostatOptions& o) -> std::shared_ptr<const Thermostat> {
         return std::make_shared<LangevinThermostat>(o.temperature, o.coupling, o.seed);
       }}};
  return kinds;
}

std::shared_ptr<const Thermostat> make_thermostat(const ThermostatOptions& options) {
  const auto& kinds = thermostat_kinds();
  return std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.name == options.method; })
      ->make(options);
}

}  // namespace ropewalk
