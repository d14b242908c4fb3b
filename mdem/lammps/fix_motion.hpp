// fix ID all mdem/nve: velocity Verlet of mdem/sim/dynamics/verlet.hpp, for translation and rotation.
// fix ID all mdem/relax: Simulation::relax, step by step; LAMMPS's minimisers leave orientations as they are.
//
// Both send orientations to ghosts before the forces are evaluated, check the set-up, and keep the account of
// energy: f_ID[1..9] = time, stretch, shear, bend, twist, vdw, kinetic, work, dissipated (ps, eV), behind them the
// energy, the losses, events and beginnings of each force term (sim/forces/force_term.hpp, TermAccount).
#pragma once

#include <array>
#include <vector>

#include "lammps/fix_damp.hpp"
#include "lammps/rank_engine.hpp"
#include "sim/dynamics/energy_mark.hpp"
#include "sim/dynamics/fire.hpp"

namespace ropewalk::lammps {

class FixMotion : public LMP::Fix {
 public:
  FixMotion(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override;
  void init() override;
  void post_integrate() override;
  void pre_exchange() override;
  void setup_pre_neighbor() override;
  void setup_post_neighbor() override { check_elements(); }
  void post_neighbor() override { check_elements(); }
  void setup_pre_force(int vflag) override;
  void pre_force(int vflag) override;
  double compute_vector(int n) override;
  // So far. All ranks.
  EnergySupply account_of_all() const {
    return {sum_over_ranks(lmp, account_.work), sum_over_ranks(lmp, account_.dissipated),
            sum_over_ranks(lmp, account_.heat)};
  }
  void write_restart(FILE* file) override;
  void restart(char* bytes) override;
  int pack_forward_comm(int count, int* list, double* buffer, int, int*) override;
  void unpack_forward_comm(int count, int first, double* buffer) override;
  void post_run() override;

  // LAMMPS takes the memories of an element along wherever it takes the element.
  ~FixMotion() override;
  void grow_arrays(int atoms) override { memory_.resize(static_cast<std::size_t>(atoms)); }
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override { memory_of(i).clear(); }
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int part) override;
  int size_restart(int i) override { return static_cast<int>(memory_of(i).size()) + 1; }
  int maxsize_restart() override { return longest_ + 1; }
  // Events of force terms on this rank since the last call, as a list of numbers.
  std::vector<double> take_events();

 protected:
  void move(double dt);  // x += v dt, q <- exp(w dt) q
  bool only_known_fixes() const;
  double now() const { return model_->time_at(update->ntimestep); }
  double own_kinetic_energy() const;
  // The numbers of a row behind the time. All ranks.
  std::vector<double> energies() const;

  std::shared_ptr<const LammpsModel> model_;
  FixGrip* grip_ = nullptr;
  FixDamp* damp_ = nullptr;
  RankEngine* engine_ = nullptr;  // none: plain forms
  EnergySupply account_;          // this rank's share
  LMP::bigint carried_ = 0;       // the step whose forces are stored with the elements

 private:
  virtual bool engine_may_lead() const { return false; }
  bool exchanged_now() const;
  void lead_exchanges();
  void reach_for(double skin);
  void check_elements();
  void check_masses();
  std::vector<double>& memory_of(int i) { return memory_[static_cast<std::size_t>(i)]; }
  void give_memory(const std::vector<double>& numbers);
  void keep_memory();
  void bring_memory();
  void find_longest();

  State moved_;  // buffer of move()
  std::vector<double> row_;
  LMP::bigint row_step_ = -1;
  double first_skin_ = 0;  // for a run that goes on: the skin of the list (nm; 0: as the engine chooses)
  // Records of force terms, of each own element and each copy; up to date from before an exchange until the list is
  // built. Lists of numbers as those of sim/forces/force_terms.hpp.
  bool remembers_ = false;
  std::vector<std::vector<double>> memory_;
  int longest_ = 0;                            // longest memory of an element of any rank
  int round_ = -1;                             // which message brings them to copies; -1: it brings orientations
  std::vector<double> accounts_;               // that the terms begin with
  std::vector<double> untold_;                 // events of before the start
};

class FixNve : public FixMotion {
 public:
  FixNve(LMP::LAMMPS* lmp, int count, char** words) : FixMotion(lmp, count, words) {}
  int setmask() override;
  void setup(int vflag) override;
  void initial_integrate(int vflag) override;
  void final_integrate() override;
  void post_run() override;

  // The parts of a step, by sim/dynamics/verlet.hpp.
  EnergySupply& account() { return account_; }
  void kick(double dt);
  void add_work_of_loads(double dt);
  void drift(double dt);
  void bathe(double dt);
  double kinetic_energy() const { return own_kinetic_energy(); }
  double damped(double dt) const;

 private:
  bool engine_may_lead() const override { return only_known_fixes(); }
  void carry();  // the forces along with the elements, into the next output
  double push(double alpha, double TubeType::*inertia, double dt, double** velocity, double** force) const;
  void check() const;
  void mark();
  void judge();

  double time_ = 0;  // time in the course of a step, ps
  EnergyMark mark_;
  LMP::bigint marked_at_ = 0;
};

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
  double last_ = 0;  // length of the last step, ps
};

}  // namespace ropewalk::lammps
