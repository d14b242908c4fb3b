// The rope of seven tubes with incremental parallel bonds, or with our own, led through the same motion of a grip.
// Bonds with a memory need every step of the path, so that both move by the same damped steps. No part of the
// simulator.
#pragma once

#include <cstdint>
#include <vector>

#include "cases/common/parallel_bond.hpp"
#include "cases/common/gripped_rope.hpp"

namespace ropewalk {

// Where the upper grip is: turned about the axis and shifted across it.
struct GripPlace {
  double angle = 0;                 // rad
  Vector3 shift = Vector3::Zero();  // nm
};

class LedRope {
 public:
  enum class Bonds { total_energy, incremental };

  // The step is a part of the stability limit, the brake (1/ps) acts on all velocities.
  LedRope(const ParameterSet& set, int bonds, Bonds kind, double step_fraction, double brake);

  // In `duration` ps along a path, given for parts 0 .. 1 of it.
  template <class Path>
  void lead(const Path& path, double duration) {
    const auto steps = static_cast<long>(duration / time_step_) + 1;
    for (long k = 1; k <= steps; ++k) step(path(static_cast<double>(k) / static_cast<double>(steps)));
  }
  void rest(double duration);  // the grip stays where it is
  // Without brake, from thermal velocities that settle to `temperature` (K) once half of them is stored.
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

}  // namespace ropewalk
