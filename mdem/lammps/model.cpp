#include "lammps/model.hpp"

#include <fmt/format.h>

#include "model/error.hpp"
#include "scene/interactions/failure.hpp"
#include "scene/scene_to_model.hpp"
#include "scene/scene_toml.hpp"
#include "sim/dynamics/stepping.hpp"

namespace ropewalk {

LammpsModel load_lammps_model(const std::string& directory) {
  const LammpsDirectory dir{directory};
  LammpsModel m;
  m.directory = directory;
  m.start = read_start(dir);
  std::vector<std::string> sets;
  for (const std::string& name : m.start.parameters) sets.push_back(directory + "/" + name);
  Scene scene = read_scene(dir.scene(), sets);
  scene.damping.contact.inner = m.start.viscosity_inner;
  scene.damping.contact.outer = m.start.viscosity_outer;
  refuse_what_lammps_lacks(scene);
  m.topology = empty_topology(scene);
  read_tubes(dir, m.topology);
  set_strands(dir, m.start, m.topology);
  set_slice(dir, m.start, m.topology);
  m.topology.groups.ends_meet = ends_meet(scene, m.topology);
  set_collapse(scene, m.topology);
  m.interaction = interaction_of(scene);
  scene.memory.names.emplace_back("links");  // all links are in the state: the reader places none
  add_terms(scene, m.topology, State(static_cast<std::size_t>(m.topology.elements())), m.interaction);
  if (m.start.tubes_came_broken) add_term(broken_tubes_term(m.topology), m.interaction);
  m.loads = loads_of(scene, m.topology, m.interaction);
  Stepping stepping;
  for (const auto& drive : scene.drives) drive->set_stepping(m.start.lineage, stepping);
  m.thermostat = stepping.thermostat;
  m.law = scene.contact.law;
  m.judges_account = !scene.contact.legacy_torque;
  m.relax = scene.run.mode == RunOptions::Mode::relax;
  m.force_tolerance = scene.run.goal.force;
  return m;
}

std::string version_complaint(int built_against, int found) {
  if (built_against == found) return "";
  return fmt::format(
      "this program was built against LAMMPS {} and runs with LAMMPS {}; build it again with the headers of that "
      "LAMMPS, or let the loader find the other library (LD_LIBRARY_PATH)",
      built_against, found);
}

}  // namespace ropewalk
