// The control of FIRE: how long the next step is and how much of the velocity turns towards the force.
// E. Bitzek et al., Phys. Rev. Lett. 97, 170201 (2006), DOI 10.1103/PhysRevLett.97.170201, in the semi-implicit
// form of J. Guenole et al., Comput. Mater. Sci. 175, 109584 (2020).
#pragma once

#include <algorithm>

namespace ropewalk {

struct Fire {
  double dt_max, dt_min, dt;  // ps; no step beyond the stability limit
  double mix = 0.1;
  int downhill = 0;

  explicit Fire(double time_step) : dt_max(time_step), dt_min(1e-3 * time_step), dt(0.5 * time_step) {}

  void went_down() {
    if (++downhill <= 5) return;
    dt = std::min(1.1 * dt, dt_max);
    mix *= 0.99;
  }
  // The motion stops; before, it goes back by half a step, as the overshoot was.
  void went_up() {
    downhill = 0;
    dt = std::max(0.5 * dt, dt_min);
    mix = 0.1;
  }

  // nm: no element moves farther in one step.
  static double farthest(double radius) { return 0.05 * radius; }
  // Steps between two checks of forces and torques.
  static constexpr int check_every = 10;
};

}  // namespace ropewalk
