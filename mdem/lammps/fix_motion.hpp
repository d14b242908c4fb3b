// What fix mdem/nve (fix_nve.hpp) and fix mdem/relax (fix_relax.hpp) share. Both send orientations to ghosts before
// the forces are evaluated, check the set-up, and keep the account of energy: f_ID[1..9] = time, stretch, shear,
// bend, twist, vdw, kinetic, work, dissipated (ps, eV), behind them the energy, the losses, events and beginnings of
// each force term (sim/forces/force_term.hpp, TermAccount).
#pragma once

#include <vector>

#include "lammps/fix_damp.hpp"
#include "lammps/rank_engine.hpp"
#include "sim/dynamics/step_control.hpp"

namespace ropewalk::lammps {

class FixStates;

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
  // Into how many parts a step is divided, and for how long.
  int divided() const { return divided_; }
  const StepControl& control() const { return control_; }
  // ps, at which LAMMPS evaluates the next forces.
  virtual double time_of_forces() const { return now(); }
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
  // The numbers of a row behind the time: this rank's share, and of all ranks.
  std::vector<double> own_energies() const;
  std::vector<double> energies() const;
  void forget_row() { row_step_ = -1; }
  virtual std::optional<double> passes() const { return 0; }  // ps, before the next forces; none: no motion

  // What LAMMPS does between two steps. Whether the engine's list is too old; `signal` becomes the largest of all
  // ranks.
  void look_at_list(int& signal);
  // Lists are built in any case at such steps, and at those of states: a run that ends there goes on with the same bits.
  bool may_stop_now() const { return steps_to_stop(0) == 0; }
  // Ends the run at such a step if the time of -var wall is over before the next one. All ranks call this.
  void stop_in_time();
  bool exchanged_now() const;
  void hand_out();  // own elements, to LAMMPS's arrays
  void exchange_elements();
  void keep_memory();
  void give_memory(const std::vector<double>& numbers);
  void reach_for(double skin);
  void send_orientations();

  std::shared_ptr<const LammpsModel> model_;
  FixGrip* grip_ = nullptr;
  FixDamp* damp_ = nullptr;
  const FixStates* states_ = nullptr;
  RankEngine* engine_ = nullptr;  // none: plain forms
  EnergySupply account_;          // this rank's share
  LMP::bigint carried_ = 0;       // the step whose forces are stored with the elements
  int divided_ = 1;
  StepControl control_;
  std::vector<double> accounts_;  // that the terms begin with
  std::vector<double> untold_;    // events that no state has told of

 private:
  virtual bool engine_may_lead() const { return false; }
  void lead_exchanges();
  void check_elements();
  void check_masses();
  std::vector<double>& memory_of(int i) { return memory_[static_cast<std::size_t>(i)]; }
  void bring_memory();
  void find_longest();
  // Steps to the first step at which a run may end and that is at least so many steps ahead.
  LMP::bigint steps_to_stop(LMP::bigint ahead) const;

  State moved_;  // buffer of move()
  std::vector<double> row_;
  LMP::bigint row_step_ = -1;
  LMP::bigint looked_step_ = 0;  // the step at which the run began, or the last one at which it might have ended
  double looked_ = 0;            // when that was, s
  double slowest_ = 0;           // s: how long a step takes, in the slowest stretch between two of them
  double first_skin_ = 0;  // for a run that goes on: the skin of the list (nm; 0: as the engine chooses)
  // Records of force terms, of each own element and each copy; up to date from before an exchange until the list is
  // built. Lists of numbers as those of sim/forces/force_terms.hpp.
  bool remembers_ = false;
  std::vector<std::vector<double>> memory_;
  int longest_ = 0;                            // longest memory of an element of any rank
  int round_ = -1;                             // which message brings them to copies; -1: it brings orientations
};

}  // namespace ropewalk::lammps
