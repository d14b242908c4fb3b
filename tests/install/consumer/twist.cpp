// A program outside of this tree, built against the installed libraries: ten steps of a rope, and what a run would
// take. Argument: a shipped parameter set.
#include <cstdio>
#include <string>

#include "run/run_time.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

int main(int argc, char** argv) {
  const std::string set = argc > 1 ? argv[1] : "cnt-10-10-tersoff";
  const std::string text = "format = \"ropewalk-scene-1\"\nparameters = \"" + set +
                           "\"\n[rope]\ntubes = 7\nlength_nm = 14\n"
                           "[twist]\nmoment_nN_nm = 5\nrate_nN_nm_per_ps = 1\n";
  ropewalk::Scene scene = ropewalk::scene_of_text(text, "from-memory.toml");
  const ropewalk::Prepared prepared = ropewalk::prepare(scene);
  ropewalk::Simulation simulation = ropewalk::start(scene, prepared);
  simulation.steps(10, true);
  std::printf("%d elements, vdW energy %.6g eV\n", prepared.topology.elements(), simulation.forces().energy.vdw);
  const ropewalk::RunTime time = ropewalk::time_run(text, "from-memory.toml");
  if (time.steps > 0 && time.each > 0 && time.outputs > 0)
    std::printf("%.0f steps, %.3g s of processor time\n", time.steps, time.total());
}
