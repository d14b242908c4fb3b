// Langevin thermostat of translation and rotation: friction and noise of a bath at rest,
//
//   dv = -g v dt + sqrt(2 g kT/m) dW,   dw = -g w dt + sqrt(2 g kT/I) dW,
//
// solved exactly over dt (an Ornstein-Uhlenbeck process):
//
//   v <- c v + sqrt((1 - c^2) kT/m) n,   w <- c w + sqrt((1 - c^2) kT/I) n,   c = exp(-g dt),
//
// with normal numbers n of variance 1. They follow from (seed, step, part, element, component) alone.
// In a slice the period is one more such coordinate, with the mass TubeGroups::period_inertia.
// T in K, that of the schedule at state.time; g in 1/ps. At T = 0 it is pure friction: the kinetic energy of free
// elements decays as exp(-2 g t). R. L. Davidchack, T. E. Ouldridge, M. V. Tretyakov, J. Chem. Phys. 142, 144114
// (2015), DOI 10.1063/1.4916312.
#pragma once

#include <utility>
#include <vector>

#include "sim/dynamics/thermostat.hpp"

namespace ropewalk {

class LangevinThermostat : public Thermostat {
 public:
  LangevinThermostat(Schedule temperature, double friction, std::uint64_t seed)
      : temperature_(std::move(temperature)), friction_(friction), seed_(seed) {}
  void apply(const Topology& topology, double dt, State& state, std::vector<double>& variables) const override;
  bool acts_by_element() const override { return true; }

 private:
  Schedule temperature_;
  double friction_;
  std::uint64_t seed_;
};

}  // namespace ropewalk
