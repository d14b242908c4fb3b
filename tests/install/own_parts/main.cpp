// Relaxes the scene of the command line, a clamped tube in the wind, and compares the deflection of its tip with
// beam theory.
#include <cmath>
#include <cstdio>

#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"

using namespace ropewalk;

int main(int, char** arguments) try {
  Scene scene = read_scene(arguments[1]);
  const Prepared prepared = prepare(scene);
  Simulation simulation = start(scene, prepared);
  const State before = simulation.state();
  if (!simulation.relax(scene.run.goal.force, scene.run.max_steps, [](long) { return true; })) return 4;

  // A Timoshenko beam that is clamped at the first element, under a force on each of the others.
  const BondStiffness& bond = prepared.topology.types[0].bond;
  const std::size_t tip = before.size() - 1;
  const double growth = 5e-5 * units::nN_nm, length = before.position[tip].z() - before.position[0].z();
  double expected = 0;
  for (std::size_t i = 1; i <= tip; ++i) {
    const double z = before.position[i].z() - before.position[0].z(), force = growth * before.position[i].z();
    expected += force * (z * z * (3 * length - z) / (6 * bond.bend) + (bond.shear > 0 ? z / bond.shear : 0));
  }
  const double found = simulation.state().position[tip].x() - before.position[tip].x();
  std::printf("tip: %.4g nm, beam theory: %.4g nm\n", found, expected);
  return std::fabs(found / expected - 1) < 2e-3 ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 2;
}
