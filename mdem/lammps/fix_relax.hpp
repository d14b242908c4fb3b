// fix ID all mdem/relax: Simulation::relax, step by step; LAMMPS's minimisers leave orientations as they are.
#pragma once

#include <array>

#include "lammps/fix_motion.hpp"
#include "sim/dynamics/fire.hpp"

namespace ropewalk::lammps {

class FixRelax : public FixMotion {
 public:
  FixRelax(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override;
  void setup(int vflag) override;
  void initial_integrate(int vflag) override;
  void end_of_step() override;
  double compute_scalar() override { return largest_force(); }

 private:
  struct Sums {
    double power = 0, velocity2 = 0, force2 = 0;
  };
  Sums sums() const;
  void stop();
  void kick();
  void turn_to_force(double mix, const Sums& s);
  double fastest() const;
  double largest_force();

  Fire fire_;
  double radius_ = 0, scale2_ = 0;
  long steps_ = 0;
  double last_ = 0;  // ps, of the last step
};

}  // namespace ropewalk::lammps
