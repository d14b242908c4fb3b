// A program of somebody else, built against the installed libraries: ten steps of a rope.
#include <cstdio>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

int main() {
  ropewalk::Scene scene = ropewalk::scene_of_text(
      "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 14\n"
      "[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 1\n",
      "rope.toml");
  const ropewalk::Prepared prepared = ropewalk::prepare(scene);
  ropewalk::Simulation simulation = ropewalk::start(scene, prepared);
  simulation.steps(10, true);
  std::printf("%d elements, vdW energy %.6g eV\n", prepared.topology.elements(), simulation.forces().energy.vdw);
}
