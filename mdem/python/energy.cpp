// Energies, forces and torques of one state.
#include <utility>

#include "python/arrays.hpp"
#include "python/given_state.hpp"
#include "python/scene.hpp"
#include "python/simulation.hpp"
#include "scene/kinds/state.hpp"
#include "scene/state_files.hpp"

namespace ropewalk::python {
namespace {

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
                    double free_length, int nodes, bool reference) {
  SingleState s;
  s.parameters = parameters;
  s.tube_types = tube_types;
  s.law = law;
  s.bond = bond;
  s.legacy_torque = legacy_torque;
  s.exclude_along_tube = exclude_along_tube;
  s.free_length = free_length;
  s.nodes = nodes;
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
           py::arg("legacy_torque"), py::arg("exclude_along_tube"), py::arg("free_length"),
           py::arg("nodes"), py::arg("reference"));
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
