// The force engine of the simulator over the elements of one rank: its own, and its ghosts as copies. A pair or
// bond belongs to the owner of its lower element; LAMMPS brings the forces on ghosts back to their owners. LAMMPS
// makes no list of pairs. Its elements are exchanged when the engine's list asks for it, on all ranks at once.
//
// If nothing but our own fixes acts on elements, the engine leads: its state of own elements is the one that
// moves, by its own forces. LAMMPS's arrays are up to date in every step for the shared elements alone, which are
// ghosts of other ranks or have loads; for all of them before an exchange and an output. Keeping both copies of all
// elements in every step would cost as much as the bonds.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lammps/shared.hpp"
#include "sim/dynamics/thermostat.hpp"
#include "sim/forces/forces.hpp"
#include "sim/state/motion.hpp"

namespace ropewalk::lammps {

// Joins what the ranks know of their elements, by one message. A signal rides along: the largest of all ranks.
class AllRanks : public AllProcesses {
 public:
  explicit AllRanks(MPI_Comm world);
  ~AllRanks() override;
  AllRanks(const AllRanks&) = delete;
  AllRanks& operator=(const AllRanks&) = delete;
  void join(double& largest, double (&sums)[3]) const override;
  void send_along(int signal) { signal_ = signal; }
  int signal() const { return static_cast<int>(signal_); }

 private:
  MPI_Comm world_;
  mutable double signal_ = 0;
  MPI_Datatype numbers_;
  MPI_Op join_;
};

class RankEngine {
 public:
  RankEngine(LMP::LAMMPS* lmp, std::shared_ptr<const LammpsModel> model);

  bool leads() const { return leads_; }
  void lead(bool yes) { leads_ = yes; }

  // Own elements: v += F dt/m, w += M dt/I; x += v dt, q <- exp(w dt) q. The kick returns what force terms that act
  // in it take out, eV.
  double kick(double dt);
  void move(double dt);
  // The bath acts on the velocities of own elements during dt (ps), in the middle of this part of this step.
  void bathe(const Thermostat& bath, double dt, std::int64_t step, int part, double time);
  const Fastest& fastest() const { return fastest_; }  // in the last move
  double kinetic_energy() const { return ropewalk::kinetic_energy(topology_, state_); }
  // Position, velocity, spin and orientation of own elements from LAMMPS's arrays.
  void take_own();
  // The same to them, with forces and torques where the engine leads: of all own elements, of the shared ones
  // without forces, of some atoms likewise.
  void give_own();
  void give_shared();
  void give(const std::vector<int>& atoms);
  void take_velocities(const std::vector<int>& atoms);
  // The forces in LAMMPS's arrays are those of the next kick.
  void use_lammps_forces() { all_forces_there_ = true; }
  // After an exchange: these atoms are shared; ghosts among them do not count.
  void share_none();
  void share(const int* atoms, int count);
  // Whether, after a move, elements must be exchanged and the list rebuilt. `signal` becomes the largest of all ranks.
  // All ranks.
  bool stale(int& signal);
  // The skin of the next list, nm. All ranks, before ghosts are chosen.
  double choose_skin();
  double skin() const { return list_.skin; }
  void use_skin(double skin) { list_.skin = skin; }  // for the first list
  // After an exchange. All ranks. `begins`: force terms begin with the next memory, their accounts too.
  void build(bool begins = false);
  // The next forces are those of this time (ps), at the end of a part of a step that lasts `passed` (ps).
  struct Moment {
    double time = 0;
    std::optional<double> passed;  // none: no part of the motion
  };
  void use_moment(const Moment& moment) { moment_ = moment; }
  // Adds all forces and torques of the model to LAMMPS's. Energies of contact are summed only if wanted.
  void compute(bool energies);

  // Spins of own elements (sim/dynamics/spins.hpp), in rounds: with the atoms of copies whose orientation is final,
  // returns own atoms whose orientation has become so, in LAMMPS's arrays too. The first round has none.
  void begin_spins();
  std::vector<int> follow_spins(const std::vector<int>& copies);
  void end_spins();

  // Memories of all force terms, as lists of numbers (sim/forces/force_terms.hpp): this rank's accounts, and the
  // records of its own elements.
  std::vector<double> memory() const { return engine_.terms().memory(); }
  // For the next build: the records of all elements here, copies among them. At the first one the accounts as well.
  void set_memory(std::vector<double> memory) { next_memory_ = std::move(memory); }
  // Events on this rank since the last call.
  std::vector<TermEvent> take_events();

  // Energies of this rank's pairs and bonds in the last evaluation.
  BondEnergy bond_energy() const;
  double contact_energy();  // evaluates the contact again where the last time left it out
  double damping_power() const { return forces_.damping_power; }                  // eV/ps
  const std::vector<double>& term_energy() const { return forces_.term_energy; }  // energy of each force term
  std::vector<TermAccount> term_accounts() const { return engine_.terms().accounts(); }  // this rank's share
  double lost() const { return forces_.lost; }  // energy lost by force terms whose memory has moved on, eV
  int slipping_element() const;                 // number in the scene; -1: none
  // xx, yy, zz, xy, xz, yz of separation times force, without damping.
  std::array<double, 6> virial(Parts parts);

  static std::string instructions();

 private:
  // A run of elements with consecutive numbers in the engine and in LAMMPS. They have one type, and all of them are
  // owned by this rank or all are ghosts.
  struct Stretch {
    int element, atom, count;
  };
  void find_moved();
  void take(const Stretch& of);
  void give(const Stretch& of);
  void take_forces(const Stretch& of);
  void complete_forces();  // adds the forces in LAMMPS's arrays to those of own elements
  const std::vector<Stretch>& shared();
  void evaluate(const State& state, const ForceOptions& options, Forces& out);
  template <class F>
  void or_refuse(const F& f);

  LMP::LAMMPS* lmp_;
  double** quaternions_ = nullptr;  // valid during a call only
  std::shared_ptr<const LammpsModel> model_;
  std::unique_ptr<AllRanks> ranks_;  // none where there is one rank
  RankMessages messages_;
  std::vector<double> next_memory_;
  Topology topology_;
  State state_;
  std::vector<Stretch> own_, ghosts_;  // own ones short enough for the first cache
  // Own elements of a tube, likewise, whatever their places in LAMMPS: these change as elements come and go, and
  // bits of the motion must not depend on that.
  std::vector<Segment> moved_;
  std::vector<int> element_;     // element of each own atom
  std::vector<char> is_shared_;  // likewise
  std::vector<Stretch> shared_;  // runs of elements that are shared
  bool shared_known_ = false;
  bool leads_ = false;
  bool shared_forces_there_ = false, all_forces_there_ = false;  // in LAMMPS's arrays, not yet taken from there
  std::vector<Change> changes_;                                  // change of each of moved_
  std::vector<Fastest> fastest_of_;                              // fastest element of each of moved_ in the last move
  Fastest fastest_;
  NeighbourList list_;
  long steps_ = 0;  // steps since the list was built
  Moment moment_;
  struct Spins {
    std::vector<char> known;
    std::vector<int> place, atom;  // place of each atom, and atom of each place
    std::vector<int> fresh;        // places that have become known
  };
  Spins spins_;
  ForceEngine engine_;
  Forces forces_, spare_;
  bool contact_energy_known_ = false;
};

}  // namespace ropewalk::lammps
