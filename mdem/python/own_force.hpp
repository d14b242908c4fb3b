// Forces and torques on the elements that a function of Python gives.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "python/module.hpp"
#include "run/own_forces.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/state/interaction.hpp"
#include "sim/state/state.hpp"

namespace ropewalk::python {

// Lives as long as what it was given to, and is called with the lock of Python's interpreter.
class OwnForce {
 public:
  struct Found {
    Vec3Array force, torque;  // eV/nm, eV
    double energy = 0;        // eV
  };

  // (step, time, position, orientation, velocity, angular velocity) -> (forces, torques, energy or None)
  static std::shared_ptr<OwnForce> make(py::function function);

  // Adds the force to what acts on the elements. With an energy it is a force term; without one it is a load, whose
  // work counts as supplied. `start`: the first state that it sees.
  static void add(const std::shared_ptr<OwnForce>& force, const State& start, Interaction& interaction,
                  LoadsAndConstraints& loads);
  // With drives of a scene, which last as long as its runs. `start`: the first state that they see.
  static std::vector<OwnForceOfRun> of_run(const std::vector<py::function>& functions, const State& start);
  // As a run would have them, without drives. They have been called.
  static std::vector<OwnForceOfRun> named(const std::vector<std::shared_ptr<OwnForce>>& forces);
  // Only that part of it which is a force term, and that which is a load.
  static void add_term_of(const std::shared_ptr<OwnForce>& force, Interaction& interaction);
  static void add_load(const std::shared_ptr<OwnForce>& force, LoadsAndConstraints& loads);

  // Throws what the function raises, and std::invalid_argument where it gives an energy at some times only. None
  // while it rests.
  std::optional<Found> at(const State& state);
  void rest(bool rests) { rests_ = rests; }

 private:
  explicit OwnForce(py::function function) : function_(std::move(function)) {}

  py::function function_;
  std::optional<bool> has_energy_;
  bool rests_ = false;
};

}  // namespace ropewalk::python
