// `energy`: one evaluation of a state, for checks by hand and by other programs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/verb.hpp"
#include "scene/kinds/state.hpp"
#include "scene/single_state.hpp"
#include "sim/threads/threads.hpp"

namespace ropewalk {
namespace {

struct EnergyArguments {
  std::string state;    // file
  SingleState options;  // but for its source
  bool json = false;
  int threads = 0;
};

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
  // The contact of tubes in line: no other force term acts here.
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

}  // namespace

void add_energy(CLI::App& app, Program& program) {
  const auto a = std::make_shared<EnergyArguments>();
  CLI::App* c = app.add_subcommand(
      "energy", "Energies (eV), forces (eV/nm) and torques (eV) of one state: CSV tube,x_nm,y_nm,z_nm,qw,qx,qy,qz");
  c->add_option("state", a->state, "State file; the tube axis is the body's z")->required();
  c->add_option("--parameters", a->options.parameters,
                "Parameter set: a file, or the name of a shipped one; several, separated by commas, for tube types")
      ->delimiter(',')
      ->required();
  c->add_option("--tube-types", a->options.tube_types,
                "Number of the parameter set of each tube, from 0: 0,1,1 [default: all 0]")
      ->delimiter(',');
  c->add_option("--law", a->options.law, "Contact law: line, paper or none [default: line where the set has it]");
  c->add_option("--bond", a->options.bond, "harmonic or anharmonic [default: anharmonic where the set has it]")
      ->check(CLI::IsMember({"harmonic", "anharmonic"}));
  c->add_option("--element-length-nm", a->options.element_length,
                "Length of an element [default: what the state file says, else the set's]")
      ->check(number_within(Bounds::range(0.05, 50)));
  c->add_option("--free-length-nm", a->options.free_length,
                "Free length of the tubes between their clamps; long tubes collapse at less twist than short ones "
                "[default: the whole length]")
      ->check(number_within(Bounds::positive()));
  c->add_option("--exclude-along-tube-nm", a->options.exclude_along_tube,
                "Parts of one tube up to this far apart along it do not attract [default: as a scene has it]")
      ->check(number_within(Bounds::positive()));
  c->add_option("--nodes-per-element", a->options.nodes,
                "Nodes of the line law on an element: a state that Newton's method found has the number that `check` "
                "prints [default: as a run in time has it]")
      ->check(CLI::Range(1, 64));
  c->add_option("--threads", a->threads, "Threads [default: all cores]")->check(thread_range());
  c->add_flag("--legacy-torque", a->options.legacy_torque,
              "Leave out the torque that the published code leaves out");
  c->add_flag("--reference", a->options.reference, "The plain O(N^2) path instead of the fast one");
  c->add_flag("--json", a->json, "JSON");
  c->callback([a, &program] { program.code = energy_command(*a); });
}

}  // namespace ropewalk
