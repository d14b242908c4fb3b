// `energy`: one evaluation of a state, for checks by hand and by other programs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "scene/kinds/state.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Json as_json(const Forces& f, const NetForce& net) {
  const Energies& e = f.energy;
  Json out;
  out["energy_eV"] = {{"stretch", e.stretch}, {"shear", e.shear}, {"bend", e.bend},        {"twist", e.twist},
                      {"vdw", e.vdw},         {"ends", e.terms},  {"total", e.potential()}};
  Json force = Json::array(), torque = Json::array();
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    force.push_back(vector_json(f.force[i]));
    torque.push_back(vector_json(f.torque[i]));
  }
  out["force_eV_per_nm"] = std::move(force);
  out["torque_eV"] = std::move(torque);
  out["net_force_eV_per_nm"] = vector_json(net.force);
  out["net_torque_eV"] = vector_json(net.torque);
  return out;
}

void print_table(const Forces& f, const NetForce& net) {
  const Energies& e = f.energy;
  fmt::print(
      "stretch {:16.9g} eV\nshear   {:16.9g} eV\nbend    {:16.9g} eV\ntwist   {:16.9g} eV\n"
      "vdW     {:16.9g} eV\n",
      e.stretch, e.shear, e.bend, e.twist, e.vdw);
  // Of tubes in line; no other force term acts here.
  if (e.terms != 0) fmt::print("ends    {:16.9g} eV\n", e.terms);
  fmt::print("total   {:16.9g} eV\n\n", e.potential());
  fmt::print("{:>8} {:>14} {:>14} {:>14}  {:>14} {:>14} {:>14}\n", "element", "Fx eV/nm", "Fy", "Fz", "Mx eV", "My",
             "Mz");
  for (std::size_t i = 0; i < f.force.size(); ++i) {
    const Vector3 a = f.force[i], b = f.torque[i];
    fmt::print("{:8} {:14.6e} {:14.6e} {:14.6e}  {:14.6e} {:14.6e} {:14.6e}\n", i, a.x(), a.y(), a.z(), b.x(),
               b.y(), b.z());
  }
  fmt::print("\nnet force  {:.3e} {:.3e} {:.3e} eV/nm\nnet torque {:.3e} {:.3e} {:.3e} eV about the origin\n",
             net.force.x(), net.force.y(), net.force.z(), net.torque.x(), net.torque.y(), net.torque.z());
}

}  // namespace

int energy_command(const EnergyArguments& a) {
  use_threads(a.threads);
  SingleState state = a.options;
  state.source = std::make_shared<StateSource>(a.state);
  const EvaluatedState found = evaluate(state);
  if (!found.note.empty()) fmt::print(stderr, "ropewalk: note: {}\n", found.note);
  const Forces& forces = found.forces;
  const NetForce net = net_force(found.built.state, forces);
  if (a.json) {
    fmt::print("{}\n", as_json(forces, net).dump(1));
  } else {
    print_table(forces, net);
  }
  return 0;
}

}  // namespace ropewalk
