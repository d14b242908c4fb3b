// The interface of thermostats and their register. To add one: a file with the class, and a line in thermostat.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/dynamics/schedule.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

struct ThermostatOptions {
  std::string method = "langevin";
  Schedule temperature;  // K
  double coupling = 0;   // 1/ps
  std::uint64_t seed = 1;
};

class Thermostat {
 public:
  virtual ~Thermostat() = default;
  // The internal variables of this thermostat at the start, such as the velocities of a Nosé-Hoover chain; empty:
  // it has none. The simulation keeps their values and writes them to checkpoints.
  virtual std::vector<double> initial_variables() const { return {}; }
  // Changes velocities and angular velocities, and the internal variables, as the bath does during dt (ps). The
  // simulation calls this function once in each step, restores the constrained components afterwards and books the
  // change of the kinetic energy as heat. The result must depend on the arguments alone, state.step and state.part
  // included, and not on the number of threads: a resumed run then continues with the same bits.
  virtual void apply(const Topology& topology, double dt, State& state, std::vector<double>& variables) const = 0;
  // Whether the change of an element follows from its own velocities, its number in the scene (Topology::part) and
  // the step alone. Several processes may then each apply it to their own elements.
  virtual bool acts_by_element() const { return false; }
};

struct ThermostatKind {
  const char* name;
  std::shared_ptr<const Thermostat> (*make)(const ThermostatOptions&);
};
const std::vector<ThermostatKind>& thermostat_kinds();

// Makes the thermostat that options.method names: one of thermostat_kinds().
std::shared_ptr<const Thermostat> make_thermostat(const ThermostatOptions& options);

}  // namespace ropewalk
