// Energies, forces and torques of one state.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "model/error.hpp"
#include "python/arrays.hpp"
#include "python/scene.hpp"
#include "python/simulation.hpp"
#include "scene/kinds/state.hpp"
#include "scene/single_state.hpp"
#include "scene/state_files.hpp"

namespace ropewalk::python {
namespace {

constexpr double norm_slack = 1e-3;  // of a quaternion, as state files have it

// Elements at rest that a caller gives.
class GivenState : public Source {
 public:
  GivenState(const std::vector<int>& tube_begin, const py::array_t<double>& position,
             const py::array_t<double>& orientation)
      : tube_begin_(tube_begin) {
    state_.position = vectors_from(position);
    state_.orientation = quaternions_from(orientation);
    state_.velocity.resize(state_.size());
    state_.angular_velocity.resize(state_.size());
    if (tube_begin.size() < 2 || tube_begin.front() != 0 ||
        std::adjacent_find(tube_begin.begin(), tube_begin.end(), std::greater_equal<int>()) != tube_begin.end())
      throw std::invalid_argument("tubes begin at element 0, and each has one element or more");
    if (tube_begin.back() != static_cast<int>(state_.size()) || state_.orientation.size() != state_.size())
      throw std::invalid_argument("positions, orientations and tubes do not have the same number of elements");
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto wrong = [&](const std::string& what, const char* remedy) {
        throw InputError({"", 0, "state"}, fmt::format("element {} {}", i, what), remedy);
      };
      if (!Vector3(state_.position[i]).allFinite()) wrong("has no finite position", "give numbers in nm");
      const Quaternion q = state_.orientation[i];
      if (!(std::fabs(q.norm() - 1) <= norm_slack))
        wrong(fmt::format("has a quaternion of length {:.6g}", q.norm()), "it must be 1 within 0.001");
    }
  }

  void place(const Scene&, double, Random&, Topology& topology, State& state) const override {
    for (std::size_t t = 0; t + 1 < tube_begin_.size(); ++t) topology.add_tube(tube_begin_[t + 1] - tube_begin_[t]);
    state = state_;
  }
  std::string file() const override { return "the state"; }
  const State& state() const { return state_; }

 private:
  std::vector<int> tube_begin_;
  State state_;
};

py::dict as_dict(const State& state, const Forces& f) {
  const NetForce net = net_force(state, f);
  py::dict out;
  out["stretch"] = f.energy.stretch;
  out["shear"] = f.energy.shear;
  out["bend"] = f.energy.bend;
  out["twist"] = f.energy.twist;
  out["vdw"] = f.energy.vdw;
  out["terms"] = f.energy.terms;
  out["force"] = copy_of(f.force);
  out["torque"] = copy_of(f.torque);
  out["net_force"] = std::vector<double>{net.force.x(), net.force.y(), net.force.z()};
  out["net_torque"] = std::vector<double>{net.torque.x(), net.torque.y(), net.torque.z()};
  return out;
}

py::dict evaluated(SingleState state) {
  EvaluatedState found;
  {
    const py::gil_scoped_release release;
    found = evaluate(state);
  }
  py::dict out = as_dict(found.built.state, found.forces);
  out["note"] = found.note;
  return out;
}

SingleState options(const std::vector<std::string>& parameters, const std::vector<int>& tube_types,
                    const std::string& law, const std::string& bond, bool legacy_torque, double exclude_along_tube,
                    double free_length, bool reference) {
  SingleState s;
  s.parameters = parameters;
  s.tube_types = tube_types;
  s.law = law;
  s.bond = bond;
  s.legacy_torque = legacy_torque;
  s.exclude_along_tube = exclude_along_tube;
  s.free_length = free_length;
  s.reference = reference;
  return s;
}

py::dict energy_at_rest(const Topology& topology, Interaction interaction, const State& state, bool reference) {
  interaction.precision = Interaction::Precision::full;
  Forces forces;
  {
    const py::gil_scoped_release release;
    forces = forces_of(topology, interaction, state, reference, {"", 0, "the state"});
  }
  return as_dict(state, forces);
}

// The state at rest, with the bonds and contacts of a scene and without its loads.
py::dict energy_in_scene(const SceneHandle& handle, const py::array_t<double>& position,
                         const py::array_t<double>& orientation, bool reference) {
  const std::shared_ptr<const Model> model = handle.model();
  const GivenState given(model->prepared.topology.tube_begin, position, orientation);
  return energy_at_rest(model->prepared.topology, model->prepared.interaction, given.state(), reference);
}

// The same of a simulation, with what its friction, links and broken tubes remember now.
py::dict energy_of_simulation(const SteppedScene& stepped, bool reference) {
  const Simulation& simulation = stepped.simulation();
  const Prepared& p = stepped.model().prepared;
  Interaction interaction = p.interaction;
  StateMemory now;
  now.terms = simulation.term_memories();
  begin_with(now, p.topology, interaction);
  State state(simulation.state().size());
  state.position = simulation.state().position;
  state.orientation = simulation.state().orientation;
  return energy_at_rest(p.topology, interaction, state, reference);
}

}  // namespace

void bind_energy(py::module_& m) {
  py::class_<SingleState>(m, "StateOptions")
      .def(py::init(&options), py::arg("parameters"), py::arg("tube_types"), py::arg("law"), py::arg("bond"),
           py::arg("legacy_torque"), py::arg("exclude_along_tube"), py::arg("free_length"), py::arg("reference"));
  m.def("energy_of_file", [](const std::string& path, SingleState s) {
    s.source = std::make_shared<StateSource>(path);
    return evaluated(std::move(s));
  });
  m.def("energy_of_state", [](const std::vector<int>& tube_begin, const py::array_t<double>& position,
                              const py::array_t<double>& orientation, double element_length, SingleState s) {
    s.source = std::make_shared<GivenState>(tube_begin, position, orientation);
    s.element_length = element_length;
    return evaluated(std::move(s));
  });
  m.def("energy_in_scene", energy_in_scene);
  m.def("energy_of_simulation", energy_of_simulation);
}

}  // namespace ropewalk::python
