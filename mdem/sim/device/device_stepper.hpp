// The elements of a scene on a device. The device moves the elements that no load acts on. The host moves the few
// other elements, with the loads, constraints and gauges that a simulation without a device has, and sends them to
// the device in every step. A scene with a force that no device computes is refused.
//
// The contact is computed in floats, on coordinates modulo 2^32; motion and bonds in doubles. All devices give the
// same bits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/device/device.hpp"
#include "sim/forces/forces.hpp"
#include "sim/neighbours/neighbours.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/motion.hpp"
#include "sim/state/state.hpp"

namespace ropewalk {

// What a scene has that no device can compute, in the words of a message; empty: nothing.
std::string not_for_a_device(const Topology& topology, const Interaction& interaction);

class DeviceStepper {
 public:
  // Sums over all elements in one step.
  struct StepSummary {
    Fastest fastest;           // velocities of the drift
    Change change;             // displacements since the list was built
    double damping_power = 0;  // eV/ps
    int slipping_bond = -1;    // first element of a bond twisted by 90 degrees or more, -1: none
  };

  // Throws std::invalid_argument where not_for_a_device() says why, or where there is no such device.
  DeviceStepper(const Topology& topology, const Interaction& interaction, const std::string& device);

  const std::string& name() const { return name_; }

  // From now on the device goes on from this state. `forces` (without the loads) may be those that give() returned.
  // The host moves the elements `hosted`, in rising order.
  void take(const State& state, const Forces& forces, std::vector<int> hosted, const NeighbourList& list);
  // Finds the neighbours where the list begins (NeighbourList::begin): again after each begin.
  void use_list(const NeighbourList& list);
  // The neighbours of each element that its contact or its viscosity may reach until then: of element i those from
  // begin[i] to begin[i + 1].
  struct Neighbours {
    std::vector<int> begin, neighbour;
  };
  Neighbours neighbours() const;

  // v += F dt/m,  w += M dt/I  of its elements.
  void kick(double dt);
  // Moves its elements by dt, and takes from `state` the others, which have been moved already.
  void drift(double dt, const State& state, const NeighbourList& list);
  // The forces on all elements where they are now; those on hosted elements are written to `forces`.
  StepSummary compute(Forces& forces);
  // The state and the forces of all elements; those of hosted elements stay as they are.
  void give(State& state, Forces& forces) const;
  // The positions and orientations alone.
  void give_places(State& state) const;

  const std::vector<int>& hosted() const { return hosted_; }
  std::size_t bytes() const { return bytes_; }  // memory on the device

 private:
  Device::Memory allocate(std::size_t bytes);
  template <class T>
  Device::Memory send(const std::vector<T>& numbers);
  template <class Columns>
  void send_columns(const Columns& columns, const Device::Memory& to);
  void find_neighbours(const NeighbourList& list);

  const Topology topology_;
  const Interaction interaction_;
  std::unique_ptr<Device> device_;
  std::string name_;
  std::size_t bytes_ = 0;
  int elements_ = 0, stride_ = 0, groups_ = 0, buckets_ = 0;
  std::size_t listed_ = 0, room_ = 0;  // neighbours of all elements
  double unit_ = 1;                    // unit of the coordinates, nm
  std::vector<int> hosted_;
  std::vector<double> rows_, sums_;  // sent and read in every step
  Device::Memory kind_, types_, tables_, motion_, force_, bond_, reference_, told_, summary_, last_, cell_, first_,
      next_, member_, counts_, begin_, list_, centre_, axis_, velocity_, spin_, contact_force_, contact_torque_,
      which_, hosted_motion_;
};

}  // namespace ropewalk
