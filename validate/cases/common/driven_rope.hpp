// A displacement-controlled rope of seven tubes, with incremental parallel bonds or with the simulator's: one grip
// follows a path. Incremental bonds depend on every step of the path, so that both kinds move by the same damped
// steps.
#pragma once

#include <cstdint>
#include <vector>

#include "cases/common/gripped_rope.hpp"
#include "cases/common/parallel_bond.hpp"

namespace ropewalk::validate {

// Position of the upper grip: turned about the axis and shifted across it.
struct GripPlace {
  double angle = 0;                 // rad
  Vector3 shift = Vector3::Zero();  // nm
};

class DrivenRope {
 public:
  enum class Bonds { total_energy, incremental };

  // The step is `step_fraction` of the stability limit; `brake` (1/ps) damps all velocities.
  DrivenRope(const ParameterSet& set, int bonds, Bonds kind, double step_fraction, double brake);

  // Moves the grip along path(0 .. 1) in `duration` ps.
  template <class Path>
  void move(const Path& path, double duration) {
    const auto steps = static_cast<long>(duration / time_step_) + 1;
    for (long k = 1; k <= steps; ++k) step(path(static_cast<double>(k) / static_cast<double>(steps)));
  }
  void rest(double duration);  // with the grip held
  // Undamped motion from thermal velocities. They have twice the kinetic energy of `temperature` (K), since half of
  // it becomes potential energy.
  void shake(double temperature, std::uint64_t seed, double duration);

  double bond_energy() const { return bonds_; }        // eV
  double energy() const { return bonds_ + contact_; }  // eV
  double twist() const { return twist_; }              // eV, of the bonds; total-energy bonds only
  double moment() const { return moment_; }            // eV, on the upper grip, about the axis
  double time_step() const { return time_step_; }      // ps

 private:
  void step(const GripPlace& place);
  void forces();
  void add_incremental();

  GrippedRope rope_;
  Bonds kind_;
  double time_step_ = 0, brake_ = 0;
  NeighbourList list_;
  ForceEngine engine_;
  Forces forces_;
  std::vector<ParallelBond> bond_;  // at the index of its first element
  Vec3Array start_;                 // of the grips
  std::vector<ElementMove> move_;   // of the present step
  GripPlace place_;
  double bonds_ = 0, contact_ = 0, twist_ = 0, moment_ = 0;
};

}  // namespace ropewalk::validate
