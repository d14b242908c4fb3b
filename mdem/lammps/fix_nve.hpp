// fix ID all mdem/nve: velocity Verlet of mdem/sim/dynamics/verlet.hpp, for translation and rotation, with the bath
// of [thermostat] and the spins of twist.geometric_only. Steps follow the motion as those of the simulator do
// (sim/dynamics/step_control.hpp): each rank keeps its elements of the last mark. Where the motion fails on a rank,
// all of them go back there, and make the steps up to the present one again inside of this step, each in several
// parts. States and rows of these steps are written again. This needs the engine to lead: where other fixes act on
// elements, the run ends.
#pragma once

#include <string>
#include <vector>

#include "lammps/fix_motion.hpp"
#include "lammps/fix_states.hpp"

namespace ropewalk::lammps {

class FixNve : public FixMotion {
 public:
  enum class Failure : int { none, slip, blow_up, account };

  FixNve(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override;
  void init() override;
  void setup(int vflag) override;
  void initial_integrate(int vflag) override;
  void post_integrate() override;
  void final_integrate() override;
  void post_run() override;
  double time_of_forces() const override { return in_last_part() ? now() : time_; }
  int pack_forward_comm(int count, int* list, double* buffer, int, int*) override;
  void unpack_forward_comm(int count, int first, double* buffer) override;

  // The parts of a step, by sim/dynamics/verlet.hpp.
  EnergySupply& account() { return account_; }
  void kick(double dt);
  void add_work_of_loads(double dt);
  void drift(double dt);
  void bathe(double dt);
  double kinetic_energy() const { return own_kinetic_energy(); }
  double damped(double dt) const;

  // The motion fails on this rank. False: no rank can go back, and the run ends.
  bool will_go_back(Failure failure);

 private:
  // This rank's share of a good state.
  struct Mark {
    LMP::bigint step = -1;  // -1: none
    EnergyMark energy;      // sums over all ranks
    EnergySupply account;
    std::vector<double> elements, memory, events;
    double skin = 0;  // nm
    FixStates::Place states;
  };

  bool engine_may_lead() const override { return only_known_fixes(); }
  std::optional<double> passes() const override { return time_stands_ ? std::nullopt : std::optional(part_step()); }
  double part_step() const { return update->dt / divided_; }
  bool in_last_part() const { return part_ + 1 == divided_; }
  void divide(int parts) { divided_ = parts, part_ = parts - 1; }

  // These return whether the motion of all ranks is sound. All ranks.
  bool begin();
  bool looks_sound();
  bool compute_within();
  bool make_steps_up_to(LMP::bigint last, LMP::bigint present);
  bool is_sound(bool of_account);

  void end();
  void compute_now();
  void mark();
  void judge();
  void go_back();
  void restore();
  void relax_spins();
  void carry();  // the forces along with the elements, into the next output
  double push(double alpha, double TubeType::*inertia, double dt, double** velocity, double** force) const;
  void check();

  double time_ = 0;  // time in the course of a step, ps
  int part_ = 0;     // number of the part of the step, from 0
  bool began_well_ = true;
  int failure_ = 0;  // Failure of this rank, or the largest of all where they have looked
  Mark mark_;
  bool time_stands_ = false;  // forces are computed again, no time passes
  bool sends_spins_ = false;  // messages bring the orientations that are final
  std::vector<char> final_;   // whether that of an atom has become so
};

}  // namespace ropewalk::lammps
