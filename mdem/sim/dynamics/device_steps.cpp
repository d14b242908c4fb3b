// Steps of a simulation whose elements are on a device.
#include <omp.h>

#include <algorithm>
#include <stdexcept>

#include "sim/device/device_stepper.hpp"
#include "sim/dynamics/blow_up.hpp"
#include "sim/dynamics/simulation.hpp"

namespace ropewalk {

void Simulation::use_device(const std::string& name) {
  sync_to_host();
  if (stepping_.thermostat)
    throw std::invalid_argument("a device cannot run this scene: devices have no thermostat");
  if (stepping_.runge_kutta)
    throw std::invalid_argument("a device cannot run this scene: devices have no run.integrator = \"rk4\"");
  device_ = {};
  device_.stepper = std::make_shared<DeviceStepper>(topology_, interaction_, name);
}

// The host keeps the elements that loads act on or read, and the ends, which the gauges follow: few, as a rule.
void Simulation::upload() {
  if (device_.device_is_current) return;
  std::vector<int> hosted = loaded_;
  const auto add = [&](const std::vector<int>& more) { hosted.insert(hosted.end(), more.begin(), more.end()); };
  for (const auto& load : loads_) add(load->reads(topology_));
  for (const std::vector<int>& end : gauges_.ends()) add(end);
  std::sort(hosted.begin(), hosted.end());
  hosted.erase(std::unique(hosted.begin(), hosted.end()), hosted.end());
  device_.hosted.clear();
  for (const int i : hosted) {
    const int tube = topology_.tube_of(i);
    std::vector<Segment>& parts = device_.hosted;
    if (!parts.empty() && parts.back().end == i && parts.back().tube == tube) {
      ++parts.back().end;
    } else {
      parts.push_back({tube, i, i + 1});
    }
  }
  device_.stepper->take(state_, forces_, std::move(hosted), list_);
  device_.device_is_current = true;
}

const NeighbourList& Simulation::list() const {
  if (!list_.has_pairs()) const_cast<Simulation&>(*this).list_.find_pairs(topology_);
  return list_;
}

// Const: a caller sees the same state, whether the device or this processor holds it.
void Simulation::download() const {
  if (!device_.host_is_stale && !device_.energies_missing) return;
  auto& self = const_cast<Simulation&>(*this);
  if (device_.host_is_stale) device_.stepper->give(self.state_, self.forces_);
  self.device_.host_is_stale = false;
  if (!device_.energies_missing) return;
  if (!list_.has_pairs()) self.list_.find_pairs(topology_);
  Forces all(state_.size());
  self.engine_.compute(topology_, interaction_, list_, state_, all);
  self.forces_.energy = all.energy;
  self.forces_.term_energy = all.term_energy;
  self.device_.energies_missing = false;
}

void Simulation::sync_to_host() {
  download();
  if (!list_.has_pairs()) list_.find_pairs(topology_);
  device_.device_is_current = false;
}

void Simulation::compute_on_device() {
  device_.host_is_stale = true;
  device_.energies_missing = false;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  forces_.energy = {unknown, unknown, unknown, unknown, unknown, unknown};
  DeviceStepper::StepSummary summary = device_.stepper->compute(forces_);
  const MotionBound bound(topology_.largest_radius(), part_step());
  if (!bound.holds(summary.fastest)) {
    download();
    refuse_blow_up(bound);
  }
  ++list_age_;
  if (list_.cutoff > 0 && list_.stale(summary.change)) {
    const double began = omp_get_wtime();
    device_.stepper->give_places(state_);
    list_.begin(topology_, state_);
    list_age_ = 0;
    device_.stepper->use_list(list_);
    list_seconds_ += omp_get_wtime() - began;
    summary = device_.stepper->compute(forces_);
  }
  forces_.damping_power = summary.damping_power;
  forces_.slipping_bond = summary.slipping_bond;
  forces_.lost = 0;
  add_point_loads();
  check_slip();
}

}  // namespace ropewalk
